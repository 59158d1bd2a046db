#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// A few cycles of a block on its disc, from break-away to break-away. SI; all channels have the same length.
struct BlockMotion {
  std::vector<double> time;          ///< since the first break-away [s]
  std::vector<double> displacement;  ///< of the block from where its spring is unloaded [m]
  std::vector<double> velocity;      ///< v_b [m/s]
  std::vector<double> friction;      ///< [1 or N]
  std::vector<std::uint8_t> sticks;  ///< 1 in stick
  double disc_velocity = 0;          ///< omega r, mean over the cycles [m/s]
  std::size_t cycles = 0;

  std::size_t size() const { return time.size(); }
};

/// `count` cycles in a row that are whole, as near to the middle of the record as they come; empty where there are
/// none.
///
/// The displacement is the integral of v_b. A velocity does not show where it begins and how it drifts: at the first
/// and the last break-away it is set to where the spring balances friction, compliance times the break-away level.
/// compliance: N/k, displacement of the spring for a unit of friction [m]; 0: it begins at 0 and ends there.
BlockMotion block_motion(const Motion& motion, const Segmentation& segmentation, double compliance,
                         std::size_t count = 3);

}  // namespace tribofit
