#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "rodas.hpp"
#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/ingest/conditions.hpp"

// The contact of rate-and-state friction on a massless spring whose far end, the load point, moves at a speed that
// changes in steps: d mu/dt = k (v_lp - v). Written for numbers and for dual numbers: the derivatives of the computed
// response by its parameters are those of the very steps that were taken.

namespace tribofit::oscillator {

/// How closely ln v and ln theta are followed, and where a motion is given up.
inline constexpr double kSliderTolerance = 1e-6;
inline constexpr std::size_t kMostSliderSteps = 20000;
/// ln of the speed over that of the load point: faster by e^25, sliding has run away; inertia would decide.
inline constexpr double kRunAway = 25;

inline double number_of(double x) {
  return x;
}
template <class T>
double number_of(const T& x) {
  return x.a;
}

/// Friction less mu_0 of a contact with kStates state variables, in the unknowns u = ln(v/v0), psi_i = ln(v0
/// theta_i/D_i).
template <class T, std::size_t kStates>
class RateStateSlider {
 public:
  using Step = RodasStep<T, 1 + kStates>;
  using State = typename Step::State;  ///< u, then the psi_i

  RateStateSlider(StateEvolution evolution, const RateStateParameters<T>& parameters, double reference_speed)
      : evolution_(evolution), p_(parameters), v0_(reference_speed) {}

  /// Steady sliding at `speed` > 0.
  void begin_steady(double speed) {
    const double u = std::log(speed / v0_);
    state_.fill(T(-u));
    state_[0] = T(u);
    fastest_ = u;
  }

  T friction(const State& y) const {
    T mu = p_.a * y[0];
    for (std::size_t i = 0; i < kStates; ++i) mu += p_.b[i] * y[1 + i];
    return mu;
  }
  double slip_speed() const { return v0_ * std::exp(number_of(state_[0])); }

  /// Goes on from `begin` to `end` with the load point at `speed` >= 0; writes friction at those of `times` (ascending,
  /// within [begin, end]). False where the sliding runs away or no step is small enough.
  bool run(double begin, double end, double speed, std::span<const double> times, T* friction_at) {
    if (speed > 0) fastest_ = std::max(fastest_, std::log(speed / v0_));
    double t = begin, h = first_step(speed, end - begin);
    std::size_t next = 0;
    while (next < times.size() && times[next] <= begin) friction_at[next++] = friction(state_);
    const double least = 1e-14 * std::max(std::abs(begin), std::abs(end)) + 1e-300;
    while (t < end) {
      if (++steps_ > kMostSliderSteps) return false;
      const bool last = t + h * (1 + 1e-9) >= end;
      if (last) h = end - t;
      const double error = step(h, speed), change = next_step_over_this(error);
      if (!(error <= 1)) {
        h *= change;
        if (h < least) return false;
        continue;
      }
      const double reached = last ? end : t + h;
      next = write(t, h, reached, times, next, friction_at);
      state_ = step_.after;
      if (number_of(state_[0]) - fastest_ > kRunAway) return false;
      t = reached;
      h *= change;
    }
    while (next < times.size()) friction_at[next++] = friction(state_);
    return true;
  }

 private:
  /// A small part of the shortest time in which the speed of the contact changes.
  double first_step(double speed, double span) const {
    const double v = std::max(slip_speed(), speed);
    double length = number_of(p_.a) / number_of(p_.stiffness);
    for (std::size_t i = 0; i < kStates; ++i) length = std::min(length, number_of(p_.distance[i]));
    return std::min(span, 0.02 * length / v);
  }

  /// Of one state variable: d psi/dt and its derivatives by u and psi.
  struct Rate {
    T value, by_u, by_psi;
  };
  Rate rate_of(std::size_t i, const T& v, const T& u, const T& psi) const {
    using std::exp;
    if (evolution_ == StateEvolution::ageing) {
      const T grows = v0_ * exp(-psi) / p_.distance[i], renewed = v / p_.distance[i];
      return {grows - renewed, -renewed, -grows};
    }
    const T renewed = v / p_.distance[i];
    const T value = -(renewed * (u + psi));
    return {value, value - renewed, -renewed};
  }
  State rates(const State& y, double speed) const {
    using std::exp;
    const T v = v0_ * exp(y[0]);
    State out;
    T left = p_.stiffness * (speed - v);
    for (std::size_t i = 0; i < kStates; ++i) {
      out[1 + i] = rate_of(i, v, y[0], y[1 + i]).value;
      left -= p_.b[i] * out[1 + i];
    }
    out[0] = left / p_.a;
    return out;
  }

