#include "corrections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "limits.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit::kinematics {
namespace {

void scale(std::span<double> signal, double factor, double offset) {
  if (factor == 1 && offset == 0) return;
  for (double& x : signal) x = (x - offset) * factor;
}

Ends ends_of(double delay, double step) {
  const auto samples = static_cast<std::size_t>(std::ceil(std::abs(delay) / step)) + 2;
  return delay > 0 ? Ends{0, samples} : Ends{samples, 0};
}

void correct_delay(std::span<double> signal, double delay, double step, Ends& ends) {
  if (delay == 0 || signal.empty()) return;
  shift_earlier(signal, delay, step);
  const Ends lost = ends_of(delay, step);
  ends.head = std::max(ends.head, lost.head);
  ends.tail = std::max(ends.tail, lost.tail);
}

// A zero in N is one of the force: of a coefficient it takes off zero/Fn, with the measured load where there is one.
void subtract_zero(Trace& trace, const Instruments::ForceSensor& sensor, std::vector<std::string>& notes) {
  if (!sensor.zero || sensor.zero->value == 0) return;
  const bool by_load = sensor.zero_is_force && trace.friction_kind == FrictionKind::coefficient;
  if (by_load && trace.load.size() == trace.friction.size()) {
    for (std::size_t i = 0; i < trace.friction.size(); ++i) {
      if (trace.load[i] > 0) trace.friction[i] -= sensor.zero->value / trace.load[i];
    }
    notes.push_back(
        fmt::format("friction: declared zero {} N over the measured load subtracted", general(sensor.zero->value, 4)));
    return;
  }
  const double zero = zero_of_friction(sensor, trace.friction_kind, trace.conditions.load)->value;
  scale(trace.friction, 1, zero);
  notes.push_back(fmt::format("friction: declared zero {} subtracted", general(zero, 4)));
}

void correct_crosstalk(Trace& trace, double part) {
  if (part == 0) return;
  if (trace.friction_kind == FrictionKind::coefficient) {
    scale(trace.friction, 1, part);
  } else if (!trace.load.empty()) {
    for (std::size_t i = 0; i < trace.friction.size(); ++i) trace.friction[i] -= part * trace.load[i];
  }
}

}  // namespace

double interpolated(double a, double b, double c, double d, double u) {
  return b + u * (c - b) + u * (1 - u) / 6 * ((u - 2) * (a - 2 * b + c) - (u + 1) * (b - 2 * c + d));
}

void shift_earlier(std::span<double> signal, double delay, double step) {
  const std::size_t n = signal.size();
  if (n < 2 || delay == 0) return;
  // A negative delay is a positive one on the reversed signal; walking forwards then only reads what is not yet
  // written.
  const bool reversed = delay < 0;
  if (reversed) std::reverse(signal.begin(), signal.end());
  const double samples = std::abs(delay) / step;
  const auto whole = static_cast<std::size_t>(samples);
  const double part = samples - static_cast<double>(whole);
  const double last = signal[n - 1];
  double before = signal[std::min(whole > 0 ? whole - 1 : 0, n - 1)];
  for (std::size_t i = 0; i < n; ++i) {
    const auto at = [&](std::size_t k) { return k < n ? signal[k] : last; };
    const double here = at(i + whole);
    const double shifted = interpolated(before, here, at(i + whole + 1), at(i + whole + 2), part);
    before = here;
    signal[i] = i + whole < n ? shifted : last;
  }
  if (reversed) std::reverse(signal.begin(), signal.end());
}

