#pragma once

#include <string>
#include <vector>

#include "tribofit/campaign/batch.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// The file of one run: the object of to_json(), with "run": what the campaign says of it
/// {"name", "file", "key", "settings", "status", "message", "stated", "repeat", "others"}, sealed (see sealed()).
/// `result` is null where the run could not be read; its "fits" are empty then.
std::string run_json(const RunRecord& run, const Identification* result, const JsonOptions& options = {});

/// campaign.json: the runs in order, each with the hash of its settings, the folder they lie in, and the rows of the
/// manifest that are no runs. Every shard of a campaign writes the same.
std::string campaign_json(const Campaign& campaign, const BatchOptions& options);

/// summary.csv: a row a run in the order of the campaign; units stand in the names of the columns. Runs without a
/// result have the status "missing". Nothing in it depends on when, where or how fast the runs were fitted.
std::string summary_csv(const CampaignResults& results);

/// summary.json: the same as objects, {"tool", "runs": [...], "problems": [...]}, a line a run.
std::string summary_json(const CampaignResults& results);

/// Writes both into the folder of the results, each whole or not at all. Throws InputError.
void write_summary(const std::string& folder, const CampaignResults& results);

/// A row a run for people, the first ones where there are very many.
std::string render_results(const CampaignResults& results, const TerminalOptions& options = {});

}  // namespace tribofit
