#include "tribofit/study/response.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>

#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/study/sweep.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {

namespace {

/// Amplitude of the n-th harmonic of samples that cover one period.
double harmonic_of(std::span<const double> period, std::size_t n) {
  std::complex<double> sum = 0;
  const double step = -2 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(period.size());
  for (std::size_t i = 0; i < period.size(); ++i) sum += period[i] * std::polar(1.0, step * static_cast<double>(i));
  return 2 * std::abs(sum) / static_cast<double>(period.size());
}

}  // namespace

Response study_response(const Machine& machine, std::size_t harmonics, const SettleOptions& options) {
  Response out;
  const Rig& rig = machine.rig;
  out.settled = settle(machine, options);
  const double natural = rig.natural_frequency(), ratio = rig.damping_ratio();
  out.natural_frequency = natural / (2 * std::numbers::pi);
  out.damped_natural_frequency = ratio < 1 ? std::sqrt(1 - ratio * ratio) * out.natural_frequency : 0;
  const auto law = std::span(machine.parameters).first(machine.model.base_count());
  const double fastest = 2 * machine.disc_velocity();  // of a slip, about
  out.force = 0.5 * machine.load *
              (friction_at_rest(machine.model.law(), law) - kinetic_friction(machine.model.law(), law, fastest));
  if (out.settled.repeats()) {
    constexpr std::size_t kSamples = 16384;
    const SimulatedMotion motion = settled_motion(machine, out.settled, 1, kSamples, options);
    std::vector<double> force(motion.friction);
    for (double& f : force) f *= machine.load;
    for (std::size_t n = 1; n <= harmonics; ++n) {
      out.harmonics.push_back({static_cast<double>(n) * out.settled.frequency, harmonic_of(force, n),
                               harmonic_of(motion.displacement, n), harmonic_of(motion.velocity, n)});
    }
    out.force = out.harmonics.front().force;
  }
  out.amplitude_at_rest = out.force / rig.stiffness;
  out.amplitude_at_natural = out.force / (rig.damping * natural);
  constexpr std::size_t kPoints = 400;
  out.frequency = evenly_spaced(0.05 * out.natural_frequency, 5 * out.natural_frequency, kPoints, true);
  for (const double f : out.frequency) {
    const double w = 2 * std::numbers::pi * f;
    out.amplitude.push_back(out.force / std::hypot(rig.stiffness - rig.mass * w * w, rig.damping * w));
  }
  return out;
}

std::vector<Portrait> study_phase(const Machine& machine, const std::vector<double>& velocity,
                                  const PortraitOptions& options) {
  if (velocity.size() * options.cycles > kMostDrawnCycles) {
    throw InputError(fmt::format("{} cycles at each of {} speeds are more than the {} that are drawn in all",
                                 options.cycles, velocity.size(), kMostDrawnCycles),
                     "draw fewer cycles or fewer speeds");
  }
  std::vector<Portrait> out;
  for (const double v : velocity) {
    const Machine at = with_value(machine, "velocity", v);
    Portrait portrait;
    portrait.velocity = v;
    portrait.settled = settle(at, options.settle);
    const double natural = 2 * std::numbers::pi / at.rig.natural_frequency();
    const double cycle = portrait.settled.frequency > 0 ? 1 / portrait.settled.frequency : natural;
    // The spring is wound up first.
    const double winding = at.parameters[0] * at.load / (at.rig.stiffness * v);
    const double duration = winding + static_cast<double>(options.cycles) * cycle;
    constexpr double kMostSamples = 1e6;  // a slow disc winds the spring up for thousands of periods
    SimulationOptions simulation{
        .duration = duration, .rate = std::min(static_cast<double>(options.samples) / cycle, kMostSamples / duration)};
    simulation.start = start_of(at, options.settle.start);
    portrait.start = motion_of(at, simulation, options.settle.sharpness);
    if (portrait.settled.repeats())
      portrait.cycle = settled_motion(at, portrait.settled, 1, options.samples, options.settle);
    out.push_back(std::move(portrait));
  }
  return out;
}

}  // namespace tribofit
