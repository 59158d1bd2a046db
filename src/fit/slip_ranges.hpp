#pragma once

#include <vector>

#include "tribofit/fit/observations.hpp"

namespace tribofit {

/// One range per slip of the segmentation that is selected; slips without stick are cut into pieces of about equal
/// length. Values are not assigned yet. noise: of friction, beside which a break-away is weighed; not needed where that
/// weight is not asked for.
std::vector<Observations::SlipObservation> slip_ranges(const Motion& motion, const Segmentation& segmentation,
                                                       const SensorNoise& noise = {});

}  // namespace tribofit
