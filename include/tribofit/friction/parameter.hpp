#pragma once

#include <limits>
#include <string>

namespace tribofit {

/// For parameters that are never neutral by themselves.
inline constexpr double kNoNeutralValue = std::numeric_limits<double>::quiet_NaN();

/// What the bounds of a parameter grow with, on machines larger and slower than the tribometers they are stated for.
enum class BoundScaling {
  never,
  with_slip_time,   ///< beyond slips of 0.1 s
  with_slip_length  ///< beyond slips of 5 mm
};

/// One parameter of a law or of an effect as a person sees it.
/// Values inside the library are SI; `lower`, `upper` and `start` are in `unit`.
struct Parameter {
  std::string name;
  std::string unit;             ///< as shown and written, "1" for a pure number
  double si = 1;                ///< SI value of one `unit`
  double lower = 0, upper = 0;  ///< plausible bounds for dry contacts [unit]
  double start = 0;             ///< where a search begins when the data say nothing better [unit]
  /// Where the effect says nothing, or as little as its bounds allow [unit]; NaN: at `start`.
  double neutral = std::numeric_limits<double>::quiet_NaN();
  bool friction_effects = false;  ///< scales with friction, so it has newtons in its unit where friction is a force
  bool of_force = false;          ///< its bounds grow with the force where friction is one, its unit does not
  int grid = 1;  ///< values over its bounds from which a search must begin so that it ends at the best one
  BoundScaling grows = BoundScaling::never;
};

}  // namespace tribofit
