#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction steps at one time (debris, a transfer film that breaks).
struct StepChange {
  static constexpr std::string_view key = "step";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "friction steps once, as when debris enters the contact or a transfer film breaks",
            .equation = "mu = f(v) + delta for t >= t_c",
            .source = "change point, cf. E. S. Page, Biometrika 41 (1954) 100, doi:10.1093/biomet/41.1-2.100",
            .experiment = "repeat the run on fresh surfaces: a step does not come back at the same time",
            .parameters = {{.name = "delta",
                            .description = "change of friction",
                            .lower = -0.4,
                            .upper = 0.4,
                            .start = 0.01,
                            .neutral = 0,
                            .scales_with_friction = true},
                           {.name = "t_c",
                            .description = "time of the change, from the first sample of the record",
                            .unit = "s",
                            .lower = 0,
                            .upper = 1e4,
                            .start = 10,
                            .bound_scaling = BoundScaling::with_duration,
                            .scope = ParameterScope::record,
                            .search = ParameterSearch::moment_of_change,
                            .decisive = true}},
            .sketch = {.view = SketchView::time, .values = {0.03, 20}}};
  }

  /// The change takes a thousandth of the time before it, shorter than a cycle, so that its time has a derivative. Far
  /// from it tanh is one to the last bit.
  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::abs;
    using std::tanh;
    constexpr double kWidth = 2.5e-4, kNotZero = 1e-9, kFar = 20;
    const double late = x.time - scalar_part(p[1]), width = kWidth * (x.time + std::abs(scalar_part(p[1]))) + kNotZero;
    if (std::abs(late) > kFar * width) return late > 0 ? T(mu + x.direction * p[0]) : mu;
    return mu + x.direction * p[0] * (0.5 + 0.5 * tanh((x.time - p[1]) / (kWidth * (x.time + abs(p[1])) + kNotZero)));
  }
};

}  // namespace tribofit
