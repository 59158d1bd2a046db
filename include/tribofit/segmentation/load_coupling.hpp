#pragma once

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// How much the tangential force presses the block on (or lifts it off), as the load channel shows it: kappa [1] of
/// N = N0/(1 - kappa mu), which in terms of the recorded m = Ft/N0 is N = N0 (1 + kappa m).
///
/// Slope of the load over friction within each cycle (stick and slip), where a load that changes slowly for another
/// reason stands still; its mean over cycles and the error of that. Where friction is a force the slope is kappa
/// itself. NaN where there is no load channel or fewer than 12 cycles. Cost: one pass over the samples.
Estimate load_coupling(const Motion& motion, const Segmentation& segmentation);

/// Takes a coupling out of the load channel: what is left is N0, the load without friction.
void uncouple_load(double kappa, Motion& motion);

}  // namespace tribofit
