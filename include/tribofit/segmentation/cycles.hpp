#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

/// A stretch of samples [begin, end).
struct SampleRange {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
};

/// One slip with the stick before it. Quantities that the record does not show are NaN.
struct Cycle {
  SampleRange stick;  ///< samples of the stick; empty where the record begins in slip or the motion only reverses
  SampleRange
      slip;  ///< samples of the slip: first sample after break_away_time to the last before restick_time. A sample
             ///< within half an interval of restick_time, where friction jumps, belongs to neither phase, nor one that
             ///< may be before break-away or after where the slip begins between two samples.
  bool stick_complete = false;  ///< the stick's beginning (a re-stick) is in the record
  bool slip_complete = false;   ///< the slip ends in stick within the record
  int direction = 1;            ///< sign of v_r in the slip

  double break_away_time = 0;            ///< sub-sample [s]
  double break_away_time_std_error = 0;  ///< [s]
  bool is_sharp = false;                 ///< hardly a sample shows how v_r leaves the stick
  double restick_time = 0;               ///< sub-sample [s]
  double stick_time = 0;                 ///< [s]
  double slip_time = 0;                  ///< [s]
  double period = 0;                     ///< from this break-away to the next of the same direction [s]

  double break_away_friction =
      0;  ///< friction at break_away_time, from a line through the stick before it (times direction) [1 or N]
  double break_away_friction_std_error = 0;
  double stick_slope = 0;        ///< d friction/dt of that line [1/s or N/s]
  double stick_maximum = 0;      ///< largest sample in stick: static friction of [D] 3.2
  double slip_minimum = 0;       ///< smallest sample in slip: kinetic friction of [D] 3.2
  double peak_velocity = 0;      ///< largest |v_r| in the slip [m/s]
  double plateau_velocity = 0;   ///< mean of v_r in the stick [m/s]
  double branch_difference = 0;  ///< see Segmentation::branch_difference [1 or N]
};

/// What kind of motion the record holds.
enum class MotionKind {
  stick_slip,       ///< sticks and slips
  always_slipping,  ///< never sticks
  always_sticking,  ///< never slips
};
/// "stick-slip", "always-slipping" or "always-sticking".
std::string_view to_string(MotionKind kind);

/// Stick and slip of a whole record.
struct Segmentation {
  MotionKind kind = MotionKind::stick_slip;
  std::vector<Cycle> cycles;   ///< in order of time; a record that never sticks is one slip per direction and step
  double slip_threshold = 0;   ///< |v_r| above which slip begins [m/s]
  double stick_threshold = 0;  ///< |v_r| below which stick begins [m/s]

  Estimate frequency;              ///< stick-slip frequency from the periods [Hz]; NaN where there are fewer than two
  Estimate amplitude;              ///< of v_r: peak |v_r| over cycles [m/s]
  Estimate stick_time, slip_time;  ///< [s]
  /// Friction while speeding up less friction while slowing down, at the same speeds between a quarter and three
  /// quarters of the peak [1 or N]: zero for a law of speed alone.
  Estimate branch_difference;
  double rms_velocity = 0;            ///< of the block velocity [m/s]
  std::vector<std::string> notes;     ///< what a person should know ("never sticks", "the first slip is cut off")
  std::vector<SampleRange> left_out;  ///< samples that are not used in fits, see exclude()

  /// Whether none of these samples is left out.
  bool is_selected(const SampleRange& samples) const;
  /// The same for stick and slip of a cycle: it is used as a whole or not at all.
  bool is_selected(const Cycle& cycle) const;
};

/// What kind of record this is: as stated or as the file shows it, else as the motion shows it. A record that never
/// slips counts as stick-slip.
RecordKind kind_of_record(const Motion& motion, const Segmentation& segmentation);

/// What part of a record is fitted.
struct Selection {
  /// Numbers of cycles as in cycles.csv, the first is 0; both ends are used.
  struct Cycles {
    std::size_t first = 0, last = 0;
  };
  /// A stretch of time [s].
  struct Stretch {
    double from = 0, to = 0;
  };
  std::optional<Cycles> cycles;   ///< only these; none: all
  std::vector<Stretch> excluded;  ///< cycles that reach into one of them are not used

  bool empty() const { return !cycles && excluded.empty(); }
};

/// Leaves out what `selection` does not take: cycles keep their numbers, and measures of the motion are those of the
/// whole record; fits, diagnoses and the noise floor do not see what is left out. A note says how much is left. Where
/// nothing sticks there are no cycles to be selected, which a note says, too.
void exclude(const Selection& selection, const Motion& motion, Segmentation& segmentation);

/// Samples of the slips that are selected: those to which a law of sliding is fitted.
std::size_t samples_in_slip(const Segmentation& segmentation);

/// Finds stick and slip by hysteresis on |v_r| with thresholds from the trace's own noise, or as Motion::stick says.
///
/// The block sticks where v_r is within the noise of zero, not where it is slow beside the fastest slip: a record in
/// which it never rests is sliding throughout, whatever its range of speeds.
///
/// Points have neither stick nor cycles: they are one slip for each direction.
///
/// Break-away is placed between samples by fitting the growth of v_r after it (v_r ~ exp(lambda t) - 1 - lambda t, the
/// solution of m v_r' = k (omega r) t + |dmu/dv| N v_r near v_r = 0); re-stick by a line through v_r before it.
/// Friction effects with creep before break-away (v_r small but not zero) stay in the stick.
Segmentation find_cycles(const Motion& motion, int threads = 1);

}  // namespace tribofit
