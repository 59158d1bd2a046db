#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "corrections.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Clocks of the two channels that run apart.
struct ClockDriftEstimate {
  Estimate drift;         ///< by which friction falls behind, over time [1]; 0: within its error
  double at_start = 0;    ///< by how much it is behind at the first sample [samples]
  std::size_t slips = 0;  ///< that were compared
  bool is_sharp = false;  ///< friction jumps from one sample to the next
};

/// From the jumps of friction at re-stick beside the times at which v_r comes to rest: a straight line of their
/// distance over time. resticks: [samples]. Cost: one look at every re-stick.
ClockDriftEstimate find_clock_drift(std::span<const double> friction, const std::vector<double>& resticks);

/// By how much later friction changes its sign than v_r does [samples], the median over the reversals of a motion; 0
/// for fewer than three. Cost: a pass.
double delay_at_reversals(std::span<const double> friction, std::span<const double> velocity);

/// Moves the velocity to the clock of friction: sample i is that of i (1 - drift) - late. resticks move along. Returns
/// what is missing at the ends.
Ends follow_clock(std::vector<double>& velocity, double drift, double late, std::vector<double>& resticks);

}  // namespace tribofit::kinematics
