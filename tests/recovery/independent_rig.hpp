#pragma once

/// A block on a disc, simulated apart from the library: nothing of src/oscillator and nothing of src/friction is used,
/// so that an error there cannot hide behind a simulation that makes the same one.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <random>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace independent {

/// The rig, its friction and what is hidden in it; SI. Hidden effects are absent at their defaults.
struct Rig {
  double mass = 0.85, stiffness = 14e3, damping_ratio = 0.02;
  double load = 50, radius = 0.015, speed = 4 * 2 * std::numbers::pi / 60;  ///< [N], [m], [rad/s]
  double swing = 0;             ///< the disc goes forth and back at this frequency [Hz]; 0: constant speed
  bool reads_relative = false;  ///< v_r is recorded, and not what the disc does

  bool fractional = false;  ///< the law: falls as 1/(1 + decay v), else as exp(-decay v)
  double mu_s = 0.51, mu_k = 0.34, decay = 50;
  double scatter = 0.006;  ///< of mu_s from cycle to cycle

  double viscous = 0;                           ///< [s/m]
  double lag = 0;                               ///< [s]
  double drift = 0;                             ///< [1/s]
  double runout = 0, runout_phase = 0;          ///< [1], [rad]
  double ratio = 1;                             ///< of friction where the block is slid backwards
  double delay = 0;                             ///< of the friction channel [s]
  double low_pass = 0, low_pass_damping = 0.7;  ///< of the force sensor [Hz], [1]

  double duration = 12, rate = 10000;                       ///< of the record [s], [Hz]
  double friction_noise = 0.003, velocity_noise = 0.02e-3;  ///< [1], [m/s]
  std::uint64_t seed = 1;
};

/// Runge-Kutta of fourth order in steps of a tenth of a sample in slip, where the block sticks again at the end of the
/// first step that turns v_r round; stick in closed form.
class Simulation {
 public:
  explicit Simulation(const Rig& rig)
      : rig_(rig), damping_(2 * rig.damping_ratio * std::sqrt(rig.stiffness * rig.mass)), random_(rig.seed) {}

  tribofit::Trace run() {
    constexpr int kSteps = 10;       // in a sample
    constexpr double kSettle = 3.0;  // before the record [s]
    const double h = 1 / (kSteps * rig_.rate);
    const auto lead = static_cast<std::ptrdiff_t>(std::lround(kSettle / h));
    const auto shift = static_cast<std::ptrdiff_t>(std::lround(rig_.delay / h));
    const auto samples = static_cast<std::size_t>(rig_.duration * rig_.rate);
    const auto steps = lead + static_cast<std::ptrdiff_t>(samples) * kSteps + std::max<std::ptrdiff_t>(0, -shift);
    mu_s_ = rig_.mu_s;
    std::vector<double> friction, velocity;
    double reading = 0, slope = 0;  // of the low-pass
    for (std::ptrdiff_t i = 0; i < steps; ++i) {
      const double t = static_cast<double>(i - lead) * h;
      const double speed = sticks_ ? disc_speed(t) : state_.velocity;
      double mu = step(t, h);
      if (rig_.low_pass > 0) {
        const double w = 2 * std::numbers::pi * rig_.low_pass;
        slope += h * (w * w * (mu - reading) - 2 * rig_.low_pass_damping * w * slope);
        reading += h * slope;
        mu = reading;
      }
      friction.push_back(mu);
      velocity.push_back(speed);
    }
    tribofit::Trace trace;
    trace.path = "independent";
    for (std::size_t i = 0; i < samples; ++i) {
      const auto at = lead + static_cast<std::ptrdiff_t>(i) * kSteps;
      const double t = static_cast<double>(i) / rig_.rate;
      trace.time.push_back(t);
      trace.friction.push_back(friction[static_cast<std::size_t>(at - shift)] + rig_.friction_noise * normal());
      const double v = velocity[static_cast<std::size_t>(at)];
      trace.velocity.push_back((rig_.reads_relative ? disc_speed(t) - v : v) + rig_.velocity_noise * normal());
      if (rig_.swing > 0 && !rig_.reads_relative) trace.disc_speed.push_back(disc_speed(t) / rig_.radius);
    }
    if (rig_.reads_relative) trace.velocity_kind = tribofit::VelocityKind::relative;
    trace.conditions.radius = {rig_.radius, "command line"};
    trace.conditions.load = {rig_.load, "command line"};
    if (rig_.swing == 0) trace.conditions.speed = {rig_.speed, "command line"};
    trace.steps = {{0, samples, "", trace.conditions}};
    return trace;
  }

