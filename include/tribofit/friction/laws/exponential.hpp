#pragma once

#include <cmath>

#include "tribofit/friction/law.hpp"

namespace tribofit {

/// mu_k + (mu_s - mu_k) exp(-alpha v), [D] Eq 2.
struct ExponentialLaw : TwoLevelLaw<ExponentialLaw> {
  static constexpr std::string_view key = "exponential";

  static LawInfo info() {
    return {.statement = "friction falls exponentially with speed from its static to its kinetic level",
            .equation = "mu = mu_k + (mu_s - mu_k) exp(-alpha v)",
            .source = "[D] Eq 2; V. I. Johannes, M. A. Green, C. A. Brockley, Wear 24 (1973) 381",
            .parameters = {static_level(), kinetic_level(), decay_factor("alpha", 0.05)},
            .two_levels = true};
  }
  template <class T>
  static T steepness(const T* q) {
    return q[2];
  }
  static double for_steepness(double steepness) { return steepness; }
  template <class T>
  static T shape(const T& x) {
    using std::exp;
    return exp(-x);
  }
  /// shape + variance shape''/2; the next term is of fourth order in the spread.
  template <class T>
  static T mean_shape(const T& x, const T& variance) {
    return shape(x) * (1.0 + 0.5 * variance);
  }
};

}  // namespace tribofit
