#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// Friction follows its steady value late in time: d phi/dt = (f(v) - phi)/tau.
struct FrictionalLag {
  static EffectInfo info() {
    return {.key = "frictional-lag",
            .statement = "friction follows a change of speed late, by a constant time",
            .equation = "d phi/dt = (f(v) - phi)/tau, mu = phi, phi = mu_s at break-away",
            .source =
                "first-order form of D. P. Hess, A. Soom, J. Tribol. 112 (1990) 147; "
                "B. Armstrong-Helouvry, P. Dupont, C. Canudas de Wit, Automatica 30 (1994) 1083, "
                "doi:10.1016/0005-1098(94)90209-7",
            .experiment =
                "1, 2, 4 and 8 rpm: the loop stays constant in ms; a delay of the channels also shows at re-stick",
            .parameters = {{"tau", "ms", 1e-3, 0.1, 10, 1, 0.1, false, false, 3, BoundScaling::with_slip_time}}};
  }

  template <class T>
  Relaxation<T> relaxation(const T* p, const SlidingState<T>& /*x*/, const T& steady) const {
    return {1.0 / p[0], steady};
  }
};

}  // namespace tribofit
