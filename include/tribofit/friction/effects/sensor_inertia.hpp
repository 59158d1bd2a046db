#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The force sensor carries a mass: the reading is mu - m_s a_b/N.
struct SensorInertia {
  static constexpr std::string_view key = "sensor-inertia";
  /// Distinguishes a mass from what makes friction follow the speed late.
  static constexpr std::string_view compare_jumps =
      "record with a spring four times as stiff too; or plot at re-stick the jump of mu against the jump of the "
      "block's "
      "acceleration: a straight line is a mass; or add 100 g below the sensor";

  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "a mass hangs below the force sensor, so the reading holds its inertia",
        .equation = "reading = mu - m_s a_b/N",
        .source = "Newton's second law for what is below the sensor",
        .experiment = "add 100 g below the sensor; at re-stick plot the jump of mu against the jump of acceleration",
        .parameters = {{.name = "m_s",
                        .description = "mass below the force sensor",
                        .unit = "kg",
                        .lower = 0,
                        .upper = 3,
                        .start = 0.05,
                        .neutral = 0,
                        .bound_scaling = BoundScaling::with_mass}},
        .needs = {.acceleration = true, .force = true},
        .group = EffectGroup::measurement,
        .declared_by = InstrumentValue::force_mass_below,
        .sketch = {.view = SketchView::acceleration, .values = {0.1}}};
  }

  static double mass_below_sensor(const double* p) { return p[0]; }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu - p[0] * x.acceleration / x.load;
  }
};

}  // namespace tribofit
