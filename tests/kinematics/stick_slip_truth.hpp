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
  bool coulomb = false;
  unsigned seed = 1;
  double speed() const { return rpm * 2 * std::numbers::pi / 60; }
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
  const double c = 2 * rig.zeta * std::sqrt(rig.mass * rig.stiffness), disc = rig.speed() * rig.radius;
  const auto n = static_cast<std::size_t>(rig.rate * rig.duration);
  const double step = 1 / rig.rate, fine = step / 8;
  double level = rig.static_friction + rig.scatter * normal(random);
  const auto law = [&](double v) {
    const double drop = level - rig.kinetic_friction;
    return rig.kinetic_friction + drop * (rig.coulomb ? (v > 0 ? 0.0 : 1.0) : std::exp(-rig.decay * v));
  };
  const auto acceleration = [&](double x, double v) {
    return (rig.load * law(disc - v) - rig.stiffness * x - c * v) / rig.mass;
  };
  double x = 0.6 * rig.load * level / rig.stiffness, v = disc, t = 0;
  bool sticking = true;
  Trace& trace = run.trace;
  for (std::size_t i = 0; i < n; ++i) {
    const double until = static_cast<double>(i) * step;
    while (t < until) {
      if (sticking) {
        const double x_break = (rig.load * level - c * disc) / rig.stiffness;
        const double t_break = t + (x_break - x) / disc;
        if (t_break > until) {
          x += disc * (until - t), t = until;
        } else {
          x = x_break, t = t_break, sticking = false;
          run.break_away_time.push_back(t);
          run.break_away_friction.push_back(level);
        }
        continue;
      }
      const double h = std::min(fine, until - t);
      const double a1 = acceleration(x, v), v2 = v + 0.5 * h * a1, a2 = acceleration(x + 0.5 * h * v, v2);
      const double v3 = v + 0.5 * h * a2, a3 = acceleration(x + 0.5 * h * v2, v3), v4 = v + h * a3;
      const double a4 = acceleration(x + h * v3, v4);
      const double x_next = x + h / 6 * (v + 2 * v2 + 2 * v3 + v4), v_next = v + h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
      const bool began = t - run.break_away_time.back() < 2 * fine;
      if (v_next >= disc && !began) {
        const double part = (disc - v) / (v_next - v);
        x += part * (x_next - x), t += part * h, v = disc, sticking = true;
        run.restick_time.push_back(t);
        level = rig.static_friction + rig.scatter * normal(random);
      } else {
        x = x_next, v = std::min(v_next, disc), t += h;
      }
    }
    trace.time.push_back(until);
    trace.velocity.push_back(sticking ? disc : v);
    trace.friction.push_back(sticking ? (rig.stiffness * x + c * disc) / rig.load : law(disc - v));
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
