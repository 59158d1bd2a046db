#pragma once

#include <span>
#include <vector>

#include "tribofit/campaign/compare.hpp"
#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/sharing.hpp"
#include "tribofit/campaign/statements.hpp"
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

/// A campaign beside published or earlier values.
struct ComparisonReport {
  EarlierComparison values;
  Statements statements;
};

}  // namespace tribofit
