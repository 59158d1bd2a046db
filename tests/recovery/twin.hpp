#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace recovery {

/// How a twin of a test of [D] is recorded.
struct TwinOptions {
  double radius = 0.015;  ///< [m]
  tribofit::Law law = tribofit::ExponentialLaw{};
  double duration = 20;  ///< [s]
  double rate = 20e3;    ///< [Hz]
  double colour = 0;     ///< AR(1) coefficient of both noises, per sample
  double scatter = 0.004;
  double wander = 0;  ///< of the scatter, per cycle
  std::uint64_t seed = 1;
  std::vector<tribofit::Effect> effects = {};
  std::vector<double> effect_parameters = {};  ///< SI, in the order of the effects
};

struct Twin {
  tribofit::PublishedTest test;
  std::vector<double> truth;  ///< mu_s, mu_k, decay factor, parameters of effects (SI)
  double floor_rmse = 0;      ///< what the true law leaves over slip
  tribofit::Motion motion;
  tribofit::Segmentation segmentation;
};

/// Simulates a test of [D], records it with noise 0.003 and 0.02 mm/s, and takes it through the stages before
/// the fit.
inline Twin make_twin(const TwinOptions& o) {
  using namespace tribofit;
  Twin twin;
  twin.test = published_test(o.radius, o.law);
  twin.truth = twin.test.friction;
  const FrictionModel model(o.law, o.effects);
  twin.truth.insert(twin.truth.end(), o.effect_parameters.begin(), o.effect_parameters.end());
  Drive drive;
  drive.speed = constant_speed(twin.test.speed);
  drive.radius = twin.test.radius;
  drive.mean_load = twin.test.load;
  SimulationOptions simulation;
  simulation.duration = o.duration;
  simulation.rate = o.rate;
  simulation.settle = settling_time(twin.test.rig, drive, twin.truth);
  simulation.scatter = {o.scatter, o.wander};
  simulation.seed = o.seed;
  const SimulatedMotion motion = simulate(twin.test.rig, drive, model, twin.truth, simulation);
  Sensors sensors;
  sensors.friction_noise = 0.003;
  sensors.velocity_noise = 0.02e-3;
  sensors.noise_colour = o.colour;
  sensors.friction_resolution = 1e-5;
  sensors.velocity_resolution = 1e-7;
  sensors.seed = o.seed + 1000000;
  Recording recording = record(motion, model, twin.truth, sensors);
  twin.floor_rmse = floor_rmse(motion, recording, model, twin.truth);
  Trace trace = std::move(recording.trace);
  trace.conditions.radius = {twin.test.radius, "command line"};
  trace.conditions.speed = {twin.test.speed, "command line"};
  trace.conditions.load = {twin.test.load, "command line"};
  twin.motion = compute_motion(std::move(trace));
  twin.segmentation = find_cycles(twin.motion);
  return twin;
}

inline tribofit::Fit fit_twin(const Twin& twin, tribofit::Law law,
                              tribofit::Protocol protocol = tribofit::Protocol::joint) {
  tribofit::FitOptions options;
  options.protocol = protocol;
  return tribofit::fit_model(tribofit::FrictionModel(law), twin.motion, twin.segmentation,
                             tribofit::observe(twin.motion, twin.segmentation), {}, options);
}

}  // namespace recovery
