#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// Means over a tenth of a stick, signed in the direction of the slip that follows.
struct StickPart {
  double time = 0;               ///< of its middle [s]
  double relative_velocity = 0;  ///< v_r [m/s]: 0 in rigid stick
  double disc_velocity = 0;      ///< omega r [m/s]
  double friction = 0;           ///< [1 or N]
  double friction_rate = 0;      ///< d friction/dt, from the tenths before and after [1/s or N/s]
};

/// One stick, without its first two tenths, which hold the transient of re-stick, and its last two, which hold the
/// break-away.
struct StickCreep {
  std::size_t cycle = 0;  ///< index in Segmentation::cycles
  std::array<StickPart, 6> parts;
};

/// How the block moves against the disc while it sticks: the evidence from stick for what lets v_r differ from zero.
///
/// A bristle creeps by v_r = friction_rate/sigma0/(1 - friction/mu_s) (Canudas de Wit 1995 with mu = sigma0 z), a wrong
/// radius or gain leaves the same v_r in every part, a contact that spins with the disc creeps in proportion to
/// disc_velocity, and a high-pass lets v_r grow in proportion to the time since re-stick. Sticks with fewer than
/// 5 samples a tenth are left out. v_r is that of the motion: what was corrected there does not show any more.
/// Cost: one pass over the samples in stick.
std::vector<StickCreep> stick_motion(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
