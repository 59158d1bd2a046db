#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// Radius, disc speed and load of a motion as people read them, with where each comes from: {"radius", "15 mm (command
/// line)"}.
std::vector<std::pair<std::string, std::string>> condition_texts(const Motion& motion);

}  // namespace tribofit
