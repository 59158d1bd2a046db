#pragma once

#include <span>
#include <string>

#include "tribofit/campaign/compare.hpp"
#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/statements.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// A campaign beside published or earlier values.
struct ComparisonReport {
  EarlierComparison values;
  Statements statements;
};

/// comparison.csv: a row for each pair of an earlier value and one of ours, with their conditions and units.
std::string comparison_csv(const ComparisonReport& report, std::span<const PooledGroup> groups);

/// The same as the JSON object {"path", "values", "unmatched", "relative_error", "law_preference"}, for summary.json.
std::string comparison_json(const ComparisonReport& report, std::span<const PooledGroup> groups);

/// The same for people: a line for each value with both protocols, then which law is better and the relative errors.
std::string render_comparison(const ComparisonReport& report, std::span<const PooledGroup> groups,
                              const TerminalOptions& options = {});

}  // namespace tribofit
