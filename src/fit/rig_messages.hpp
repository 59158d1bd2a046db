#pragma once

#include <string>

#include "tribofit/fit/rig.hpp"

namespace tribofit::rig {

/// Why these values cannot be those of a rig; empty where they can.
std::string why_impossible(const RigFit& fit);

/// What a person should know of the values.
void add_messages(const Motion& motion, const Segmentation& segmentation, const Instruments& instruments, RigFit& fit);

}  // namespace tribofit::rig
