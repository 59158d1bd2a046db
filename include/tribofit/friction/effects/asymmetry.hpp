#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction differs by direction: both levels times ratio for v_r < 0.
struct Asymmetry {
  static EffectInfo info() {
    return {.key = "asymmetry",
            .statement = "friction differs by direction (texture, wear debris, tilted pad)",
            .equation = "mu_s' = ratio mu_s, mu_k' = ratio mu_k where v_r < 0",
            .source = "C. Canudas de Wit, K. J. Astrom, K. Braun, IEEE J. Robot. Autom. 3 (1987) 681",
            .experiment = "reverse the disc at the same speed and load",
            .parameters = {{"ratio", "1", 1, 0.5, 2, 1}}};
  }

  template <class T>
  void adjust(const T* p, const Slip& slip, LawParameters<T>& law) const {
    if (slip.direction > 0) return;
    law.mu_s *= p[0];
    law.mu_k *= p[0];
  }
};

}  // namespace tribofit
