#pragma once

#include <cstddef>
#include <span>

#include "plateau_search.hpp"
#include "tribofit/ingest/trace.hpp"

namespace tribofit::kinematics {

/// Samples that are missing though the clock does not show it: between two samples the velocity changes by far more
/// than before and after, where no real motion jumps.
struct LostSamples {
  std::size_t jumps = 0;
  double part = 0;  ///< of the intervals in which the velocity changes fast enough to show it
};

/// Too many for blows on the rig. plateaus: of stick.
bool are_lost(const LostSamples& lost, std::size_t plateaus);

/// Noise of a velocity that reads exactly zero at rest, as an encoder does, and thus shows none there: how far samples
/// in motion are off the line between their neighbours, as a standard deviation [m/s]; 0 for other velocities.
double noise_in_motion(std::span<const double> velocity);

/// noise: of the velocity [m/s]; step: sampling interval [s]. Jumps from rest, or to it, are the rig's own where most
/// sticks have one. Cost: one pass.
LostSamples find_lost_samples(const Trace& trace, const PlateauSearch& search, const Disc& disc, double noise,
                              double step, int threads = 1);

}  // namespace tribofit::kinematics
