#pragma once

#include <cmath>

namespace tribofit {

/// The block on its spring: m x'' + c x' + k x = N mu(v_r), v_r = v_disc - x' ([U] Eq 1, [C]).
struct Rig {
  double mass = 0;       ///< m, all that moves with the block [kg], > 0
  double damping = 0;    ///< c [N s/m], >= 0
  double stiffness = 0;  ///< k [N/m], > 0

  /// sqrt(k/m) [rad/s].
  double natural_frequency() const { return std::sqrt(stiffness / mass); }
  /// c / (2 sqrt(k m)) [1].
  double damping_ratio() const { return damping / (2 * std::sqrt(stiffness * mass)); }
};

/// A rig from its damping ratio instead of c. Arguments in SI; ratio [1].
inline Rig rig_with_damping_ratio(double mass, double stiffness, double ratio) {
  return {mass, 2 * ratio * std::sqrt(stiffness * mass), stiffness};
}

}  // namespace tribofit
