#pragma once

#include "tribofit/ingest/instruments.hpp"
#include "tribofit/ingest/trace.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Points as a motion: friction corrected for what is declared of its sensor and positive where v_r is, samples sorted
/// by v_r. Friction without a sign, in both directions, is taken as its size. Throws InputError as compute_motion does.
Motion motion_of_points(Trace trace, const Instruments& instruments, const MotionOptions& options);

/// A record of friction alone (RecordKind::force_only): its time and friction, with v_r = 0 throughout for not known.
/// Lone samples are replaced. Throws InputError for a trace without friction.
Motion motion_of_force(Trace trace);

}  // namespace tribofit::kinematics
