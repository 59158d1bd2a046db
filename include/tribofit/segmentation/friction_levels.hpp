#pragma once

#include <cstddef>
#include <vector>

#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// Friction over the sliding velocity as it is, without a law; errors from the scatter from slip to slip.
struct FrictionLevels {
  struct Bin {
    double velocity = 0;    ///< mean of v_r [m/s]
    Estimate friction;      ///< [1 or N]
    std::size_t slips = 0;  ///< that reach it
  };
  std::vector<Bin> bins;  ///< by v_r; bins that three slips reach

  /// Size of friction over the faster part of slips (above 0.3 of their peak), of slips with small and with large
  /// peaks.
  struct Level {
    double slowest_peak = 0, fastest_peak = 0;  ///< of |v_r| among them [m/s]
    Estimate friction;                          ///< [1 or N]
    std::size_t slips = 0;
  };
  std::vector<Level> levels;  ///< two halves of the slips by their peaks; empty where there are fewer than eight slips
};

/// Six bins of equal width in each direction. Samples that a fault spoilt are not used.
FrictionLevels friction_levels(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
