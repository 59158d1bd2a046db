#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// How a parameter changes with a condition over the runs of a campaign, as a straight line.
struct Trend {
  std::string law, parameter, unit;       ///< of the joint fit
  std::string condition, condition_unit;  ///< "radius", "mm"; "sliding speed" is omega r, "order" the order in time
  std::size_t runs = 0;
  double slope = 0, std_error = 0;  ///< unit of the parameter per unit of the condition
  double lower95 = 0, upper95 = 0;
  double p_value = 1;      ///< of no slope (t test)
  double p_corrected = 1;  ///< for all trends looked at (Holm)
  bool rises() const { return slope > 0; }
  /// "s/mm per rpm", "per run".
  std::string slope_unit() const;
};

/// Two conditions that change together, so that a trend over one may be one over the other.
struct Confounded {
  std::string a, b;
  double correlation = 0;  ///< over the runs
};

struct Trends {
  std::vector<Trend> trends;           ///< by law, parameter, condition
  std::vector<Confounded> confounded;  ///< pairs with a correlation of at least 0.9
  std::vector<std::string> warnings;   ///< sentences on them, on the order of the runs, on conditions that never change
};

/// Straight lines of every parameter over every condition that is a number and takes at least three values (radius,
/// speed, load, sliding speed, further columns, the order of the runs), with what differs between runs beyond their own
/// errors counted: see meta_regression(). Holm's correction: S. Holm, Scand. J. Stat. 6 (1979) 65. Cost: linear in
/// runs.
Trends find_trends(std::span<const RunResult> runs);

/// Trends that are significant at the 5 % level (corrected), without those over a condition that goes exactly with one
/// before it, as a warning says.
std::vector<Trend> significant_trends(const Trends& trends);

}  // namespace tribofit
