#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "tribofit/friction/state_evolution.hpp"
#include "tribofit/ingest/conditions.hpp"

// The contact of rate-and-state friction on a massless spring whose far end, the load point, moves at a speed that
// changes in steps: d mu/dt = k (v_lp - v). Written for numbers and for dual numbers: the derivatives of the computed
// response by its parameters are those of the very steps that were taken.

namespace tribofit::oscillator {

/// Coefficients of RODAS (E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 1996, IV.7 and IV.10; the
/// program rodas.f): six stages, order 4 with an estimate of order 3, L-stable, with an interpolant of order 3.
struct Rodas {
  static constexpr std::size_t kStages = 6;
  static constexpr double gamma = 0.25;
  /// Row s: by which the stages before are added to the state, and to the right side of stage s.
  static constexpr std::array<std::array<double, 5>, kStages> a = {{
      {},
      {1.544},
      {0.9466785280815826, 0.2557011698983284},
      {3.314825187068521, 2.896124015972201, 0.9986419139977817},
      {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950},
      {1.221224509226641, 6.019134481288629, 12.53708332932087, -0.6878860361058950, 1},
  }};
  static constexpr std::array<std::array<double, 5>, kStages> c = {{
      {},
      {-5.6688},
      {-2.430093356833875, -0.2063599157091915},
      {-0.1073529058151375, -9.594562251023355, -20.47028614809616},
      {7.496443313967647, -10.24680431464352, -33.99990352819905, 11.70890893206160},
      {8.083246795921522, -7.981132988064893, -31.52159432874371, 16.31930543123136, -6.058818238834054},
  }};
  static constexpr std::array<double, 5> d2 = {10.12623508344586, -7.487995877610167, -34.80091861555747,
                                               -7.992771707568823, 1.025137723295662};
  static constexpr std::array<double, 5> d3 = {-0.6762803392801253, 6.087714651680015, 16.43084320892478,
                                               24.76722511418386, -6.594389125716872};
};

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
  struct State {
    T u = T(0.0);
    std::array<T, kStates> psi = {};
  };

  RateStateSlider(StateEvolution evolution, const RateStateParameters<T>& parameters, double reference_speed)
      : evolution_(evolution), p_(parameters), v0_(reference_speed) {}

  /// Steady sliding at `speed` > 0.
  void begin_steady(double speed) {
    const double u = std::log(speed / v0_);
    state_.u = T(u);
    for (T& psi : state_.psi) psi = T(-u);
    fastest_ = u;
  }

  T friction(const State& y) const {
    using std::log;
    T mu = p_.a * y.u;
    for (std::size_t i = 0; i < kStates; ++i) mu += p_.b[i] * y.psi[i];
    return mu;
  }
  double slip_speed() const { return v0_ * std::exp(number_of(state_.u)); }

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
      const double error = step(h, speed);
      if (!(error <= 1)) {
        h *= std::isfinite(error) ? std::max(0.1, 0.9 / std::sqrt(std::sqrt(error))) : 0.1;
        if (h < least) return false;
        continue;
      }
      const double reached = last ? end : t + h;
      next = write(t, h, reached, times, next, friction_at);
      state_ = new_;
      if (number_of(state_.u) - fastest_ > kRunAway) return false;
      t = reached;
      h *= std::clamp(0.9 / std::sqrt(std::sqrt(std::max(error, 1e-8))), 0.2, 6.0);
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
  /// d psi/dt alone.
  T rate_value(std::size_t i, const T& v, const T& u, const T& psi) const {
    using std::exp;
    if (evolution_ == StateEvolution::ageing) return (v0_ * exp(-psi) - v) / p_.distance[i];
    return -(v / p_.distance[i]) * (u + psi);
  }

  State rates(const State& y, double speed) const {
    using std::exp;
    const T v = v0_ * exp(y.u);
    State out;
    T left = p_.stiffness * (speed - v);
    for (std::size_t i = 0; i < kStates; ++i) {
      out.psi[i] = rate_value(i, v, y.u, y.psi[i]);
      left -= p_.b[i] * out.psi[i];
    }
    out.u = left / p_.a;
    return out;
  }

  /// One step of length h; the root mean square of error over tolerance. Fills new_ and the stages.
  double step(double h, double speed) {
    using std::exp;
    // W = I/(gamma h) - J is an arrow: psi_i is bound to u alone.
    const T v = v0_ * exp(state_.u);
    const double diagonal = 1 / (Rodas::gamma * h);
    std::array<T, kStates> by_u{}, inverse{}, above{};
    T pivot = T(diagonal) + p_.stiffness * v / p_.a;
    State first;
    T left = p_.stiffness * (speed - v);
    for (std::size_t i = 0; i < kStates; ++i) {
      const Rate rate = rate_of(i, v, state_.u, state_.psi[i]);
      const T part = p_.b[i] / p_.a;
      by_u[i] = rate.by_u;
      inverse[i] = 1.0 / (diagonal - rate.by_psi);
      above[i] = part * rate.by_psi * inverse[i];  // W_ui/W_ii
      pivot += part * rate.by_u + above[i] * rate.by_u;
      first.psi[i] = rate.value;
      left -= p_.b[i] * rate.value;
    }
    first.u = left / p_.a;
    const T over_pivot = 1.0 / pivot;
    const auto solve = [&](const State& right) {
      State x;
      T u = right.u;
      for (std::size_t i = 0; i < kStates; ++i) u -= above[i] * right.psi[i];
      x.u = u * over_pivot;
      for (std::size_t i = 0; i < kStates; ++i) x.psi[i] = (right.psi[i] + by_u[i] * x.u) * inverse[i];
      return x;
    };
    for (std::size_t s = 0; s < Rodas::kStages; ++s) {
      State at = state_, right;
      if (s == 0) {
        right = first;
      } else {
        for (std::size_t j = 0; j < s; ++j) add(Rodas::a[s][j], stage_[j], at);
        right = rates(at, speed);
        for (std::size_t j = 0; j < s; ++j) add(Rodas::c[s][j] / h, stage_[j], right);
      }
      stage_[s] = solve(right);
      if (s + 1 == Rodas::kStages) new_ = at;
    }
    const State& correction = stage_[Rodas::kStages - 1];
    add(1.0, correction, new_);
    double squares = number_of(correction.u) * number_of(correction.u);
    for (const T& psi : correction.psi) squares += number_of(psi) * number_of(psi);
    return std::sqrt(squares / (1 + kStates)) / kSliderTolerance;
  }

  static void add(double factor, const State& x, State& to) {
    to.u += factor * x.u;
    for (std::size_t i = 0; i < kStates; ++i) to.psi[i] += factor * x.psi[i];
  }

  /// Friction at the times within the step from t to `reached`, by the interpolant.
  std::size_t write(double t, double h, double reached, std::span<const double> times, std::size_t next,
                    T* friction_at) const {
    if (next >= times.size() || times[next] > reached) return next;
    State second, third;
    for (std::size_t j = 0; j < 5; ++j) {
      add(Rodas::d2[j], stage_[j], second);
      add(Rodas::d3[j], stage_[j], third);
    }
    const T before = friction(state_), after = friction(new_), c2 = friction(second), c3 = friction(third);
    for (; next < times.size() && times[next] <= reached; ++next) {
      const double s = std::min(1.0, (times[next] - t) / h), rest = 1 - s;
      friction_at[next] = rest * before + s * after + (s * rest) * c2 + (s * s * rest) * c3;
    }
    return next;
  }

  StateEvolution evolution_;
  RateStateParameters<T> p_;
  double v0_;
  State state_, new_;
  std::array<State, Rodas::kStages> stage_;
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
