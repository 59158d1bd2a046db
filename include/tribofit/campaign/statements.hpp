#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// "The errors were each less than 0.08" ([D] 3.3), as found under one condition.
struct ErrorStatement {
  std::size_t group = 0;  ///< index of the conditions
  std::string law, protocol;
  std::size_t runs = 0;
  double below_limit = 0;       ///< share of the slip samples of all runs with e below published_error_limit
  double bins_below_limit = 0;  ///< share of the bins of speed in which e of the mean friction is below it
  double largest_of_bins = 0;   ///< largest e of the mean friction in a bin
  double mean_relative = 0, max_relative = 0;  ///< of all slip samples
};

/// Which of two laws predicts cycles better that it has not seen, by the joint protocol.
struct LawPreference {
  std::string better, other;
  std::size_t runs = 0, better_in = 0;
  double ratio = 1;  ///< held-out error of the other over that of the better one, geometric mean over runs
  /// Two-sided t test of the mean logarithm of these ratios against the scatter of repeats, a run each; the advantage
  /// may differ between the conditions. NaN with one run.
  double p_value = 1;
};

/// What [D] says in words, for a campaign.
struct Statements {
  std::vector<ErrorStatement> errors;     ///< by conditions, law and protocol
  std::vector<LawPreference> preference;  ///< one for each of the conditions, in their order; `runs` 0: nothing to say
  LawPreference overall;                  ///< over all runs
};

/// Takes the statements from the results that `groups` were pooled from. Cost: linear in runs.
Statements statements_of(const ResultReader& results, std::span<const RunResult> runs,
                         std::span<const PooledGroup> groups);

}  // namespace tribofit
