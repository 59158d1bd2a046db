#pragma once

#include <string>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// What keeps the data from carrying an analysis, as sentences; none when nothing does.
/// must_slip: the analysis needs slip, as a fit of a friction law does.
std::vector<std::string> obstacles(const Motion& motion, const Segmentation& segmentation, bool must_slip);

}  // namespace tribofit
