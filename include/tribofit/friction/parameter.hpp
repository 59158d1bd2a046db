#pragma once

#include <limits>
#include <string>

namespace tribofit {

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
  bool of_friction = false;  ///< scales with friction, so it has newtons in its unit where friction is a force
};

}  // namespace tribofit
