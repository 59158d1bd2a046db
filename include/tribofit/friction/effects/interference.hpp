#pragma once

#include <cmath>
#include <numbers>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// A line of fixed frequency on the friction channel.
struct Interference {
  static EffectInfo info() {
    return {.key = "interference",
            .statement = "mains hum or another line of fixed frequency rides on the friction channel",
            .equation = "reading = mu + A cos(2 pi f t + phase)",
            .source = "narrow-band pick-up",
            .experiment = "record with the disc at rest: the line stays",
            .parameters = {{"A", "1", 1, 0, 0.03, 0.003, 0, true},
                           {"f", "Hz", 1, 2, 10000, 50},
                           {"phase", "rad", 1, -6.3, 6.3, 0, kUnused, false, false, 4}},
            .group = EffectGroup::measurement};
  }

  template <class T>
  T read(const T* p, const Instant<T>& x, const T& mu) const {
    using std::cos;
    return mu + p[0] * cos(2 * std::numbers::pi * p[1] * x.time + p[2]);
  }
};

}  // namespace tribofit