 private:
  struct State {
    double position = 0, velocity = 0, memory = 0;
  };

  /// Of the disc under the block [m/s], and its rate.
  double disc_speed(double t) const {
    const double v = rig_.speed * rig_.radius;
    return rig_.swing > 0 ? v * std::sin(2 * std::numbers::pi * rig_.swing * t) : v;
  }
  double disc_acceleration(double t) const {
    const double w = 2 * std::numbers::pi * rig_.swing;
    return w * rig_.speed * rig_.radius * std::cos(w * t);
  }

  double law(double v) const {
    const double fall = rig_.fractional ? 1 / (1 + rig_.decay * v) : std::exp(-rig_.decay * v);
    return rig_.mu_k + (mu_s_ - rig_.mu_k) * fall + rig_.viscous * v;
  }
  /// What time, angle and direction make of friction.
  double factor(double t, int direction) const {
    const double around = 1 + rig_.runout * std::cos(rig_.speed * t + rig_.runout_phase);
    return (1 + rig_.drift * t) * around * (direction < 0 ? rig_.ratio : 1.0);
  }
  double friction(const State& s, double t) const {
    const double steady = law(std::abs(disc_speed(t) - s.velocity));
    return direction_ * factor(t, direction_) * (rig_.lag > 0 ? s.memory : steady);
  }

  State rate(const State& s, double t) const {
    const double steady = law(std::abs(disc_speed(t) - s.velocity));
    const double force = rig_.load * friction(s, t) - damping_ * s.velocity - rig_.stiffness * s.position;
    return {s.velocity, force / rig_.mass, rig_.lag > 0 ? (steady - s.memory) / rig_.lag : 0.0};
  }
  static State moved(const State& s, const State& rate, double h) {
    return {s.position + h * rate.position, s.velocity + h * rate.velocity, s.memory + h * rate.memory};
  }

  /// Over [t, t + h]; returns mu at t.
  double step(double t, double h) {
    if (sticks_) {
      state_.velocity = disc_speed(t);
      const double mu = (rig_.stiffness * state_.position + damping_ * state_.velocity +
                         rig_.mass * (rig_.swing > 0 ? disc_acceleration(t) : 0.0)) /
                        rig_.load;
      const int direction = mu < 0 ? -1 : 1;
      if (std::abs(mu) <= mu_s_ * factor(t, direction)) {
        state_.position += h * disc_speed(t + h / 2);
        return mu;
      }
      sticks_ = false;
      direction_ = direction;
      state_.memory = mu_s_;
    }
    const double mu = friction(state_, t);
    const State a = rate(state_, t), b = rate(moved(state_, a, h / 2), t + h / 2),
                c = rate(moved(state_, b, h / 2), t + h / 2), d = rate(moved(state_, c, h), t + h);
    state_ = moved(moved(moved(moved(state_, a, h / 6), b, h / 3), c, h / 3), d, h / 6);
    if (direction_ * (disc_speed(t + h) - state_.velocity) < 0) {
      sticks_ = true;  // for a step at least; where the spring is too strong it breaks away again
      mu_s_ = rig_.mu_s + rig_.scatter * normal();
    }
    return mu;
  }

  double normal() {
    double sum = -6;  // of twelve uniform numbers, the same with every standard library
    for (int k = 0; k < 12; ++k) sum += static_cast<double>(random_() >> 11) * 0x1p-53;
    return sum;
  }

  Rig rig_;
  double damping_;
  std::mt19937_64 random_;
  State state_;
  bool sticks_ = true;
  int direction_ = 1;
  double mu_s_ = 0;
};

}  // namespace independent
