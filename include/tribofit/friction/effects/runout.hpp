#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The disc presses harder once a revolution: mu (1 + A cos(theta + phase)).
struct Runout {
  static EffectInfo info() {
    return {.key = "runout",
            .statement = "the disc runs out of true, so the load and with it the reading swings once a revolution",
            .equation = "mu = f(v) (1 + A cos(theta + phase))",
            .source = "textbook; needs at least two revolutions",
            .experiment = "laser on the unloaded disc; at least three revolutions",
            .parameters = {{"A", "1", 1, 0, 0.15, 0.01, 0},
                           {"phase", "rad", 1, -6.3, 6.3, 0, kNoNeutralValue, false, false, 4}},
            .needs = {.angle = true},
            .group = EffectGroup::rig};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    return mu * (1.0 + p[0] * cos(x.angle + p[1]));
  }
};

}  // namespace tribofit
