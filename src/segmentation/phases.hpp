#pragma once

#include <span>
#include <vector>

#include "ingest/limits.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit::segmentation {

/// Levels of |v_r - plateau| that part stick from slip [m/s].
struct Thresholds {
  double slip = 0;   ///< above: slip begins
  double stick = 0;  ///< below: stick begins
  double peak = 0;   ///< typical peak of a slip; 0 where nothing rises above the noise
};

/// Thresholds from the noise (8 and 5 standard deviations) and the typical peak (6 and 3 %), whichever is larger.
/// Noise that is really ringing of the contact cannot push them beyond 15 and 7.5 % of the peak.
Thresholds thresholds_of(const Motion& motion, int threads = 1);

/// A slip as the thresholds see it.
struct RawSlip {
  SampleRange samples;  ///< from the sample that rises above the slip threshold to the last above the stick threshold
  int direction = 1;    ///< sign of v_r
  double peak = 0;      ///< largest |v_r - plateau| [m/s]
  bool begins_within = false, ends_within = false;  ///< neither end is cut off by the record
  bool may_be_ringing = false;  ///< it begins the record, and is as low and short as ringing after a re-stick
};

/// Slips by hysteresis, without the chatter that follows a re-stick (much lower and shorter than the slips). Where the
/// record begins with such a piece it may be the end of a slip too: may_be_ringing.
std::vector<RawSlip> find_slips(const Motion& motion, const Thresholds& thresholds);

/// Of a record that never sticks: below them the direction of sliding is not known.
Thresholds thresholds_without_stick(const Motion& motion);

/// Sliding of a record that never sticks, in pieces of one direction, however slow: all samples but those within the
/// noise of zero before, after and between them; where it is said that nothing sticks, all of them.
std::vector<RawSlip> find_slides(const Motion& motion);

/// The same without the stretches in which v_r is zero within its noise: before, between and after.
std::vector<RawSlip> without_rests(const Motion& motion, const std::vector<RawSlip>& slides, double peak);

/// Whether a drive kept the speed of a slide, as no block on a spring does: a slip is half a sine, whose quartiles are
/// three quarters of its median apart.
bool keeps_speed(const Motion& motion, const SampleRange& slide);

/// Whether the block rests in what the thresholds take for stick, as v_r shows it: its middle is at zero within the
/// noise (or the block moves along with a disc of varying speed), and it is no turning point of a smooth motion.
bool rests(const Motion& motion, const SampleRange& stick, const Thresholds& thresholds);

/// v_r above the plateau of stick.
inline double above_plateau(const Motion& motion, std::size_t i) {
  return motion.relative_velocity[i] - motion.plateau_velocity;
}

/// Stretches of samples in which a fault of the recording leaves the motion unknown (SampleFault::stretch).
inline std::vector<SampleRange> spoilt_stretches(const Motion& motion) {
  std::vector<SampleRange> stretches;
  for (std::size_t i = 0; i < motion.faults.size(); ++i) {
    if (!motion.has_fault(i, SampleFault::stretch)) continue;
    if (stretches.empty() || stretches.back().end < i) stretches.push_back({i, i});
    stretches.back().end = i + 1;
  }
  return stretches;
}

/// First samples after a gap in the clock, and both ends of what a fault of the recording spoilt.
inline std::vector<std::size_t> gaps_of(const Motion& motion) {
  std::vector<std::size_t> gaps;
  for (const Step& step : motion.steps) {
    const std::size_t b = step.begin;
    if (b > 0 && b < motion.size() && motion.time[b] - motion.time[b - 1] > kGapInterval * motion.step)
      gaps.push_back(b);
  }
  for (const SampleRange& stretch : spoilt_stretches(motion)) {
    gaps.push_back(stretch.begin);
    gaps.push_back(stretch.end);
  }
  return gaps;
}

/// True where the velocity between two slips of opposite direction merely passes through zero.
bool only_reverses(const Motion& motion, const RawSlip& before, const RawSlip& after, const Thresholds& thresholds);

}  // namespace tribofit::segmentation
