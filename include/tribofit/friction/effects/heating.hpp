#pragma once

#include "tribofit/friction/effects/drift.hpp"
#include "tribofit/friction/effects/run_in.hpp"

namespace tribofit {

/// Friction approaches another level exponentially in time.
struct Heating {
  static constexpr std::string_view key = "heating";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement = "friction changes as the parts warm up, exponentially in time",
        .equation = "mu = f(v) (1 - h (1 - exp(-t/tau_h)))",
        .source = "first-order thermal response, cf. J. C. Jaeger, Proc. R. Soc. N.S.W. 76 (1942) 203",
        .experiment = "pause ten minutes and restart: heating comes back, run-in does not",
        .parameters = {{.name = "h",
                        .description = "share of friction that is lost once the parts are warm",
                        .lower = -2,  // warm parts have a fifth to three times the friction
                        .upper = 0.8},
                       {.name = "tau_h",
                        .description = "time in which the parts warm up",
                        .unit = "s",
                        .lower = 3,
                        .upper = 600,
                        .start = 20,
                        .bound_scaling = BoundScaling::with_duration,
                        .start_grid_points = 5,
                        .within_record = true,
                        .decisive = true}},
        .sketch = {.view = SketchView::time, .values = {0.1, 8}},
        .pairs = {looks_like<RunIn>(
                      "also record 30 s at four times the disc speed on fresh, cool surfaces: heating keeps its time, "
                      "run-in its distance; or pause ten minutes and restart: heating comes back, run-in does not"),
                  looks_like<Drift>(Drift::record_longer)}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::exp;
    return mu * (1.0 - p[0] * (1.0 - exp(-x.time / p[1])));
  }
};

}  // namespace tribofit
