#pragma once

#include "tribofit/friction/law.hpp"

namespace tribofit {

/// mu_k + (mu_s - mu_k) / (1 + beta v), [D] Eq 3.
struct FractionalLaw : TwoLevelLaw<FractionalLaw> {
  static constexpr std::string_view key = "fractional";

  static LawInfo info() {
    return {.statement = "friction falls from its static to its kinetic level as one over the speed, with a long tail",
            .equation = "mu = mu_k + (mu_s - mu_k) / (1 + beta v)",
            .source = "[D] Eq 3",
            .parameters = {static_level(), kinetic_level(), decay_factor("beta", 0.1)},
            .two_levels = true};
  }
  template <class T>
  static T steepness(const T* q) {
    return q[2];
  }
  static double for_steepness(double steepness) { return steepness; }
  template <class T>
  static T shape(const T& x) {
    return 1.0 / (1.0 + x);
  }
  /// shape + variance shape''/2; the next term is of fourth order in the spread.
  template <class T>
  static T mean_shape(const T& x, const T& variance) {
    const T s = shape(x);
    return s * (1.0 + variance * s * s);
  }
};

}  // namespace tribofit
