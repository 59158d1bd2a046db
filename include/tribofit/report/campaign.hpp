#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/batch.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/pooled.hpp"
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

/// A campaign: what Fig 5 to 12 of [D] show, earlier values beside ours (`comparison`), which law predicts better, all
/// pooled values with what differs from run to run, trends, the runs with their status and warnings. Of many conditions
/// runs of six are drawn, all are listed up to a thousand rows; a terminal shows the first forty rows, and repeats as
/// mean and interval. runs: those of `results`, in their order.
Report report_of(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                 const std::optional<ComparisonReport>& comparison, const ReportOptions& options = {});

}  // namespace tribofit
