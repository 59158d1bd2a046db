#pragma once

// A small 1-DOF stick-slip simulator with exact events, written for the tests only and apart from the library's own
// oscillator, so that truth and result do not share code.

#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "tribofit/ingest/trace.hpp"

namespace tribofit::truth {

struct Rig {
  double mass = 0.85, stiffness = 16200, zeta = 0.02, load = 50, radius = 0.015;
  double rpm = 4;
  double static_friction = 0.509, kinetic_friction = 0.318, decay = 52.14;  // s/m
  double rate = 20000, duration = 6;
  double friction_noise = 0.003, velocity_noise = 2e-5, noise_correlation = 0, scatter = 0;
  double wander = 0;         // correlation of the scatter from cycle to cycle
  double level_scatter = 0;  // of all friction of a cycle, as a part of it
  bool coulomb = false;
  bool fractional = false;    // friction falls as 1/(1 + decay v)
  bool flat_at_rest = false;  // friction falls as exp(-(decay v)^2)
  unsigned seed = 1;
  double ripple = 0, ripple_order = 1, ripple_phase = 0;  // omega (1 + A cos(n omega t + phase))
  double step_at = HUGE_VAL, speed_ratio = 1;             // from then on [s] the disc turns so many times as fast
  double speed() const { return rpm * 2 * std::numbers::pi / 60; }
  double disc(double t) const {  // m/s
    if (t >= step_at) return speed_ratio * speed() * radius;
    return speed() * radius * (1 + ripple * std::cos(ripple_order * speed() * t + ripple_phase));
  }
  double disc_acceleration(double t) const {
    const double w = ripple_order * speed();
    return -speed() * radius * ripple * w * std::sin(w * t + ripple_phase);
  }
  double disc_travel(double t) const {  // from t = 0
    if (t >= step_at) return disc_travel(step_at - 1e-12) + (t - step_at) * disc(t);
    const double w = ripple_order * speed();
    return speed() * radius * (t + ripple / w * (std::sin(w * t + ripple_phase) - std::sin(ripple_phase)));
  }
};

struct Run {
  Trace trace;
  std::vector<double> break_away_time, break_away_friction, restick_time;
};

/// Noise of given standard deviation, first-order autoregressive.
inline std::vector<double> noise(std::size_t n, double sigma, double rho, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  std::vector<double> e(n);
  double state = normal(random);
  for (double& x : e) {
    x = sigma * state;
    state = rho * state + std::sqrt(1 - rho * rho) * normal(random);
  }
  return e;
}

/// The block from event to event.
class Block {
 public:
  Block(const Rig& rig, std::mt19937_64& random, Run& run) : rig_(rig), random_(random), run_(run) {
    deviation_ = normal_(random_);
    draw_level();
    x_ = 0.6 * rig_.load * level_ / rig_.stiffness;
    v_ = rig_.disc(0);
  }

  void advance(double until) {
    while (t_ < until) sticking_ ? stick(until) : slip(until);
  }
  double velocity() const { return sticking_ ? rig_.disc(t_) : v_; }
  double friction() const { return sticking_ ? pull(x_, t_) / rig_.load : law(rig_.disc(t_) - v_); }

 private:
  void draw_level() {
    factor_ = 1 + rig_.level_scatter * deviation_;
    level_ = factor_ * rig_.static_friction + rig_.scatter * deviation_;
  }
  double law(double v) const {
    const double x = rig_.decay * v, lowest = factor_ * rig_.kinetic_friction, drop = level_ - lowest;
    if (rig_.coulomb) return lowest + drop * (v > 0 ? 0.0 : 1.0);
    if (rig_.fractional) return lowest + drop / (1 + x);
    return lowest + drop * std::exp(rig_.flat_at_rest ? -x * x : -x);
  }
  double acceleration(double x, double v, double t) const {
    return (rig_.load * law(rig_.disc(t) - v) - rig_.stiffness * x - damping_ * v) / rig_.mass;
  }
  /// What friction must hold for the block to keep up with the disc.
  double pull(double x, double t) const {
    return rig_.stiffness * x + damping_ * rig_.disc(t) + rig_.mass * rig_.disc_acceleration(t);
  }

