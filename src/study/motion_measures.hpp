#pragma once

#include <string>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// What a measure of a record of stick-slip is called and in which unit it is shown.
struct MotionMeasureInfo {
  std::string name, unit;
  double si = 1;
};

/// Measures of a record of stick-slip, each a mean over its cycles, by the same rules for a measured and a simulated
/// one.
struct MotionMeasures {
  /// As motion_measures() lists them; then the mean slip in the plane of displacement since break-away and v_b, at
  /// equal parts of the slip: x [m], then v_b [m/s].
  std::vector<Estimate> values;

  const Estimate& break_away() const { return values[3]; }
};

/// Period, stick time, peak v_r, break-away friction, least friction in slip (of means over a twentieth of it), RMS of
/// v_b, fundamental frequency of the spectrum of v_r, and the amplitudes of its harmonics 1 to 5 over the cycle, from
/// break-away to break-away.
const std::vector<MotionMeasureInfo>& motion_measures();
MotionMeasures measure_motion(const Motion& motion, const Segmentation& segmentation);

}  // namespace tribofit
