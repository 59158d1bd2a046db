#pragma once

#include <limits>
#include <string>

namespace tribofit {

/// For parameters that are never neutral by themselves.
inline constexpr double kNoNeutralValue = std::numeric_limits<double>::quiet_NaN();

/// What the bounds, the start and the neutral value of a parameter are proportional to. They are stated for the rig of
/// [D] (RecordScales); the same motion on a slower, faster, larger or heavier rig has them in proportion, so that what
/// can be found does not depend on the rig.
enum class BoundScaling {
  never,                ///< a pure number, or a length, temperature or mass that the motion does not set
  with_slip_time,       ///< a time within a slip
  against_slip_time,    ///< a frequency
  with_stick_time,      ///< a time over which contacts age
  with_slip_length,     ///< a distance over which contacts are renewed
  against_slip_length,  ///< a stiffness
  against_top_speed,    ///< friction per speed
  with_duration,        ///< a time within the record
  against_duration,     ///< a rate of change over the record
  with_distance,        ///< a distance within all that was slid
  with_stroke,          ///< a distance after a reversal
  with_mass,            ///< the mass whose inertia is as large as friction
  with_speed,           ///< a speed at which a law falls: from 1/1000 to 100 times the fastest slip
  against_speed         ///< its inverse, the steepness of a law
};

/// To which data one value of a parameter belongs.
enum class ParameterScope {
  all_records,  ///< the contact, the rig or the instruments: the same in every record of them
  record        ///< where the clock or the disc stood when a record began: another value in each
};

/// How a search for a parameter begins.
enum class ParameterSearch {
  grid,                ///< from `start_grid_points` values
  steady_line,         ///< from the strongest spectral line that runs through the whole record
  ringing_line,        ///< from the strongest line that begins anew at each break-away
  moment_of_change,    ///< from the times at which the parameter before it may have begun to act
  distance_of_change,  ///< from the distance since a reversal at which friction changes most
  jump_at_restick      ///< from such values, and by how much later friction jumps than v_r rests or turns round
};

/// One parameter of a law or of an effect as a person sees it.
/// Values inside the library are SI; `lower`, `upper`, `start` and `neutral` are in `unit`.
struct Parameter {
  std::string name = {};
  std::string description = {};  ///< what it is, in one line without a full stop
  std::string unit = "1";        ///< as shown and written, "1" for a pure number
  double si = 1;                 ///< SI value of one `unit`
  double lower = 0, upper = 0;   ///< plausible bounds for dry contacts
  double start = 0;              ///< where a search begins when the data say nothing better
  /// Where the effect says nothing, or as little as its bounds allow; NaN: at `start`.
  double neutral = kNoNeutralValue;
  bool scales_with_friction = false;  ///< it has newtons in its unit where friction is a force
  BoundScaling bound_scaling = BoundScaling::never;
  ParameterScope scope = ParameterScope::all_records;
  ParameterSearch search = ParameterSearch::grid;
  int start_grid_points = 1;  ///< values over its bounds from which a search must begin so that it ends at the best one
  bool periodic = false;      ///< an angle: a full turn more or less is the same value
  /// A time that is only searched for up to twice the length of the record: beyond that all values look alike.
  bool within_record = false;
  /// On one of its bounds it would make another effect of this one, so a fit that puts it there does not count. The
  /// first parameter of an effect is always decisive.
  bool decisive = false;
};

}  // namespace tribofit
