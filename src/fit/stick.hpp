#pragma once

#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit {

/// Root mean square of measured minus predicted creep velocity in stick [m/s], for models that act in stick.
/// Compared over tenths of each stick, where sensor noise has averaged out. NaN where no stick is long enough.
double stick_creep_rmse(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                        const Segmentation& segmentation);

/// What the creep of a model does not explain of the gap between v_b in stick and omega r, as a part of omega r, beyond
/// what its law of creep may be wrong by; with its standard error over sticks. NaN where no stick is long enough.
Estimate gap_beside_creep(const FrictionModel& model, const std::vector<double>& p, const Motion& motion,
                          const Segmentation& segmentation);

}  // namespace tribofit
