#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/campaign/group_values.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/comparison.hpp"
#include "tribofit/report/pooled.hpp"

namespace tribofit {

/// What is said of a campaign on a terminal and on a page alike.

struct CellRows {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// Earlier values beside ours, a row a value with both protocols; conditions stand in the first row of each.
CellRows comparison_cells(const ComparisonReport& report, std::span<const PooledGroup> groups);
/// Relative errors (Eq 5) by conditions, law and protocol.
CellRows error_cells(const Statements& statements, std::span<const PooledGroup> groups);
/// Which law predicts better, over all runs and under each of the conditions.
std::vector<std::string> preference_sentences(const Statements& statements, std::span<const PooledGroup> groups);
/// Trends that are no chance, and what is not said in the warnings.
std::vector<std::string> trend_sentences(const Trends& trends);

}  // namespace tribofit
