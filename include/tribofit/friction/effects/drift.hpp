#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction changes along a straight line in time.
struct Drift {
  static constexpr std::string_view key = "drift";
  /// Distinguishes a drift from what levels off.
  static constexpr std::string_view record_longer =
      "also record a run ten times as long at a quarter of the disc speed on fresh, cool surfaces: a drift goes on at "
      "the same rate, heating levels off and run-in takes the same distance; or pause ten minutes and restart: heating "
      "comes back";

  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "friction or its reading drifts along a straight line in time",
            .equation = "mu = f(v) (1 + d t)",
            .source = "first term of any slow change",
            .experiment = "a longer record: a line goes on where an exponential levels off",
            .parameters = {{.name = "d",
                            .description = "relative change of friction in unit time",
                            .unit = "1/s",
                            // Friction keeps its sign to the end of the record, and no more than trebles.
                            .lower = -0.02,
                            .upper = 0.05,
                            .bound_scaling = BoundScaling::against_duration}},
            .sketch = {.view = SketchView::time, .values = {0.003}}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu * (1.0 + p[0] * x.time);
  }
};

}  // namespace tribofit
