#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>
#include <vector>

#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/ingest/conditions.hpp"
#include "tribofit/oscillator/velocity_steps.hpp"

namespace tribofit::apart {

/// Rate-and-state friction on a spring, written apart from the library: the unknowns are mu and theta themselves, the
/// speed follows from mu = mu_0 + a ln(v/v0) + sum b_i ln(v0 theta_i/D_i), and the steps are those of Dormand and
/// Prince (J. Comput. Appl. Math. 6 (1980) 19), ending at every sample. Tolerance 1e-10 of mu and of ln theta. Throws
/// std::runtime_error where sliding runs away.
class Contact {
 public:
  using State = std::array<double, 1 + kMostStates>;

  explicit Contact(const RateStateMachine& machine) : m_(machine) {}

  std::vector<double> friction(std::span<const LoadPointPhase> phases, std::span<const double> times) {
    State y{};
    const double first = phases.front().speed;
    double rate = m_.parameters.a;
    for (std::size_t i = 0; i < m_.states; ++i) {
      y[1 + i] = m_.parameters.distance[i] / first;
      rate -= m_.parameters.b[i];
    }
    y[0] = m_.base_friction + rate * std::log(first / m_.reference_speed);
    double t = phases.front().begin, h = 1e-4;
    std::size_t phase = 0;
    std::vector<double> out;
    for (const double sample : times) {
      while (t < sample) {
        while (phase + 1 < phases.size() && phases[phase + 1].begin <= t) ++phase;
        const double next = phase + 1 < phases.size() ? std::min(sample, phases[phase + 1].begin) : sample;
        advance(phases[phase].speed, t, next, h, y);
      }
      out.push_back(y[0]);
    }
    return out;
  }

 private:
  State rates(const State& y, double speed) const {
    const auto& p = m_.parameters;
    double exponent = y[0] - m_.base_friction;
    for (std::size_t i = 0; i < m_.states; ++i)
      exponent -= p.b[i] * std::log(m_.reference_speed * y[1 + i] / p.distance[i]);
    const double v = m_.reference_speed * std::exp(exponent / p.a);
    State out{};
    out[0] = p.stiffness * (speed - v);
    for (std::size_t i = 0; i < m_.states; ++i) {
      const double x = v * y[1 + i] / p.distance[i];
      out[1 + i] = m_.evolution == StateEvolution::ageing ? 1 - x : -x * std::log(x);
    }
    return out;
  }

  void advance(double speed, double& t, double end, double& h, State& y) const {
    static constexpr double a[7][6] = {{},
                                       {1.0 / 5},
                                       {3.0 / 40, 9.0 / 40},
                                       {44.0 / 45, -56.0 / 15, 32.0 / 9},
                                       {19372.0 / 6561, -25360.0 / 2187, 64448.0 / 6561, -212.0 / 729},
                                       {9017.0 / 3168, -355.0 / 33, 46732.0 / 5247, 49.0 / 176, -5103.0 / 18656},
                                       {35.0 / 384, 0, 500.0 / 1113, 125.0 / 192, -2187.0 / 6784, 11.0 / 84}};
    static constexpr double e[7] = {71.0 / 57600,      0,          -71.0 / 16695, 71.0 / 1920,
                                    -17253.0 / 339200, 22.0 / 525, -1.0 / 40};
    while (t < end) {
      const bool last = t + h >= end;
      const double step = last ? end - t : h;
      std::array<State, 7> k;
      State at = y;
      for (int s = 0; s < 7; ++s) {
        at = y;
        for (int j = 0; j < s; ++j) {
          for (std::size_t i = 0; i < y.size(); ++i) at[i] += step * a[s][j] * k[static_cast<std::size_t>(j)][i];
        }
        k[static_cast<std::size_t>(s)] = rates(at, speed);
      }
      double error = 0;
      for (std::size_t i = 0; i < 1 + m_.states; ++i) {
        double off = 0;
        for (std::size_t s = 0; s < 7; ++s) off += step * e[s] * k[s][i];
        // A comparison with NaN would keep the error of the other unknowns.
        const double part = std::abs(off) / (1e-10 * (i == 0 ? 1 : std::abs(y[i])));
        error = std::isfinite(part) ? std::max(error, part) : std::numeric_limits<double>::infinity();
      }
      if (error <= 1) {
        y = at;
        t = last ? end : t + step;
      }
      if (!last && step < 1e-13 * std::max(1.0, std::abs(t)))
        throw std::runtime_error("the sliding of the truth runs away");
      const double factor = std::isfinite(error) ? 0.9 * std::pow(std::max(error, 1e-6), -0.2) : 0.2;
      if (!last || error > 1) h = step * std::clamp(factor, 0.2, 4.0);
    }
  }

  const RateStateMachine& m_;
};

}  // namespace tribofit::apart
