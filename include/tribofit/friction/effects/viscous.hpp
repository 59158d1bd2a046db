#pragma once

#include "tribofit/friction/effects/stribeck_exponent.hpp"

namespace tribofit {

/// Friction changes in proportion to speed, as a fluid or soft layer in the contact makes it grow: mu = f(v) + sigma v.
struct Viscous {
  static constexpr std::string_view key = "viscous";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement =
            "friction changes in proportion to the sliding speed: a fluid or soft layer in the contact makes it grow",
        .equation = "mu = f(v) + sigma v",
        .source =
            "R. Stribeck, Z. VDI 46 (1902) 1341; B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, "
            "Automatica 30 (1994) 1083, doi:10.1016/0005-1098(94)90209-7",
        .experiment = "run four times the disc speed: the excess keeps growing in a straight line",
        // Bounds: at the top speed once more what is usual for friction, or a quarter of it less.
        .parameters = {{.name = "sigma",
                        .description = "friction added per unit of sliding speed",
                        .unit = "s/mm",
                        .si = 1e3,
                        .lower = -0.00125,
                        .upper = 0.015,
                        .neutral = 0,
                        .scales_with_friction = true,
                        .bound_scaling = BoundScaling::against_top_speed}},
        .proportional_to_speed = true,
        .sketch = {.view = SketchView::curve, .values = {0.001}},
        .pairs = {looks_like<StribeckExponent>("run at four times the disc speed, or reach slips faster than "
                                               "3/alpha: viscous friction keeps rising there")}};
  }

  template <class T>
  T steady(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::abs;
    return mu + p[0] * abs(x.velocity);
  }
};

}  // namespace tribofit
