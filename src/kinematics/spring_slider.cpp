#include "spring_slider.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limits.hpp"
#include "smoothing.hpp"
#include "statistics/derivatives.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {

namespace {

constexpr double kGravity = 9.80665;  // [m/s^2]

/// Newtons of the pull per unit of the channel: the load where it is given over that. A slider that nothing presses
/// weighs down by its mass alone.
double newtons_per_unit(Trace& trace, std::vector<std::string>& notes) {
  if (trace.friction_kind == FrictionKind::force) return 1;
  if (!trace.load.empty()) {
    throw InputError("the pull of a spring over a load that varies does not give a velocity",
                     "leave the load out with --columns load=none, or state it with --load", {trace.path, 0, ""});
  }
  Condition& load = trace.conditions.load;
  if (!load.known() && trace.spring.mass.known()) {
    load = {trace.spring.mass.value * kGravity, "mass"};
    notes.push_back(fmt::format("no load is known: the slider presses by its weight, {} N", general(load.value, 4)));
  }
  if (load.known()) return load.value;
  throw InputError("the pull of the spring is given over the load, which is not known",
                   "give --load 0.3N, or --mass 30.7g where the slider presses by its weight", {trace.path, 0, ""});
}

/// What the falls of the pull say of the stated stiffness and mass; empty where they agree.
std::string contradiction(const SpringDrive& spring, double frequency_found) {
  const double stated = std::sqrt(spring.stiffness.value / spring.mass.value), turn = 2 * std::numbers::pi;
  if (!(frequency_found > 0) || std::abs(frequency_found / stated - 1) < kFrequencyAgrees) return {};
  return fmt::format(
      "spring: the steepest fall of the pull is that of {} Hz, stiffness and mass say {} Hz: one of the two, "
      "or the load, is another",
      general(frequency_found / turn, 3), general(stated / turn, 3));
}

/// Whether the slider slips, sample by sample, as its velocity shows it.
std::vector<bool> slipping(const Trace& trace, double drive) {
  double fastest = 0;
  for (const double v : trace.velocity) fastest = std::max(fastest, std::abs(drive - v));
  const double least = std::max(kSlipsOverError * usual_error(trace.velocity_std_error), kSlipsOverFastest * fastest);
  std::vector<bool> slips;
  for (const double v : trace.velocity) slips.push_back(std::abs(drive - v) > least);
  return slips;
}

/// Samples whose stretch is of a slip alone, and those whose stretch holds the end of one.
struct Stretches {
  std::vector<std::size_t> whole, mixed;
  std::size_t mixed_slips = 0;  ///< of mixed, those in a slip
};

Stretches stretches_of(const std::vector<bool>& slips, std::size_t reach) {
  const std::size_t n = slips.size(), clear = reach + kBesideUnsure, rise = kRisesWithin * reach;
  std::vector<std::size_t> before(n, 0), behind(n, 0);  // samples of the same phase
  for (std::size_t i = 1; i < n; ++i) before[i] = slips[i] == slips[i - 1] ? before[i - 1] + 1 : 0;
  for (std::size_t i = n - 1; i-- > 0;) behind[i] = slips[i] == slips[i + 1] ? behind[i + 1] + 1 : 0;
  Stretches out;
  for (std::size_t i = clear; i + clear < n; ++i) {
    const bool at_end = before[i] < (slips[i] ? clear : 0) || behind[i] < (slips[i] ? clear : rise);
    if (at_end) out.mixed.push_back(i);
    if (at_end && slips[i]) ++out.mixed_slips;
    if (!at_end && slips[i]) out.whole.push_back(i);
  }
  return out;
}

/// Where the slider slips throughout a stretch: pull, slope and second derivative as means over it with the same
/// weights, for which the force balance is exact. Stretches with a part of a stick show no law of sliding, and are not
/// used; where most of the slips are such, all stays as it is. Errors of the velocity stay those of the wider window,
/// by which stick is distinguished from slip.
void smooth_alike(const LocalDerivatives& pull, const std::vector<double>& raw, std::size_t half, double unit,
                  Trace& trace) {
  if (!trace.spring.velocity.known()) return;
  const SmoothedDerivatives mean = smoothed_derivatives(raw, trace.interval(), half);
  const Stretches stretches = stretches_of(slipping(trace, trace.spring.velocity.value), mean.reach);
  if (stretches.whole.size() < stretches.mixed_slips) return;
  const double to_speed = unit / trace.spring.stiffness.value;
  const double mass = trace.spring.mass.known() ? trace.spring.mass.value / unit : 0;
  const double unsure = 2 * kUnsure * usual_error(trace.velocity_std_error);
  trace.smoothing = std::sqrt(mean.variance);
  trace.velocity_variance.assign(trace.size(), 0.0);
  trace.acceleration = pull.second_derivative;
  for (double& a : trace.acceleration) a *= to_speed;
  for (const std::size_t i : stretches.mixed)
    trace.velocity_std_error[i] = std::max(trace.velocity_std_error[i], unsure);
  for (const std::size_t i : stretches.whole) {
    trace.velocity[i] = to_speed * mean.slope[i];
    trace.acceleration[i] = to_speed * mean.second_derivative[i];
    trace.friction[i] = mean.value[i] + mass * trace.acceleration[i];
    trace.velocity_variance[i] = mean.variance * trace.acceleration[i] * trace.acceleration[i];
    trace.friction_std_error[i] =
        pull.noise * std::hypot(mean.value_gain, mass * to_speed * mean.second_derivative_gain);
  }
}

}  // namespace

