#pragma once

#include <cmath>

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction coefficient depends on the load: mu (N/N0)^-p.
struct LoadDependence {
  static EffectInfo info() {
    return {.key = "load-dependence",
            .statement =
                "friction coefficient falls with the load, as for elastic contacts that grow more slowly than the load",
            .equation = "mu = f(v) (N/N0)^-p, N0 the mean load of the record",
            .source = "J. F. Archard, Proc. R. Soc. A 243 (1957) 190",
            .experiment = "10 to 100 N in both directions",
            .parameters = {{"p", "1", 1, -0.1, 0.4, 0}},
            .needs = {.load = true}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::exp;
    return x.load > 0 ? T(mu * exp(-p[0] * std::log(x.load / x.mean_load))) : mu;
  }
};

}  // namespace tribofit
