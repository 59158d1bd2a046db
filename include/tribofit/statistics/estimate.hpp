#pragma once

namespace tribofit {

struct Interval {
  double lower = 0, upper = 0;
};

/// A value with its standard error, as a mean over cycles or a fit has it.
struct Estimate {
  double value = 0, std_error = 0;  ///< NaN where they are not known
  double degrees_of_freedom = 1;    ///< of the t distribution of its error

  /// 95 % interval by that distribution.
  Interval interval95() const;
  /// Of what is 0 where it was not found.
  bool any() const { return value != 0; }
};

}  // namespace tribofit
