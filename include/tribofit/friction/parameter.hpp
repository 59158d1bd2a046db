#pragma once

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
};

}  // namespace tribofit
