#pragma once

#include <cmath>

#include "tribofit/friction/effects/crosstalk.hpp"

namespace tribofit {

/// Friction coefficient depends on the load: mu (N/N0)^-p.
struct LoadDependence {
  static constexpr std::string_view key = "load-dependence";
  static EffectInfo info() {
    return {
        .key = std::string(key),
        .statement =
            "friction coefficient falls with the load, as for elastic contacts that grow more slowly than the load",
        .equation = "mu = f(v) (N/N0)^-p, N0 the mean load of the record",
        .source = "J. F. Archard, Proc. R. Soc. A 243 (1957) 190",
        .experiment = "10 to 100 N in both directions",
        .parameters = {{.name = "p",
                        .description = "exponent with which the coefficient falls with the load",
                        .lower = -0.9,
                        .upper = 0.9}},
        .needs = {.load = true},
        .sketch = {.view = SketchView::load, .values = {0.2}},
        .pairs = {looks_like<Crosstalk>(
            "load from 10 to 90 N and slide in both directions: crosstalk keeps its sign when the direction turns")}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::exp;
    return x.load > 0 ? T(mu * exp(-p[0] * std::log(x.load / x.mean_load))) : mu;
  }
};

}  // namespace tribofit