void make_block_of_spring(Trace& trace, std::vector<std::string>& notes) {
  const SpringDrive& spring = trace.spring;
  if (!spring.stiffness.known()) {
    throw InputError("the velocity of the slider needs the stiffness of the spring, which is not known",
                     "give it as --stiffness 168N/m", {trace.path, 0, ""});
  }
  const double unit = newtons_per_unit(trace, notes), step = trace.interval();
  const std::size_t lone = remove_lone_samples(trace.friction);
  if (lone > 0)
    notes.push_back(fmt::format("spring: {} lone samples of the pull were replaced by their neighbours", lone));
  const bool has_mass = spring.mass.known() && spring.mass.value > 0;
  const double found = frequency_of_falls(trace.friction, step);
  const double frequency = has_mass ? std::sqrt(spring.stiffness.value / spring.mass.value) : found;
  const std::size_t half = frequency > 0 ? half_window(frequency, step) : kWidestHalf;
  const LocalDerivatives pull = local_derivatives(trace.friction, step, half);
  const double to_speed = unit / spring.stiffness.value;
  const double inertia = has_mass ? spring.mass.value / spring.stiffness.value : 0;
  trace.velocity_kind = VelocityKind::block;
  std::vector<double> raw(trace.size());
  trace.velocity.resize(trace.size());
  trace.velocity_std_error.resize(trace.size());
  trace.friction_std_error.resize(trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace.velocity[i] = to_speed * pull.slope[i];
    trace.velocity_std_error[i] = to_speed * pull.slope_std_error[i];
    raw[i] = trace.friction[i];
    trace.friction[i] += inertia * pull.second_derivative[i];
    trace.friction_std_error[i] = std::hypot(pull.noise, inertia * pull.second_derivative_std_error[i]);
  }
  smooth_alike(pull, raw, half, unit, trace);
  notes.push_back(
      fmt::format("spring: v_b is the slope of the pull over the stiffness, over {} samples ({} ms), "
                  "in slips with acceleration and friction as means over the same",
                  2 * half + 1, general(1e3 * static_cast<double>(2 * half + 1) * step, 3)));
  if (!has_mass && found > 0) {
    notes.push_back(fmt::format(
        "spring: the steepest fall of the pull is that of {} Hz, which with the stiffness is a mass of {} g",
        general(found / (2 * std::numbers::pi), 3), general(1e3 * spring.stiffness.value / (found * found), 3)));
  }
  if (has_mass && !contradiction(spring, found).empty()) notes.push_back(contradiction(spring, found));
  if (has_mass)
    notes.push_back(fmt::format("spring: inertia of {} kg taken off the pull", general(spring.mass.value, 4)));
}

double usual_error(const std::vector<double>& errors) {
  return errors.empty() ? 0 : quantile(errors, 0.25);
}

std::vector<SampleSpan> unsure_samples(const Trace& trace) {
  std::vector<SampleSpan> spans;
  const std::vector<double>&v = trace.velocity_std_error, &friction = trace.friction_std_error;
  if (v.empty()) return spans;
  const double limit = kUnsure * usual_error(v);
  const bool is_motion_only = trace.kind == RecordKind::motion_only;
  const double most_unsure = is_motion_only ? kUnsure * usual_error(friction) : 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i] <= limit && (!is_motion_only || friction[i] <= most_unsure)) continue;
    const std::size_t begin = i - std::min(i, kBesideUnsure), end = std::min(v.size(), i + kBesideUnsure + 1);
    if (!spans.empty() && spans.back().end >= begin) {
      spans.back().end = end;
    } else {
      spans.push_back({begin, end});
    }
  }
  return spans;
}

}  // namespace tribofit::kinematics
