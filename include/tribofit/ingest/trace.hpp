#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tribofit/ingest/conditions.hpp"
#include "tribofit/ingest/record_kind.hpp"

namespace tribofit {

/// What the friction channel holds.
enum class FrictionKind {
  coefficient,  ///< mu [1]
  force,        ///< tangential force [N] where no normal force is known
};

/// What the velocity channel holds.
enum class VelocityKind {
  block,       ///< v_b [m/s], v_r = omega r - v_b
  relative,    ///< v_r [m/s] as measured
  fixed_block  ///< no channel: the block stands still and v_r = omega r
};

/// A stretch of a trace with conditions of its own (a recipe step of a tribometer, a file of a split run).
struct Step {
  std::size_t begin = 0, end = 0;  ///< samples [begin, end)
  std::string label;               ///< as the file names it
  Conditions conditions;
  std::size_t recipe = 0;  ///< which step of the recipe it belongs to: a gap divides one
};

/// One run as recorded, in SI units, with every sample checked to be finite.
///
/// Channels are empty when absent; those present all have the length of `time`.
/// Time is in seconds from the first sample and strictly increasing; where a file restarts its
/// clock at each step the steps follow one another. Points (RecordKind::points) have no time: `time` numbers them, in
/// an order of their values.
struct Trace {
  std::string path;
  std::uint64_t checksum = 0;  ///< of the values of the channels in SI, by XXH64

  std::vector<double> time;      ///< [s]
  std::vector<double> friction;  ///< [1] or [N], see friction_kind
  std::vector<double> velocity;  ///< [m/s], see velocity_kind; empty for a fixed block

  std::vector<double> block_position, drive_position;  ///< [m], from which kinematics/ makes the velocity
  std::vector<double> load_point_speed;                ///< [m/s], of velocity steps and holds
  std::vector<LoadPointPhase> load_point;              ///< the same as the user states it

  /// Of points as stated, of other records as they follow from the channel that they were made of [1] or [N], [m/s];
  /// empty: not known.
  std::vector<double> friction_std_error, velocity_std_error;

  /// Of a spring slider, beside a velocity and friction that are means over the same stretches: the acceleration over
  /// them [m/s^2], and by how much the velocity varies within them [m^2/s^2]. Empty: not known.
  std::vector<double> acceleration, velocity_variance;
  double smoothing = 0;  ///< standard deviation of the weights of those means over time [s]

  std::vector<double> load;         ///< normal force [N]
  std::vector<double> temperature;  ///< [degC]
  std::vector<double> disc_speed;   ///< [rad/s]
  std::vector<double> disc_angle;   ///< [rad], not wrapped

  FrictionKind friction_kind = FrictionKind::coefficient;
  VelocityKind velocity_kind = VelocityKind::block;

  std::optional<RecordKind> kind;  ///< as the user stated it, or as the file shows it; nothing: the motion shows it
  std::string kind_source;         ///< "stated", or what in the file shows it
  SpringDrive spring;              ///< of a spring slider, whose `friction` is the pull, and of a motion alone

  Condition normal_stress;  ///< mean, where friction was given as a stress over it [Pa]
  Conditions conditions;    ///< of the whole trace; radius unknown where the steps differ
  std::vector<Step> steps;  ///< at least one; they cover the trace without gaps
  /// Standard error of the time between friction and velocity, where two instruments recorded them: that of the offset
  /// found between their clocks [s]; NaN where it could not be found; 0 on one clock.
  double clock_offset_std_error = 0;

  std::vector<std::string> notes;     ///< what was assumed or handled while reading, for the report
  std::vector<std::string> warnings;  ///< contradictions and defects that were handled

  std::size_t size() const { return time.size(); }
  double duration() const { return time.empty() ? 0 : time.back() - time.front(); }
  /// Sampling interval [s]: the mean of the intervals that are no gaps (up to 1.5 times the median; the median itself
  /// would take over the rounding of a clock written with few digits). 0 for fewer than two samples. Cost: one pass.
  double interval() const;
  /// Samples per second: 1/interval.
  double rate() const { return time.size() > 1 ? 1 / interval() : 0; }
};

}  // namespace tribofit
