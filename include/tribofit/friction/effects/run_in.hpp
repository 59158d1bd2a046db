#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction approaches another level exponentially in sliding distance.
struct RunIn {
  static EffectInfo info() {
    return {
        .key = "run-in",
        .statement = "the surfaces wear in, so friction changes exponentially with the distance slid",
        .equation = "mu = f(v) (1 + w exp(-s/L))",
        .source = "P. J. Blau, Tribol. Int. 38 (2005) 1007",
        .experiment = "pause ten minutes and restart: run-in does not come back, heating does",
        .parameters = {{"w", "1", 1, -0.5, 0.5, 0}, {"L", "mm", 1e-3, 10, 1e5, 300, kNoNeutralValue, false, false, 6}},
        .needs = {.distance = true}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::exp;
    return mu * (1.0 + p[0] * exp(-x.distance / p[1]));
  }
};

}  // namespace tribofit
