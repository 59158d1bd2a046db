#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction grows in proportion to speed: mu = f(v) + sigma v.
struct Viscous {
  static EffectInfo info() {
    return {.key = "viscous",
            .statement = "a fluid or soft layer in the contact adds friction in proportion to the sliding speed",
            .equation = "mu = f(v) + sigma v",
            .source =
                "R. Stribeck, Z. VDI 46 (1902) 1341; B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, "
                "Automatica 30 (1994) 1083, doi:10.1016/0005-1098(94)90209-7",
            .experiment = "run four times the disc speed: the excess keeps growing in a straight line",
            .parameters = {{"sigma", "s/mm", 1e3, -0.0005, 0.002, 0.0, 0.0, true}}};
  }

  template <class T>
  T steady(const T* p, const SlidingState<T>& x, const T& mu) const {
    using std::abs;
    return mu + p[0] * abs(x.velocity);
  }
};

}  // namespace tribofit
