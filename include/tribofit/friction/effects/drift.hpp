#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction changes along a straight line in time.
struct Drift {
  static EffectInfo info() {
    return {.key = "drift",
            .statement = "friction or its reading drifts along a straight line in time",
            .equation = "mu = f(v) (1 + d t)",
            .source = "first term of any slow change",
            .experiment = "a longer record: a line goes on where an exponential levels off",
            .parameters = {{"d", "1/s", 1, -0.005, 0.005, 0}}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu * (1.0 + p[0] * x.time);
  }
};

}  // namespace tribofit
