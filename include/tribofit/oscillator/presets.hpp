#pragma once

#include <vector>

#include "tribofit/friction/laws/all.hpp"
#include "tribofit/oscillator/rig.hpp"

namespace tribofit {

/// A disc-block test of [D] (4 rpm, 50 N): its published friction, and a rig of ours that reproduces its motion.
struct PublishedTest {
  double radius = 0;             ///< [m]
  double speed = 0;              ///< [rad/s]
  double load = 0;               ///< [N]
  Rig rig;                       ///< ours, see published_test()
  std::vector<double> friction;  ///< parameters of the law in SI: those of Table 4
};

/// The test of [D] whose radius is nearest to `radius` [m] (9, 12, 15 or 18 mm), with the friction of its Table 4.
///
/// The rigs (k = 11.0, 11.7, 16.2, 12.3 N/mm, m = 0.77, 0.80, 0.85, 0.93 kg, damping ratio 0.02) are not published:
/// they are calibrated so that the exponential law gives the published frequency and velocity amplitude, and prove
/// nothing by returning those two. Parameters of laws that Table 4 does not have are such that the law starts (as a fit
/// does) from the exponential law of the table over the speeds of that test.
PublishedTest published_test(double radius, const Law& law);

}  // namespace tribofit
