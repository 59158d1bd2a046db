#pragma once

#include <cstddef>
#include <limits>

#include "plateau.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Plateau of v_b over the stated omega r.
struct PlateauRatio {
  double value = std::numeric_limits<double>::quiet_NaN();      ///< creep of the contact taken off
  double std_error = std::numeric_limits<double>::quiet_NaN();  ///< from stick to stick
  double in_motion = std::numeric_limits<double>::quiet_NaN();  ///< the same of v_r as it stands (1 behind a high-pass)
};

/// Ratio of the plateau of v_b to omega r, from means over parts of every plateau between 45 and 80 % of it: re-stick,
/// whose ringing makes a contact creep more, is over, break-away has not begun.
///
/// In stick 1 - v_r/(omega r) = ratio - b x with x = 1/(1 - mu/mu_s): a bristle creeps by (dmu/dt)/sigma0 x (Canudas de
/// Wit 1995 with mu = sigma0 z), and every stick rises at about the same rate. b is the slope common to all sticks,
/// mu_s 0.5 to 6 % above the highest friction of each, where the lines fit best. The ratio is taken at x = 0 where b is
/// four standard errors above zero, else it is the mean. Where a high-pass was undone, the level of v_b is an
/// integration constant; it then follows from no net displacement of the block: a line through its positions in the
/// middles of the plateaus. NaN with fewer than three plateaus. `plateaus` in blocks of `factor` samples of the motion.
/// Cost: one pass over at most 512 plateaus; behind a high-pass one over the samples.
PlateauRatio plateau_ratio(const Motion& motion, const Plateaus& plateaus, std::size_t factor);

}  // namespace tribofit::kinematics
