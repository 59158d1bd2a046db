#pragma once

#include <cmath>
#include <numbers>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// A second mode of the rig rings down after each break-away.
struct Ringing {
  static EffectInfo info() {
    return {.key = "ringing",
            .statement = "a second mode of the rig is struck by each break-away and rings down",
            .equation = "reading = mu + A exp(-zeta w s) cos(w s + phase), w = 2 pi f, s = time since break-away",
            .source = "free vibration of a damped mode, textbook",
            .experiment = "tap the rig: the mode answers at the same frequency without sliding",
            .parameters = {{"A", "1", 1, 0, 0.05, 0.003, 0, true},
                           {"f", "Hz", 1, 30, 2000, 200},
                           {"zeta", "1", 1, 0.002, 0.1, 0.02, kNoNeutralValue, false, false, 3},
                           {"phase", "rad", 1, -6.3, 6.3, 0, kNoNeutralValue, false, false, 4}},
            .group = EffectGroup::rig};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    using std::exp;
    if (!(x.since_break_away >= 0)) return mu;
    const T w = 2 * std::numbers::pi * p[1];
    return mu + x.direction * p[0] * exp(-p[2] * w * x.since_break_away) * cos(w * x.since_break_away + p[3]);
  }
};

}  // namespace tribofit
