#pragma once

#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// A record of velocity steps or holds: its time and friction as they are, whatever the sampling, and how the load
/// point moved: as stated, as its speed was recorded, or as its displacement was. Throws InputError where it turns
/// round.
Motion motion_of_load_point(Trace trace);

}  // namespace tribofit::kinematics
