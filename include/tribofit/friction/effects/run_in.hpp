#pragma once

#include "tribofit/friction/effects/drift.hpp"

namespace tribofit {

/// Friction approaches another level exponentially in sliding distance.
struct RunIn {
  static constexpr std::string_view key = "run-in";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the surfaces wear in, so friction changes exponentially with the distance slid",
            .equation = "mu = f(v) (1 + w exp(-s/L))",
            .source = "P. J. Blau, Tribol. Int. 38 (2005) 1007",
            .experiment = "pause ten minutes and restart: run-in does not come back, heating does",
            .parameters = {{.name = "w",
                            .description = "share by which friction is higher on fresh surfaces",
                            .lower = -0.8,  // fresh surfaces have a fifth to three times the friction
                            .upper = 2},
                           {.name = "L",
                            .description = "sliding distance over which the surfaces wear in",
                            .unit = "mm",
                            .si = 1e-3,
                            .lower = 10,
                            .upper = 1e5,
                            .start = 300,
                            .bound_scaling = BoundScaling::with_distance,
                            .start_grid_points = 6,
                            .decisive = true}},
            .needs = {.distance = true},
            .sketch = {.view = SketchView::distance, .values = {0.15, 60}},
            .pairs = {looks_like<Drift>(Drift::record_longer)}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::exp;
    return mu * (1.0 + p[0] * exp(-x.distance / p[1]));
  }
};

}  // namespace tribofit
