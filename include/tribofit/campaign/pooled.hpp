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

/// Pools the runs. Throws InputError for a sharing that the runs do not allow.
Pooled pool_campaign(std::span<const RunResult> runs, const Sharing& sharing = {});

/// A campaign beside published or earlier values.
struct ComparisonReport {
  EarlierComparison values;
  Statements statements;
};

}  // namespace tribofit
