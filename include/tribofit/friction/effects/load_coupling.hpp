#pragma once

#include "tribofit/friction/effect.hpp"

namespace tribofit {

/// The tangential force loads or relieves the contact: N = N0/(1 - kappa mu).
struct LoadCoupling {
  static constexpr std::string_view key = "load-coupling";
  static EffectInfo info() {
    return {.key = std::string(key),
            .statement = "the tangential force presses the block on or lifts it off (lever arm of the holder)",
            .equation = "N = N0/(1 - kappa mu), so Ft/N0 = mu/(1 - kappa mu)",
            .source = "moments about the pivot of the holder, textbook (self-locking, spragging)",
            .experiment = "reverse the disc: what pressed now lifts, and the load channel moves the other way",
            .parameters = {{.name = "kappa",
                            .description = "change of the normal force per unit of tangential force",
                            .lower = -0.9,
                            .upper = 0.9}},
            .needs = {.load = true},
            .group = EffectGroup::rig,
            .sketch = {.view = SketchView::load_channel, .values = {0.15}}};
  }

  /// What the load channel shows within the cycles.
  static FoundBeforeFit found_before_fit(const Motion& /*motion*/, const Estimate& load_coupling) {
    if (load_coupling.value == 0) return {};
    return {.values = {load_coupling},
            .reason = "the load channel follows friction within every cycle; that part was taken out of it"};
  }

  static double load_at_contact(const double* p, double load, double mu) { return load * (1 + p[0] * mu); }

  template <class T>
  T modulate(const T* p, const SlidingState<T>& /*x*/, const T& mu) const {
    return mu / (1.0 - p[0] * mu);
  }
};

}  // namespace tribofit
