#pragma once

#include <span>
#include <string>

#include "tribofit/campaign/pooled.hpp"

namespace tribofit {

/// Writes into the folder of the results, each file whole or not at all:
/// - pooled.csv: a row for every group of repeats, law, protocol and parameter, and for every measure (law empty)
/// - shared.csv, where parameters are shared: a row for every common value, then one for every run and parameter
/// - trends.csv: a row for every law, parameter and condition
/// - pooled.json: {"tool", "groups", "shared", "trends", "confounded", "warnings"}
/// Units stand in a column "unit", those of conditions in the names of their columns. Throws WriteError.
void write_pooled(const std::string& folder, std::span<const RunResult> runs, const Pooled& pooled);

/// comparison.csv: a row for each pair of an earlier value and one of ours, with their conditions and units.
std::string comparison_csv(const ComparisonReport& report, std::span<const PooledGroup> groups);

/// The same as the JSON object {"path", "values", "unmatched", "relative_error", "law_preference"}, for summary.json.
std::string comparison_json(const ComparisonReport& report, std::span<const PooledGroup> groups);

}  // namespace tribofit
