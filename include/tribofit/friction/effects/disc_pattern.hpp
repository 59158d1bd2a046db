#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction varies around the disc: two and three waves a revolution.
struct DiscPattern {
  static EffectInfo info() {
    return {
        .key = "disc-pattern",
        .statement = "friction differs around the disc (spots, transfer film), with more than one wave a revolution",
        .equation = "mu = f(v) (1 + A_2 cos(2 theta + phase_2) + A_3 cos(3 theta + phase_3))",
        .source = "Fourier terms of any pattern fixed to the disc; needs at least two revolutions",
        .experiment = "turn the disc by a quarter on its hub: the pattern turns with it",
        .parameters = {{"A_2", "1", 1, 0, 0.1, 0.01, 0},
                       {"phase_2", "rad", 1, -6.3, 6.3, 0, kNoNeutralValue, false, false, 4},
                       {"A_3", "1", 1, 0, 0.1, 0.005, 0},
                       {"phase_3", "rad", 1, -6.3, 6.3, 0, kNoNeutralValue, false, false, 4}},
        .needs = {.angle = true},
        .group = EffectGroup::rig};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    return mu * (1.0 + p[0] * cos(2 * x.angle + p[1]) + p[2] * cos(3 * x.angle + p[3]));
  }
};

}  // namespace tribofit