  /// One step of length h; the root mean square of error over tolerance.
  double step(double h, double speed) {
    using std::exp;
    // W = I/(gamma h) - J is an arrow: psi_i is bound to u alone.
    const T v = v0_ * exp(state_[0]);
    const double diagonal = 1 / (Step::gamma * h);
    std::array<T, kStates> by_u{}, inverse{}, above{};
    T pivot = T(diagonal) + p_.stiffness * v / p_.a;
    for (std::size_t i = 0; i < kStates; ++i) {
      const Rate rate = rate_of(i, v, state_[0], state_[1 + i]);
      const T part = p_.b[i] / p_.a;
      by_u[i] = rate.by_u;
      inverse[i] = 1.0 / (diagonal - rate.by_psi);
      above[i] = part * rate.by_psi * inverse[i];  // W_ui/W_ii
      pivot += part * rate.by_u + above[i] * rate.by_u;
    }
    const T over_pivot = 1.0 / pivot;
    const auto solve = [&](const State& right) {
      State x;
      T u = right[0];
      for (std::size_t i = 0; i < kStates; ++i) u -= above[i] * right[1 + i];
      x[0] = u * over_pivot;
      for (std::size_t i = 0; i < kStates; ++i) x[1 + i] = (right[1 + i] + by_u[i] * x[0]) * inverse[i];
      return x;
    };
    step_.take(
        state_, h, rates(state_, speed), [&](std::size_t, const State& at) { return rates(at, speed); }, solve);
    double squares = 0;
    for (const T& x : step_.error()) squares += number_of(x) * number_of(x);
    return std::sqrt(squares / (1 + kStates)) / kSliderTolerance;
  }

  /// Friction at the times within the step from t to `reached`, by the interpolant.
  std::size_t write(double t, double h, double reached, std::span<const double> times, std::size_t next,
                    T* friction_at) const {
    if (next >= times.size() || times[next] > reached) return next;
    const auto [second, third] = step_.bends();
    const T before = friction(state_), after = friction(step_.after), c2 = friction(second), c3 = friction(third);
    for (; next < times.size() && times[next] <= reached; ++next) {
      const double s = std::min(1.0, (times[next] - t) / h), rest = 1 - s;
      friction_at[next] = rest * before + s * after + (s * rest) * c2 + (s * s * rest) * c3;
    }
    return next;
  }

  StateEvolution evolution_;
  RateStateParameters<T> p_;
  double v0_;
  State state_ = {};
  Step step_;
  double fastest_ = 0;  ///< u of the fastest load point so far
  std::size_t steps_ = 0;
};

/// Friction less mu_0 at `times` (ascending) under a load point, from steady sliding at its first speed; false as in
/// run(). `times` do not begin before the load point does.
template <class T, std::size_t kStates>
bool slide_under(StateEvolution evolution, const RateStateParameters<T>& parameters, double reference_speed,
                 std::span<const LoadPointPhase> phases, std::span<const double> times, T* friction_at) {
  RateStateSlider<T, kStates> slider(evolution, parameters, reference_speed);
  slider.begin_steady(phases.front().speed);
  const double end = times.empty() ? phases.front().begin : times.back();
  std::size_t first = 0;
  for (std::size_t i = 0; i < phases.size(); ++i) {
    const double until = i + 1 < phases.size() ? std::min(phases[i + 1].begin, end) : end;
    std::size_t last = first;
    while (last < times.size() && (times[last] < until || i + 1 == phases.size() || until >= end)) ++last;
    if (!slider.run(phases[i].begin, until, phases[i].speed, times.subspan(first, last - first), friction_at + first))
      return false;
    first = last;
    if (first == times.size()) break;
  }
  return true;
}

}  // namespace tribofit::oscillator
