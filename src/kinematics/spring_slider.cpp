#include "spring_slider.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limits.hpp"
#include "smoothing.hpp"
#include "statistics/local_derivatives.hpp"
#include "tribofit/ingest/input_error.hpp"
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
    notes.push_back(fmt::format("no load is known: the slider presses by its weight, {:.4g} N", load.value));
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
      "spring: the steepest fall of the pull is that of {:.3g} Hz, stiffness and mass say {:.3g} Hz: one of the two, "
      "or the load, is another",
      frequency_found / turn, stated / turn);
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
  trace.velocity.resize(trace.size());
  trace.velocity_std_error.resize(trace.size());
  trace.friction_std_error.resize(trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace.velocity[i] = to_speed * pull.slope[i];
    trace.velocity_std_error[i] = to_speed * pull.slope_std_error[i];
    trace.friction[i] += inertia * pull.bend[i];
    trace.friction_std_error[i] = std::hypot(pull.noise, inertia * pull.bend_std_error[i]);
  }
  notes.push_back(
      fmt::format("spring: v_b is the slope of the pull over the stiffness, over {} samples ({:.3g} ms), "
                  "which rounds break-away and re-stick: intervals do not hold that",
                  2 * half + 1, 1e3 * static_cast<double>(2 * half + 1) * step));
  if (has_mass && !contradiction(spring, found).empty()) notes.push_back(contradiction(spring, found));
  if (has_mass) notes.push_back(fmt::format("spring: inertia of {:.4g} kg taken off the pull", spring.mass.value));
}

double usual_error(const std::vector<double>& errors) {
  return errors.empty() ? 0 : median(errors);
}

std::vector<SampleSpan> unsure_samples(const Trace& trace) {
  std::vector<SampleSpan> spans;
  const std::vector<double>&v = trace.velocity_std_error, &friction = trace.friction_std_error;
  if (v.empty()) return spans;
  const double limit = kUnsure * usual_error(v);
  const bool of_motion = trace.kind == RecordKind::motion_only;
  const double of_friction = of_motion ? kUnsure * usual_error(friction) : 0;
  for (std::size_t i = 0; i < v.size(); ++i) {
    if (v[i] <= limit && (!of_motion || friction[i] <= of_friction)) continue;
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
