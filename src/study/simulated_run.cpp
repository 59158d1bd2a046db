#include "simulated_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/errors.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

/// How the disc is driven in a run.
SpeedProfile speed_of_run(const RunConditions& run) {
  if (run.reversing > 0) return reversing_speed(run.speed, run.reversing);
  return run.pauses.empty() ? constant_speed(run.speed) : stepped_speed({0}, {run.speed}, run.pauses);
}

/// Something lets the block move in stick.
bool moves_in_stick(const FrictionModel& model) {
  return model.acts_in_stick() || std::any_of(model.effects().begin(), model.effects().end(), [](const Effect& effect) {
           return describe(effect).sketch.view == SketchView::creep;
         });
}

/// The motion as it is known of a simulation: nothing is to be found out about its channels, which takes half the time
/// of a judgement.
Motion known_motion(Trace trace, const StickRule& stick) {
  Motion out;
  out.step = trace.interval();
  const double radius = trace.conditions.radius.value;
  if (trace.disc_speed.empty()) out.constant_disc_velocity = trace.conditions.speed.value * radius;
  for (const double speed : trace.disc_speed) out.disc_velocity.push_back(speed * radius);
  out.relative_velocity.resize(trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    out.relative_velocity[i] = out.disc_velocity_at(i) - trace.velocity[i];
  }
  out.time = std::move(trace.time);
  out.friction = std::move(trace.friction);
  out.load = std::move(trace.load);
  out.temperature = std::move(trace.temperature);
  out.disc_speed = std::move(trace.disc_speed);
  out.friction_kind = trace.friction_kind;
  out.conditions = std::move(trace.conditions);
  out.steps = std::move(trace.steps);
  out.stick = stick;
  return out;
}

/// The same noise in means over `samples` neighbours.
Sensors averaged_noise(Sensors noise, double samples) {
  if (!(samples > 1)) return noise;
  // Variance of the mean of q neighbours of an autoregression, and covariance of two such means side by side.
  const double q = samples, r = noise.noise_colour;
  const double sum = r > 0 ? (1 - std::pow(r, q)) / (1 - r) : 1;
  const double variance = r > 0 ? ((1 + r) / (1 - r) - 2 * r * sum / (q * (1 - r))) / q : 1 / q;
  const double beside = r > 0 ? r * sum * sum / (q * q) : 0;
  const double part = std::sqrt(variance);
  noise.friction_noise *= part;
  noise.velocity_noise *= part;
  noise.noise_colour = std::clamp(beside / variance, 0.0, kMostNoiseCorrelation);
  return noise;
}

}  // namespace

Sensors noise_of_record(const Motion& motion, const Segmentation& segmentation, const Floor& floor) {
  Sensors sensors;
  sensors.friction_noise = floor.noise;
  sensors.velocity_noise =
      std::max(motion.velocity_noise, noise_in_sticks(SampleFault::velocity, motion, segmentation).deviation);
  sensors.noise_colour = noise_in_sticks(SampleFault::friction, motion, segmentation).correlation;
  return sensors;
}

Trace record_machine(const Machine& machine, const Drive& drive, SimulationOptions options, const Sensors& sensors,
                     bool* sticks) {
  const FrictionModel& model = machine.model;
  const std::vector<double>& p = machine.parameters;
  options.channels = recorded_channels(model, p, drive, sensors);
  SimulatedMotion moved = simulate(machine.rig, drive, model, p, options);
  if (sticks != nullptr) *sticks = std::find(moved.sticks.begin(), moved.sticks.end(), 1) != moved.sticks.end();
  return recorded_trace(std::move(moved), model, p, sensors);
}

Motion plain_motion(Trace trace, const StickRule& stick) {
  return compute_motion(
      std::move(trace), {},
      {.trim = false, .undo_high_pass = false, .undo_speed_ripple = false, .undo_distortions = false, .stick = stick});
}

SimulatedRun simulate_run(Machine machine, const RunConditions& run, const RecordToContinue& record,
                          std::uint64_t seed) {
  const Motion& measured = *record.motion;
  const bool force = measured.friction_kind == FrictionKind::force;
  const bool load_known = !force && run.load > 0 && machine.load > 0 && measured.conditions.load.known();
  if (load_known) machine.load = run.load;
  machine.radius = run.radius;
  machine.speed = run.speed;
  if (run.stiffness > 0) {
    machine.rig.damping *= std::sqrt(run.stiffness / machine.rig.stiffness);  // the damping ratio stays
    machine.rig.stiffness = run.stiffness;
  }
  machine.rig.mass += run.mass_below;

  Drive drive = machine.drive();
  drive.speed = speed_of_run(run);
  // The disc is pressed with the load of the run, which is not the one that the parameters refer to.
  if (load_known && record.reference_load > 0) {
    drive.mean_load = record.reference_load;
    drive.load = [load = machine.load](double) { return load; };
  }
  if (!measured.temperature.empty()) {
    drive.mean_temperature = record.reference_temperature;
    drive.temperature = [mean = mean_of(measured.temperature)](double) { return mean; };
  }
  const double enough =
      std::clamp(kSimulatedSamples / run.duration, kLeastPartOfRate * record.simulated_rate, record.simulated_rate);
  SimulationOptions options{.duration = run.duration,
                            .rate = std::min(run.rate, enough),
                            .scatter = record.scatter,
                            .seed = seed,
                            .tolerance = kPlannedTolerance};
  if (!(run.reversing > 0)) options.settle = settling_time(machine.rig, drive, machine.parameters);
  Sensors sensors = record.noise;  // of a sample at any rate; neighbours correlate over the same time
  sensors.noise_colour = std::pow(sensors.noise_colour, record.rate / run.rate);
  sensors = averaged_noise(sensors, run.rate / options.rate);
  sensors.seed = seed ^ 0x2545f4914f6cdd1du;
  bool sticks = false;
  Trace trace = record_machine(machine, drive, options, sensors, &sticks);
  trace.path = "simulated run";
  if (measured.load.empty()) trace.load.clear();
  if (force) trace.friction_kind = FrictionKind::force;
  const Condition& load = measured.conditions.load;
  trace.conditions.load = load.known() ? Condition{force ? load.value : machine.load, "plan"} : Condition{};
  for (Step& step : trace.steps) step.conditions.load = trace.conditions.load;

  SimulatedRun out;
  if (moves_in_stick(machine.model)) {  // its plateau is found as in a record
    out.motion = plain_motion(std::move(trace), measured.stick);
  } else {
    out.motion = known_motion(std::move(trace), measured.stick);
    out.motion.velocity_noise = sensors.velocity_noise;
    out.motion.sticks = sticks;
  }
  out.segmentation = find_cycles(out.motion);
  return out;
}

}  // namespace tribofit
