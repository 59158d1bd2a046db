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
                           {"phase", "rad", 1, -6.3, 6.3, 0, kNoNeutralValue, false, false, 4}},
            .group = EffectGroup::measurement};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::cos;
    return mu + p[0] * cos(2 * std::numbers::pi * p[1] * x.time + p[2]);
  }

  /// The level comes from a straight line through the second half of the stick, over which a line of high frequency
  /// averages out: the response of a least-squares line, at its end, to a cosine.
  template <class T>
  T filter_break_away_reading(const T* p, const Slip& slip, const T& level) const {
    using std::cos;
    using std::sin;
    const T w = 2 * std::numbers::pi * p[1];
    const T here = w * slip.break_away_time + p[2];
    const T angle = 0.5 * w * slip.stick_time;  // over the half
    if (!(scalar_part(angle) > 1e-2)) return level + p[0] * cos(here);
    // Weights (4 + 6 t/L)/L over -L < t < 0, against cos(here + w t): 4 (sine terms) + 6 (the same times t/L).
    const T before = here - angle;
    const T mean = (sin(here) - sin(before)) / angle;
    const T moment = sin(before) / angle + (cos(here) - cos(before)) / (angle * angle);
    return level + p[0] * (4.0 * mean + 6.0 * moment);
  }
};

}  // namespace tribofit
