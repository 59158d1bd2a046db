#pragma once

#include <cstddef>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit::segmentation {

/// Where a break-away is looked for.
struct Onset {
  std::size_t stick_begin = 0;  ///< first sample of the stick before it
  std::size_t slip = 0;         ///< first sample of the slip above the slip threshold
  std::size_t slip_end = 0;     ///< end of the slip
  int direction = 1;
};

/// A break-away between samples.
struct BreakAway {
  double time = 0;        ///< [s]
  double std_error = 0;   ///< [s]
  bool is_sharp = false;  ///< hardly a sample shows the growth
};

/// Times at which the contact breaks away.
///
/// From break-away on, m dv/dt = k (omega r) t + |dmu/dv| N v, so that v = A (exp(x) - 1 - x) with x = lambda (t - t0)
/// (a law that jumps at break-away adds B (exp(x) - 1)). The early growth is the same in every slip of a record but for
/// what is known of each: A goes with the speed of the disc, and lambda = |dmu/dv| N/m with friction at break-away
/// where that scatters (the slope of a law goes with its height), A then with lambda^-2. A, B, lambda and its gain on
/// that friction are fitted to all slips together, t0 to each. The fit ends where v is a few per cent of the peak,
/// before the curvature of the law is felt. Where the contact creeps into the slip over a good part of the slip's own
/// duration, there is no such onset: the time is then where v leaves the level of the stick by a few per cent of the
/// peak. Cost: linear in the samples near break-away.
std::vector<BreakAway> locate_break_aways(const Motion& motion, const std::vector<Onset>& onsets, double peak,
                                          int threads);

/// Time at which the velocity reaches the plateau again: a line through the last samples of the slip.
/// `slip` ends with the first sample below the stick threshold; `next` is where the following slip begins.
double locate_restick(const Motion& motion, SampleRange slip, std::size_t next, int direction, double peak);

/// Friction at break-away by a straight line (a parabola where it is clearly bent) through the later half of the stick.
struct StickFriction {
  Estimate level;
  double slope = 0;  ///< of the straight line [1/s]
};
StickFriction friction_at(const Motion& motion, SampleRange stick, double time, int direction);

}  // namespace tribofit::segmentation
