#include "tribofit/campaign/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "tribofit/campaign/run_result.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

bool is_done(const std::string& results, const std::vector<PlannedRun>& plan) {
  std::error_code ignored;
  return std::ranges::all_of(
      plan, [&](const PlannedRun& run) { return std::filesystem::exists(result_path(results, run.name), ignored); });
}

}  // namespace

bool follow_plan(const BatchOptions& options, Campaign& campaign) {
  const std::string path = (std::filesystem::path(options.results) / campaign_name).string();
  if (!folder_of_campaign(options.results)) return false;  // none, or a damaged one
  const std::vector<PlannedRun> plan = ResultReader(options.results).plan();
  if (is_done(options.results, plan)) return false;

  std::map<std::string, Run> found;
  for (Run& run : campaign.runs) found.emplace(run.name, std::move(run));
  const std::string hash = options_hash(options);
  std::vector<Run> runs;
  for (const PlannedRun& planned : plan) {
    const auto at = found.find(planned.name);
    if (at == found.end()) {
      runs.emplace_back();
      runs.back().name = planned.name, runs.back().file = planned.file;
      runs.back().problem = planned.file + ": was there when the campaign was planned and is gone";
      continue;
    }
    if (settings_hash(at->second, hash) != planned.settings) {
      throw InputError(fmt::format("another shard planned {} with other options or conditions", planned.file),
                       "give every shard the same ones, or plan anew with --again", {path, 0, ""});
    }
    runs.push_back(std::move(at->second));
    found.erase(at);
  }
  if (!found.empty()) {
    campaign.notes.push_back(fmt::format(
        "{} left out, {} the first: not there when the first shard planned the campaign; a shard that starts when all "
        "that was planned is done takes {} in",
        found.size() == 1 ? "1 run is" : fmt::format("{} runs are", found.size()), found.begin()->second.file,
        found.size() == 1 ? "it" : "them"));
  }
  campaign.runs = std::move(runs);
  return true;
}

}  // namespace tribofit
