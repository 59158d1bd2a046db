#pragma once

#include <span>
#include <vector>

#include "tribofit/campaign/compare.hpp"
#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/sharing.hpp"
#include "tribofit/campaign/trends.hpp"

namespace tribofit {

/// What the runs of a campaign say together.
struct Pooled {
  std::vector<PooledGroup> groups;
  std::vector<SharedFit> shared;
  Trends trends;
};

inline Pooled pool_campaign(std::span<const RunResult> runs) {
  return {pool_repeats(runs), {}, find_trends(runs)};
}

/// "The errors were each less than 0.08" ([D] 3.3), as found in all runs under one condition.
struct ErrorStatement : RelativeErrors {
  std::size_t group = 0;  ///< index of the conditions
  std::size_t runs = 0;
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

/// A campaign beside published or earlier values.
struct ComparisonReport {
  EarlierComparison values;
  Statements statements;
};

}  // namespace tribofit
