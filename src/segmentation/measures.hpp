#pragma once

#include <span>
#include <vector>

#include "tribofit/segmentation/cycles.hpp"

namespace tribofit::segmentation {

/// Friction [1 or N] of a slip while speeding up less that while slowing down: mean difference over ten bins of speed
/// between a quarter and three quarters of the peak. NaN where the slip does not show both branches.
double branch_difference(std::span<const double> velocity, std::span<const double> friction, int direction);

/// Frequency from the periods: one over their mean without those further than three robust standard deviations from the
/// median (a long stick, a missed slip), which belong to another motion.
Estimate frequency_of(const std::vector<double>& periods);

/// Mean over slips with its standard error: where there are fewer than thirty, too few to show how neighbours are
/// correlated, as if they were not.
Estimate mean_over_slips(std::vector<double> values);

}  // namespace tribofit::segmentation
