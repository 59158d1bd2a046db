#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Part of the normal force shows in the tangential channel: Ft + chi Fn.
struct Crosstalk {
  static constexpr std::string_view key = "crosstalk";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "part of the normal force shows in the tangential channel",
            .equation = "reading = mu + chi N/N0 over the nominal load N0",
            .source = "calibration matrix of a two-axis force sensor",
            .experiment = "10 to 100 N in both directions without sliding",
            .parameters = {{.name = "chi",
                            .description = "share of the normal force that the tangential channel shows",
                            .lower = -0.2,
                            .upper = 0.2}},
            .needs = {.load = true},
            .group = EffectGroup::measurement,
            .declared_by = InstrumentValue::force_crosstalk,
            .sketch = {.view = SketchView::load, .values = {0.03}}};
  }

  template <class T>
  T add_to_reading(const T* p, const SlidingState<T>& x, const T& mu) const {
    return mu + p[0] * (x.load / x.mean_load);
  }
};

}  // namespace tribofit
