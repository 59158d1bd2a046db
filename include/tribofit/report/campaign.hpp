#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/batch.hpp"
#include "tribofit/campaign/pooled.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {

/// Writes the file of one run, NAME.json: the object of to_json(), with "run": what the campaign says of it
/// {"name", "file", "key", "settings", "status", "message", "stated", "repeat", "others"}, sealed (see sealed()).
/// Before it the folder "kept" gets NAME.figures.json, what figures_of() takes from the run, and NAME.condensed.json.
/// `result` is null where the run could not be read; its "fits" are empty then. Throws WriteError.
void write_run(const std::string& results, const RunRecord& run, const Identification* result,
               const JsonOptions& options = {});

/// What became of the runs of a campaign.
struct CampaignSummary {
  std::size_t fitted = 0, failed = 0, missing = 0;  ///< runs
  std::vector<std::string> errors;                  ///< a line for each run that is failed or missing
};

/// Writes summary.csv and summary.json into the folder of the results, each whole or not at all: a row and an object a
/// run in the order of the campaign. Units stand in the names of the columns and keys. Runs without a result have the
/// status "missing". Nothing in them depends on when, where or how fast the runs were fitted.
/// summary.json is {"tool", "runs": [...], "problems": [...]}, a line a run.
/// `comparison`, the object of comparison_json(), is added under that key where it is given.
/// Throws WriteError. Cost: linear in runs; memory hardly grows with them.
CampaignSummary write_summary(const ResultReader& results, const std::string& comparison = {});

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

/// Writes what Fig 5 to 12 of [D] show, from the runs of a campaign, into figures/ in the folder of its results: the
/// tables that tools/help/campaign.txt lists.
/// A row begins with the run (or the number of runs) and its conditions; units stand in the names of the columns.
/// Each file appears whole or not at all. `runs` are those of `results`, `groups` their repeats. Throws WriteError.
/// Cost: linear in runs; memory does not grow with them.
void write_figures(const ResultReader& results, std::span<const RunResult> runs, std::span<const PooledGroup> groups);

/// A campaign: what Fig 5 to 12 of [D] show, earlier values beside ours (`comparison`), which law predicts better, all
/// pooled values with what differs from run to run, trends, the runs with their status and warnings. Of many conditions
/// runs of six are drawn, all are listed up to a thousand rows; a terminal shows the first forty rows, and repeats as
/// mean and interval. runs: those of `results`, in their order.
Report report_of(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                 const std::optional<ComparisonReport>& comparison, const ReportOptions& options = {});

}  // namespace tribofit
