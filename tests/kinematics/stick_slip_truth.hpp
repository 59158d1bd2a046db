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
  double wander = 0;  // correlation of the scatter from cycle to cycle
  bool coulomb = false;
  unsigned seed = 1;
  double ripple = 0, ripple_order = 1, ripple_phase = 0;  // omega (1 + A cos(n omega t + phase))
  double speed() const { return rpm * 2 * std::numbers::pi / 60; }
  double disc(double t) const {  // m/s
    return speed() * radius * (1 + ripple * std::cos(ripple_order * speed() * t + ripple_phase));
  }
  double disc_acceleration(double t) const {
    const double w = ripple_order * speed();
    return -speed() * radius * ripple * w * std::sin(w * t + ripple_phase);
  }
  double disc_travel(double t) const {  // from t = 0
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

inline Run simulate(const Rig& rig) {
  Run run;
  std::mt19937_64 random(rig.seed);
  std::normal_distribution<double> normal;
  const double c = 2 * rig.zeta * std::sqrt(rig.mass * rig.stiffness);
  const auto n = static_cast<std::size_t>(rig.rate * rig.duration);
  const double step = 1 / rig.rate, fine = step / 8;
  double deviation = normal(random);
  double level = rig.static_friction + rig.scatter * deviation;
  const auto law = [&](double v) {
    const double drop = level - rig.kinetic_friction;
    return rig.kinetic_friction + drop * (rig.coulomb ? (v > 0 ? 0.0 : 1.0) : std::exp(-rig.decay * v));
  };
  const auto acceleration = [&](double x, double v, double t) {
    return (rig.load * law(rig.disc(t) - v) - rig.stiffness * x - c * v) / rig.mass;
  };
  double x = 0.6 * rig.load * level / rig.stiffness, v = rig.disc(0), t = 0;
  bool sticking = true;
  Trace& trace = run.trace;
  for (std::size_t i = 0; i < n; ++i) {
    const double until = static_cast<double>(i) * step;
    while (t < until) {
      if (sticking) {
        const double before = x - rig.disc_travel(t);
        const auto position = [&](double when) { return before + rig.disc_travel(when); };
        const auto pull = [&](double when) {
          return rig.stiffness * position(when) + c * rig.disc(when) + rig.mass * rig.disc_acceleration(when);
        };
        if (pull(until) < rig.load * level) {
          x = position(until), t = until;
        } else {
          double low = t, high = until;
          for (int k = 0; k < 60; ++k) {
            const double middle = 0.5 * (low + high);
            (pull(middle) < rig.load * level ? low : high) = middle;
          }
          x = position(high), t = high, v = rig.disc(t), sticking = false;
          run.break_away_time.push_back(t);
          run.break_away_friction.push_back(level);
        }
        continue;
      }
      const double h = std::min(fine, until - t);
      const double a1 = acceleration(x, v, t), v2 = v + 0.5 * h * a1;
      const double a2 = acceleration(x + 0.5 * h * v, v2, t + 0.5 * h), v3 = v + 0.5 * h * a2;
      const double a3 = acceleration(x + 0.5 * h * v2, v3, t + 0.5 * h), v4 = v + h * a3;
      const double a4 = acceleration(x + h * v3, v4, t + h);
      const double x_next = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4), v_next = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      const bool began = t - run.break_away_time.back() < 2 * fine;
      const double gap = rig.disc(t) - v, gap_next = rig.disc(t + h) - v_next;
      if (gap_next <= 0 && !began) {
        const double part = gap / (gap - gap_next);
        x += part * (x_next - x), t += part * h, v = rig.disc(t), sticking = true;
        run.restick_time.push_back(t);
        deviation = rig.wander * deviation + std::sqrt(1 - rig.wander * rig.wander) * normal(random);
        level = rig.static_friction + rig.scatter * deviation;
      } else {
        x = x_next, v = std::min(v_next, rig.disc(t + h)), t += h;
      }
    }
    trace.time.push_back(until);
    const double disc = rig.disc(until);
    const double held = (rig.stiffness * x + c * disc + rig.mass * rig.disc_acceleration(until)) / rig.load;
    trace.velocity.push_back(sticking ? disc : v);
    trace.friction.push_back(sticking ? held : law(disc - v));
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
