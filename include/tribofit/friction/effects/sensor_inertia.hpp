#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The force sensor carries a mass: the reading is mu - m_s a_b/N.
struct SensorInertia {
  static EffectInfo info() {
    return {
        .key = "sensor-inertia",
        .statement = "a mass hangs below the force sensor, so the reading holds its inertia",
        .equation = "reading = mu - m_s a_b/N",
        .source = "Newton's second law for what is below the sensor",
        .experiment = "add 100 g below the sensor; at re-stick plot the jump of mu against the jump of acceleration",
        .parameters = {{"m_s", "kg", 1, 0, 3, 0.05, 0, false, true}},
        .needs = {.acceleration = true, .force = true},
        .group = EffectGroup::measurement};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu - p[0] * x.acceleration / x.load;
  }
};

}  // namespace tribofit
