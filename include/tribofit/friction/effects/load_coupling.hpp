#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The tangential force loads or relieves the contact: N = N0/(1 - kappa mu).
struct LoadCoupling {
  static EffectInfo info() {
    return {.key = "load-coupling",
            .statement = "the tangential force presses the block on or lifts it off (lever arm of the holder)",
            .equation = "N = N0/(1 - kappa mu), so Ft/N0 = mu/(1 - kappa mu)",
            .source = "moments about the pivot of the holder, textbook (self-locking, spragging)",
            .experiment = "reverse the disc: what pressed now lifts, and the load channel moves the other way",
            .parameters = {{"kappa", "1", 1, -0.3, 0.3, 0}},
            .needs = {.load = true},
            .group = EffectGroup::rig};
  }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& /*x*/, const T& mu) const {
    return mu / (1.0 - p[0] * mu);
  }
};

}  // namespace tribofit
