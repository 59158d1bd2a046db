#pragma once

#include <cmath>

#include "tribofit/friction/law.hpp"

namespace tribofit {

/// mu_k + (mu_s - mu_k) exp(-(v/v_s)^2): flat at rest, and no tail beyond a few v_s.
struct GaussianLaw : TwoLevelLaw<GaussianLaw> {
  static constexpr std::string_view key = "gaussian";

  static LawInfo info() {
    return {.statement = "friction stays near its static level up to a certain speed, then falls to its kinetic level",
            .equation = "mu = mu_k + (mu_s - mu_k) exp(-(v/v_s)^2)",
            .source =
                "L. C. Bo, D. Pavelescu, Wear 82 (1982) 277; B. Armstrong-Helouvry, Control of Machines with Friction, "
                "Kluwer (1991)",
            .parameters = {static_level(),
                           kinetic_level(),
                           {.name = "v_s",
                            .description = "speed of the fall: there 37 % of it is still to come",
                            .unit = "mm/s",
                            .si = 1e-3,
                            .lower = 0.01,
                            .upper = 1e4,
                            .start = 10,
                            .bound_scaling = BoundScaling::with_speed}},
            .two_levels = true};
  }
  template <class T>
  static T steepness(const T* q) {
    return 1.0 / q[2];
  }
  static double for_steepness(double steepness) { return 1 / steepness; }
  template <class T>
  static T shape(const T& x) {
    using std::exp;
    return exp(-x * x);
  }
  /// Over a normal spread exactly, which stays between 0 and 1 however wide it is.
  template <class T>
  static T mean_shape(const T& x, const T& variance) {
    using std::exp;
    using std::sqrt;
    const T widened = 1.0 + 2.0 * variance;
    return exp(-x * x / widened) / sqrt(widened);
  }
};

}  // namespace tribofit