Ends correct_declared(Trace& trace, const Instruments& instruments, double step, std::vector<std::string>& notes) {
  Ends ends;
  const auto& vibrometer = instruments.vibrometer;
  const auto& sensor = instruments.force_sensor;
  const bool has_velocity = !trace.velocity.empty();
  if (has_velocity) {
    const double gain = vibrometer.gain ? vibrometer.gain->value : 1;
    scale(trace.velocity, vibrometer.sign / gain, 0);
    const double delay = vibrometer.delay ? vibrometer.delay->value : 0;
    correct_delay(trace.velocity, delay, step, ends);
    if (vibrometer.sign < 0) notes.push_back("velocity: sign reversed as declared");
    if (gain != 1) notes.push_back(fmt::format("velocity: divided by the declared gain {}", general(gain, 4)));
    if (delay != 0) notes.push_back(fmt::format("velocity: moved {} ms earlier as declared", general(1e3 * delay, 4)));
  }
  const double gain = sensor.gain ? sensor.gain->value : 1;
  subtract_zero(trace, sensor, notes);
  scale(trace.friction, 1 / gain, 0);
  if (gain != 1) notes.push_back(fmt::format("friction: divided by the declared gain {}", general(gain, 4)));
  if (sensor.crosstalk) {
    correct_crosstalk(trace, sensor.crosstalk->value);
    notes.push_back(fmt::format("friction: declared crosstalk {} subtracted", general(sensor.crosstalk->value, 4)));
  }
  if (sensor.bandwidth) {
    // Second order with zeta = 0.7 (flat response): group delay 2 zeta / (2 pi f_0) at low frequency.
    const double delay = 2 * 0.7 / ((2 * std::numbers::pi) * sensor.bandwidth->value);
    correct_delay(trace.friction, delay, step, ends);
    notes.push_back(fmt::format("friction: moved {} ms earlier for the declared bandwidth of {}",
                                general(1e3 * delay, 4), frequency_text(sensor.bandwidth->value)));
  }
  return ends;
}

void add_sensor_mass(Trace& trace, std::span<const double> block_velocity, double mass, double step,
                     std::vector<std::string>& notes) {
  const bool coefficient = trace.friction_kind == FrictionKind::coefficient;
  const bool measured = trace.load.size() == trace.friction.size() && !trace.load.empty();
  if (coefficient && !measured && !trace.conditions.load.known()) {
    notes.push_back("the declared mass below the force sensor is not corrected: the normal force is not known");
    return;
  }
  const std::vector<double> acceleration = savitzky_golay_slope(block_velocity, step, 10);
  for (std::size_t i = 0; i < trace.friction.size(); ++i) {
    const double load = !coefficient ? 1 : measured ? trace.load[i] : trace.conditions.load.value;
    if (load > 0) trace.friction[i] += mass * acceleration[i] / load;
  }
  notes.push_back(fmt::format("friction: inertia of the declared {} kg below the sensor added", general(mass, 4)));
}

namespace {

/// At rest the spring pulls the more the further the block is carried: where friction rises there its sign is right.
bool rises_at_rest(const Motion& motion, double scale) {
  double rise = 0;
  std::size_t rests = 0;  // samples before this one
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (rests > kShortestStretch)  // beyond the jump at re-stick
      rise += motion.disc_velocity_at(i) * (motion.friction[i] - motion.friction[i - 1]);
    rests = std::abs(motion.relative_velocity[i]) < 0.05 * scale ? rests + 1 : 0;
  }
  return rise > 0;
}

}  // namespace

void settle_friction_sign(Motion& motion, double scale) {
  if (scale == 0) return;
  double agreement = 0, total = 0, fast = 0;
  const std::size_t stride = std::max<std::size_t>(1, motion.size() / 65536);
  for (std::size_t i = 0; i < motion.size(); i += stride) {
    const double v = motion.relative_velocity[i];
    if (std::abs(v) < 0.1 * scale) continue;
    const double along = v > 0 ? motion.friction[i] : -motion.friction[i];
    agreement += along;
    total += std::abs(along);
    if (std::abs(v) > 0.5 * scale) fast += along;
  }
  motion.friction_drives = motion.sticks && fast < 0 && rises_at_rest(motion, scale);
  if (agreement >= -0.5 * total || total == 0 || motion.friction_drives) return;
  for (double& mu : motion.friction) mu = -mu;
  motion.notes.push_back("friction: sign reversed so that it is positive where v_r is");
}

}  // namespace tribofit::kinematics