  void stick(double until) {
    const double before = x_ - rig_.disc_travel(t_);
    const auto position = [&](double when) { return before + rig_.disc_travel(when); };
    const auto holds = [&](double when) { return pull(position(when), when) < rig_.load * level_; };
    if (holds(until)) {
      x_ = position(until), t_ = until;
      return;
    }
    double low = t_, high = until;
    for (int k = 0; k < 60; ++k) {
      const double middle = 0.5 * (low + high);
      (holds(middle) ? low : high) = middle;
    }
    x_ = position(high), t_ = high, v_ = rig_.disc(t_), sticking_ = false;
    run_.break_away_time.push_back(t_);
    run_.break_away_friction.push_back(level_);
  }

  /// One step of classical Runge-Kutta, or the part of it up to re-stick.
  void slip(double until) {
    const double h = std::min(fine_, until - t_);
    const double a1 = acceleration(x_, v_, t_), v2 = v_ + 0.5 * h * a1;
    const double a2 = acceleration(x_ + 0.5 * h * v_, v2, t_ + 0.5 * h), v3 = v_ + 0.5 * h * a2;
    const double a3 = acceleration(x_ + 0.5 * h * v2, v3, t_ + 0.5 * h), v4 = v_ + h * a3;
    const double a4 = acceleration(x_ + h * v3, v4, t_ + h);
    const double x = x_ + h / 6 * (v_ + 2 * v2 + 2 * v3 + v4), v = v_ + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    const bool began = t_ - run_.break_away_time.back() < 2 * fine_;
    const double gap = rig_.disc(t_) - v_, gap_after = rig_.disc(t_ + h) - v;
    if (gap_after > 0 || began) {
      x_ = x, v_ = std::min(v, rig_.disc(t_ + h)), t_ += h;
      return;
    }
    const double part = gap / (gap - gap_after);
    x_ += part * (x - x_), t_ += part * h, v_ = rig_.disc(t_), sticking_ = true;
    run_.restick_time.push_back(t_);
    deviation_ = rig_.wander * deviation_ + std::sqrt(1 - rig_.wander * rig_.wander) * normal_(random_);
    draw_level();
  }

  const Rig& rig_;
  std::mt19937_64& random_;
  Run& run_;
  std::normal_distribution<double> normal_;
  const double damping_ = 2 * rig_.zeta * std::sqrt(rig_.mass * rig_.stiffness);
  const double fine_ = 1 / rig_.rate / 8;
  double deviation_ = 0, factor_ = 1, level_ = 0;  ///< level_: static friction of this cycle
  double x_ = 0, v_ = 0, t_ = 0;
  bool sticking_ = true;
};

inline Run simulate(const Rig& rig) {
  Run run;
  std::mt19937_64 random(rig.seed);
  const auto n = static_cast<std::size_t>(rig.rate * rig.duration);
  Block block(rig, random, run);
  Trace& trace = run.trace;
  for (std::size_t i = 0; i < n; ++i) {
    const double time = static_cast<double>(i) * (1 / rig.rate);
    block.advance(time);
    trace.time.push_back(time);
    trace.velocity.push_back(block.velocity());
    trace.friction.push_back(block.friction());
  }
  const auto e_mu = noise(n, rig.friction_noise, rig.noise_correlation, random);
  const auto e_v = noise(n, rig.velocity_noise, rig.noise_correlation, random);
  for (std::size_t i = 0; i < n; ++i) trace.friction[i] += e_mu[i], trace.velocity[i] += e_v[i];
  trace.path = "simulated";
  trace.conditions.radius = {rig.radius, "file"};
  trace.conditions.speed = {rig.speed(), "file"};
  trace.conditions.load = {rig.load, "file"};
  trace.steps = {{0, n, "", {}}};
  return run;
}

/// What a first-order high-pass makes of a signal (exact for a signal constant within a sample).
inline void high_pass(std::vector<double>& signal, double corner, double rate) {
  const double factor = std::exp(-2 * std::numbers::pi * corner / rate);
  double low = signal.empty() ? 0 : signal[0];
  for (double& x : signal) {
    const double in = x;
    x = in - low;
    low = factor * low + (1 - factor) * in;
  }
}

}  // namespace tribofit::truth
