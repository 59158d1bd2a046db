#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/pooled.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// What is said of a campaign on a terminal and on a page alike.

/// Earlier values beside ours, a row a value with both protocols; conditions stand in the first row of each.
ReportTable comparison_table(const ComparisonReport& report, std::span<const PooledGroup> groups);
/// Relative errors (Eq 5) by conditions, law and protocol.
ReportTable error_table(const Statements& statements, std::span<const PooledGroup> groups);
/// Repeats of the joint fit, a row a law.
ReportTable repeats_table(std::span<const PooledGroup> groups);
/// Every pooled value with the parts of its error.
ReportTable groups_table(std::span<const PooledGroup> groups);
/// Parameters that runs share, the same way.
ReportTable shared_table(const SharedFit& fit);
ReportTable trends_table(const Trends& trends);

/// The runs with their status and best fit: a table without rows, and the row of a run with or without a result.
ReportTable runs_table(const std::string& friction_unit);
std::vector<std::string> run_row(const RunResult& run);
std::vector<std::string> run_row(const MissingRun& run);
/// What the numbers of the table are.
std::string runs_note();

/// Which law predicts better, over all runs and under each of the conditions.
std::vector<std::string> preference_sentences(const Statements& statements, std::span<const PooledGroup> groups);
/// Significant trends, and what is not said in the warnings.
std::vector<std::string> trend_sentences(const Trends& trends);

}  // namespace tribofit
