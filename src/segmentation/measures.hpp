#pragma once

#include <vector>

#include "tribofit/segmentation/cycles.hpp"

namespace tribofit::segmentation {

/// Mean of the values that are not NaN, with a standard error that stands correlated cycles: the larger of the one for
/// independent values and that of Newey and West (1987) with n^(1/3) lags. NaN where there are fewer than two values.
Measure mean_over_cycles(std::vector<double> values);

/// Frequency from the periods: one over their mean without those further than three robust standard deviations from the
/// median (a long stick, a missed slip), which belong to another motion.
Measure frequency_of(const std::vector<double>& periods);

}  // namespace tribofit::segmentation
