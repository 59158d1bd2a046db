#pragma once

#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// compute_motion() on up to so many threads (0: as many as there are), which look at friction and velocity side by
/// side. The result does not depend on them.
Motion compute_motion(Trace trace, const Instruments& instruments, const MotionOptions& options, int threads);

}  // namespace tribofit
