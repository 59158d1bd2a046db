#pragma once

#include <cmath>

#include "tribofit/friction/law.hpp"

namespace tribofit {

/// mu_0 + A ln(v/v0), v0 = 1 mm/s: the steady state of rate-and-state friction, A = a - b.
///
/// Below `linear_below` it goes on along its tangent, so that it is finite at rest and has no kink.
struct LogarithmicLaw {
  static constexpr std::string_view key = "logarithmic";
  static constexpr double reference_speed = 1e-3;  ///< v0 [m/s]
  /// [m/s]: a few times the noise of a vibrometer. Nearer to rest readings of the speed would say nothing of ln v, and
  /// means over samples that come to rest would bias A.
  static constexpr double linear_below = 1e-4;

  static LawInfo info() {
    return {.statement = "friction changes by the same amount for every tenfold of the speed (steady rate and state)",
            .equation = "mu = mu_0 + A ln(v/v0), v0 = 1 mm/s; along the tangent below 0.1 mm/s",
            .source =
                "J. H. Dieterich, J. Geophys. Res. 84 (1979) 2161, doi:10.1029/JB084iB05p02161; A. Ruina, J. Geophys. "
                "Res. 88 (1983) 10359, doi:10.1029/JB088iB12p10359",
            .parameters = {{.name = "mu_0",
                            .description = "friction at 1 mm/s",
                            .upper = 5,
                            .start = 0.4,
                            .scales_with_friction = true},
                           {.name = "A",
                            .description =
                                "change of friction for an e-fold of the speed (a - b); negative where friction falls",
                            .lower = -0.5,
                            .upper = 0.5,
                            .start = -0.01,
                            .scales_with_friction = true}},
            .steep_at_rest = true};
  }
  static std::vector<double> start(const FrictionCurve& curve) {
    const FrictionCurve::Line line = curve.line_over([](double v) { return logarithm(v); });
    return {line.constant, line.slope};
  }
  /// ln(v/v0), along its tangent below linear_below.
  template <class T>
  static T logarithm(const T& v) {
    using std::log;
    if (v < linear_below) return v / linear_below + (std::log(linear_below / reference_speed) - 1);
    return log(v / reference_speed);
  }
  /// Its integral from linear_below to v [m/s].
  template <class T>
  static T integral(const T& v) {
    using std::log;
    const double c = linear_below, at_c = std::log(c / reference_speed);
    if (v < c) return (v - c) * (at_c + (v - c) / (2 * c));
    return v * (log(v / reference_speed) - 1.0) - c * (at_c - 1);
  }
  /// Mean of the logarithm over an even spread of speeds; of what would lie below rest, the part above it.
  template <class T>
  static T mean_logarithm(const T& v, const T& variance) {
    using std::sqrt;
    // Far from the tangent, where a difference of integrals would lose its digits: the series in variance/v^2.
    if (3.0 * variance < 0.01 * v * v && v > 2 * linear_below) {
      const T s = variance / (v * v);
      return logarithm(v) - 0.5 * s - 0.45 * s * s;
    }
    if (!(variance > 1e-24)) return logarithm(v);
    const T half = sqrt(3.0 * variance);
    const T low = v > half ? T(v - half) : T(0.0 * v), high = v + half;
    return (integral(high) - integral(low)) / (high - low);
  }
  template <class T>
  static T at_rest(const T* q) {
    return friction(q, T(0.0 * q[0]));
  }
  template <class T>
  static T friction(const T* q, const T& v) {
    return q[0] + q[1] * logarithm(v);
  }
  template <class T>
  static T mean_friction(const T* q, const T& v, const T& variance) {
    return q[0] + q[1] * mean_logarithm(v, variance);
  }
};

}  // namespace tribofit
