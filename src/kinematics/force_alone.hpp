#pragma once

#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// A record of friction alone (RecordKind::force_only): its time and friction, with v_r = 0 throughout for not known.
/// Lone samples are replaced. Throws InputError for a trace without friction.
Motion motion_of_force(Trace trace);

}  // namespace tribofit::kinematics
