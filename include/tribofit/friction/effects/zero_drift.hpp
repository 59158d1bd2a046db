#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The zero of the force sensor changes along a straight line in time: the reading is mu + b t.
struct ZeroDrift {
  static constexpr std::string_view key = "zero-drift";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "the zero of the force sensor drifts along a straight line in time",
        .equation = "reading = mu + b t",
        .source = "temperature of strain gauges and amplifiers; a drift of friction itself is larger where friction is",
        .experiment = "read the sensor without a force before and after the run",
        .parameters = {{.name = "b",
                        .description = "change of the reading without a force in unit time",
                        .unit = "1/s",
                        .lower = -0.005,
                        .upper = 0.005,
                        .neutral = 0,
                        .scales_with_friction = true,
                        .bound_scaling = BoundScaling::against_duration}},
        .needs = {.time = true},
        .excitation = {.changing_speed = true},
        .group = EffectGroup::measurement,
        .sketch = {.view = SketchView::time, .values = {0.002}}};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu + p[0] * x.time;
  }
};

}  // namespace tribofit
