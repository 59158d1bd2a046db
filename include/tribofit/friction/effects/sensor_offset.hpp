#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Zero of the force sensor: the reading is mu + b.
struct SensorOffset {
  static constexpr std::string_view key = "sensor-offset";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the force sensor does not read zero without a force",
            .equation = "reading = mu + b",
            .source = "instrument zero; visible only where v_r takes both signs",
            .experiment = "lift the block off the disc and read the sensor",
            .parameters = {{.name = "b",
                            .description = "reading of the force sensor without a force",
                            .lower = -0.2,
                            .upper = 0.2,
                            .neutral = 0,
                            .scales_with_friction = true}},
            .excitation = {.both_directions = true},
            .group = EffectGroup::measurement,
            .declared_by = InstrumentValue::force_zero,
            .sketch = {.view = SketchView::directions, .values = {0.03}}};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& /*x*/, const T& mu) const {
    return mu + p[0];
  }
};

}  // namespace tribofit
