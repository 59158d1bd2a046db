#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Zero of the force sensor: the reading is mu + b.
struct SensorOffset {
  static EffectInfo info() {
    return {.key = "sensor-offset",
            .statement = "the force sensor does not read zero without a force",
            .equation = "reading = mu + b",
            .source = "instrument zero; visible only where v_r takes both signs",
            .experiment = "lift the block off the disc and read the sensor",
            .parameters = {{"b", "1", 1, -0.05, 0.05, 0, 0, true}},
            .group = EffectGroup::measurement};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& /*x*/, const T& mu) const {
    return mu + p[0];
  }
};

}  // namespace tribofit
