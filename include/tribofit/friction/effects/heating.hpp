#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction approaches another level exponentially in time.
struct Heating {
  static EffectInfo info() {
    return {
        .key = "heating",
        .statement = "friction changes as the parts warm up, exponentially in time",
        .equation = "mu = f(v) (1 - h (1 - exp(-t/tau_h)))",
        .source = "first-order thermal response, cf. J. C. Jaeger, Proc. R. Soc. N.S.W. 76 (1942) 203",
        .experiment = "pause ten minutes and restart: heating comes back, run-in does not",
        .parameters = {{"h", "1", 1, -0.3, 0.3, 0}, {"tau_h", "s", 1, 3, 600, 20, kNoNeutralValue, false, false, 5}}};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::exp;
    return mu * (1.0 - p[0] * (1.0 - exp(-x.time / p[1])));
  }
};

}  // namespace tribofit
