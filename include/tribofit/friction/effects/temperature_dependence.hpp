#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction coefficient depends on temperature: mu (1 + k_T (T - T0)).
struct TemperatureDependence {
  static constexpr std::string_view key = "temperature-dependence";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "friction coefficient changes with the temperature of the contact",
        .equation = "mu = f(v) (1 + k_T (T - T0)), T0 the mean temperature of the record",
        .source =
            "linear term of any smooth dependence; for brake materials cf. A. E. Anderson, ASM Handbook 18 (1992) 569",
        .experiment = "the same run with the disc heated from outside",
        .parameters = {{.name = "k_T",
                        .description = "relative change of friction per kelvin",
                        .unit = "1/K",
                        .lower = -0.05,
                        .upper = 0.05}},
        .needs = {.temperature = true},
        .sketch = {.view = SketchView::temperature, .values = {0.005}}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu * (1.0 + p[0] * (x.temperature - x.mean_temperature));
  }
};

}  // namespace tribofit
