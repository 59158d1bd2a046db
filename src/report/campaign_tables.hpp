#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/pooled.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// What is said of a campaign on a terminal and on a page alike.

/// Earlier values beside ours, and what has no partner.
ReportSection comparison_section(const EarlierComparison& comparison, std::span<const PooledGroup> groups);
/// Which law predicts better, over all runs and under each of the conditions; relative errors (Eq 5).
ReportSection statements_section(const Statements& statements, std::span<const PooledGroup> groups);
/// Every pooled value with the parts of its error, and the parameters that runs share.
ReportSection pooled_section(const Pooled& pooled);
/// Significant trends, and all that were looked at.
ReportSection trends_section(const Trends& trends);
/// Repeats of the joint fit, a row a law.
ReportTable repeats_table(std::span<const PooledGroup> groups);

/// The runs with their status and best fit: a table without rows, and the row of a run with or without a result.
ReportTable runs_table(const std::string& friction_unit);
std::vector<std::string> run_row(const RunResult& run);
std::vector<std::string> run_row(const PlannedRun& missing);

/// Significant trends, and what is not said in the warnings.
std::vector<std::string> trend_sentences(const Trends& trends);

}  // namespace tribofit
