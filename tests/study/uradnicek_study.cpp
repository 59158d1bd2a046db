#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "machines.hpp"
#include "published_studies.hpp"
#include "roots.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/statistics/spectrum.hpp"
#include "tribofit/study/critical_speed.hpp"
#include "tribofit/study/smoothed.hpp"

namespace tribofit::studies {

namespace {

constexpr double kSlow = 0.5e-3;  // m/s, [U] Fig 2

/// Zeros of f over decay factors from 0.01 to 10 s/mm.
std::vector<double> decays_where_zero(const std::function<double(double)>& f, double tolerance) {
  std::vector<double> roots;
  constexpr int kPoints = 61;
  double before = 10, at_before = f(before);
  for (int i = 1; i < kPoints; ++i) {
    const double now = 10 * std::pow(1000, i / (kPoints - 1.0)), at_now = f(now);
    if (at_before * at_now < 0) roots.push_back(root_of(f, before, now, tolerance));
    before = now;
    at_before = at_now;
  }
  return roots;
}

SimulatedMotion smoothed_motion(const Machine& machine, ArctangentReading reading, double duration) {
  SmoothedLaw law = smoothed_law(machine.model, machine.parameters, kPrintedSharpness);
  law.reading = reading;
  return simulate_smoothed(machine.rig, machine.drive(), law, {.duration = duration, .rate = 0});
}

}  // namespace

double decay_for_frequency(double frequency, double sharpness) {
  const auto excess = [&](double decay) {
    return settle(uradnicek_machine(decay, kSlow), {.sharpness = sharpness}).frequency - frequency;
  };
  return root_of(excess, 60, 1500, 1e-6);
}

std::vector<double> decays_losing_stability_at(double velocity) {
  return decays_where_zero(
      [&](double decay) { return steady_sliding(uradnicek_machine(decay, velocity)).growth_rate(); }, 1e-9);
}

std::vector<double> decays_losing_stick_at(double velocity) {
  return decays_where_zero(
      [&](double decay) { return keeps_sticking(uradnicek_machine(decay, velocity)) ? 1.0 : -1.0; }, 1e-4);
}

FromRest from_rest(const Machine& machine, const SettleOptions& options) {
  FromRest out;
  out.velocity = machine.disc_velocity();
  out.growth_rate = steady_sliding(machine).growth_rate();
  SettleOptions rest = options;
  rest.start = StartFrom::rest;
  out.settled = settle(machine, rest);
  const SimulatedMotion motion =
      motion_of(machine, {.duration = 600, .rate = 0, .start = start_of(machine, StartFrom::rest)}, rest.sharpness);
  out.first_stick = motion.slips.empty() ? 0 : motion.slips.front().restick_time;
  const auto& turns = motion.turning_points;
  for (std::size_t i = 1; i < turns.size(); ++i) {
    const double swing = std::abs(turns[i].displacement - turns[i - 1].displacement);
    if (i == 1) out.first_swing = swing;
    if (turns[i].time < 60) out.swing_after_a_minute = swing;
  }
  return out;
}

Readings readings_of_the_arctangent(double decay) {
  const Machine machine = uradnicek_machine(decay, kSlow);
  Readings out{.decay = decay};
  SmoothedLaw printed = smoothed_law(machine.model, machine.parameters, kPrintedSharpness);
  printed.reading = ArctangentReading::as_printed;
  out.jump = 2 * printed.mu_c;
  out.printed_at_rest = printed.friction(0);
  const auto measure = [&](ArctangentReading reading, double& frequency, double& swing) {
    const SimulatedMotion motion = smoothed_motion(machine, reading, 100);
    const auto& slips = motion.slips;
    const auto& turns = motion.turning_points;
    const std::size_t n = slips.size(), m = turns.size();
    frequency = 10 / (slips[n - 1].break_away_time - slips[n - 11].break_away_time);
    swing = std::abs(turns[m - 1].displacement - turns[m - 2].displacement);
  };
  measure(ArctangentReading::smooth, out.smooth_frequency, out.smooth_swing);
  measure(ArctangentReading::as_printed, out.printed_frequency, out.printed_swing);
  return out;
}

Lines lines_of(const Machine& machine, const SettleOptions& options) {
  constexpr std::size_t kCycles = 64, kSamples = 256, kSide = 4, kLines = 12;
  const Settled settled = settle(machine, options);
  const SimulatedMotion motion = settled_motion(machine, settled, kCycles, kSamples, options);
  const Spectrum spectrum = amplitude_spectrum(motion.displacement, 1 / motion.rate);
  Lines out{.fundamental = settled.frequency};
  for (std::size_t k = kCycles / 2; k < (kLines + 1) * kCycles - kCycles / 2 && k < spectrum.amplitude.size(); ++k) {
    const std::size_t line = (k + kCycles / 2) / kCycles;
    const std::size_t distance = k > line * kCycles ? k - line * kCycles : line * kCycles - k;
    if (distance == 0) out.amplitude.push_back(spectrum.amplitude[k]);
    if (distance > kSide) out.between = std::max(out.between, spectrum.amplitude[k]);
  }
  return out;
}

}  // namespace tribofit::studies
