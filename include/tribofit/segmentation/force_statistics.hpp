#pragma once

#include <cstddef>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

/// A quantity over the slips of a record: its mean with standard error, and its scatter from slip to slip (standard
/// deviation). NaN where there are too few.
struct SlipSpread {
  Estimate mean;
  double scatter = 0;
};

/// What friction alone shows, friction in its own unit [1 or N].
struct ForceStatistics {
  SlipSpread whole;              ///< of all samples, taken positive
  std::size_t slips = 0;         ///< sudden falls; 0: none
  SlipSpread peak, drop;         ///< level at break-away, and by how much a slip lets it fall
  SlipSpread period, slip_time;  ///< from peak to peak, and from a peak to the end of its fall [s]
  bool both_directions = false;
};

/// Slips of a record of friction without motion: falls of ten standard deviations of the noise and a tenth of the range
/// at least, which are over in half of the time that friction takes to rise. Levels at both ends of a fall are those of
/// lines through the last and the first quarter of the rises beside it, so that noise does not raise them. Friction
/// that changes its sign is taken by its size, and no fall reaches over a reversal. Cost: linear.
ForceStatistics force_statistics(const Motion& motion);

}  // namespace tribofit
