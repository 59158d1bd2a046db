#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Undoes a first-order low-pass in place: v_b = v_meas + tau dv_meas/dt, the derivative by a line through the fewest
/// samples that leave the noise small (noise, fastest [m/s]: of the reading). Returns the samples to either side that a
/// corner is smeared over.
std::size_t undo_low_pass(std::span<double> velocity, double tau, double step, double noise, double fastest);

/// A first-order low-pass of the friction channel.
struct FrictionLowPass {
  bool is_known = false;  ///< enough re-sticks, and samples after them, show whether there is one
  Estimate tau;           ///< time constant [s]; 0: none, or not seen
  double early = 0;       ///< what decays begins before v_r comes to rest by it [samples]
  double fall = 0;        ///< time over which friction falls at re-stick where it does so otherwise [s]; 0: a sample or
                          ///< so, or not seen
};

/// A first-order low-pass of the friction channel, from re-stick: there friction jumps to what the spring pulls, on
/// which it then rises. The reading goes on from where it was, A exp(-t/tau) above the line. A lag of the contact,
/// which ends at rest, leaves the jump. A filter of higher order draws the jump out: from a tenth of it to nine.
///
/// resticks: where v_r came to rest [samples]. The result does not depend on the threads. Cost: a tenth of a second.
FrictionLowPass find_friction_low_pass(std::span<const double> friction, const std::vector<double>& resticks,
                                       double step, int threads = 1);

}  // namespace tribofit::kinematics
