#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "described_results.hpp"
#include "ingest/content_hash.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

namespace fs = std::filesystem;

/// Form of the result files; a new one makes old results be done again.
constexpr int kForm = 4;  // 1, 2: the checksum of a trace was another one; 3: samples were kept in the result

/// Texts with their lengths, so that no two lists of texts become the same one.
class Text {
 public:
  void add(std::string_view text) { text_ += fmt::format("{}:{}\n", text.size(), text); }
  void add_all(const std::vector<std::string>& texts) {
    add(std::to_string(texts.size()));
    for (const std::string& text : texts) add(text);
  }
  std::string hash() const { return hexadecimal(xxh64(text_)); }

 private:
  std::string text_;
};

bool is_done(const std::string& results, const std::vector<PlannedRun>& plan) {
  std::error_code ignored;
  return std::ranges::all_of(
      plan, [&](const PlannedRun& run) { return fs::exists(result_path(results, run.name), ignored); });
}

}  // namespace

std::string options_hash(const BatchOptions& options) {
  Text text;
  text.add(fmt::format("tribofit {} {}", version, kForm));
  text.add_all(options.arguments);
  text.add(hexadecimal(content_hash(options.companions)));
  return text.hash();
}

std::string settings_hash(const Run& run, const std::string& hash_of_options) {
  Text text;
  for (const std::string& part : {hash_of_options, run.name, run.file, run.problem}) text.add(part);
  for (const ConditionInfo& info : condition_infos) {
    const Condition& condition = run.trace.read.conditions.*info.member;
    text.add(condition.known() ? fmt::format("{}", condition.value) : "");
    text.add(condition.source);
  }
  text.add(run.known.repeat ? std::to_string(*run.known.repeat) : "");
  for (const OtherCondition& other : run.known.others) {
    text.add(other.name);
    text.add(other.value);
  }
  text.add_all(run.warnings);
  return text.hash();
}

std::string folder_beside_results(const std::string& folder, const std::string& results) {
  std::error_code ignored;
  if (folder.empty()) return "";
  return fs::proximate(fs::weakly_canonical(folder, ignored), fs::weakly_canonical(results, ignored), ignored).string();
}

std::string campaign_json(const Campaign& campaign, const BatchOptions& options) {
  const std::string hash = options_hash(options);
  CampaignPlan plan{folder_beside_results(campaign.folder, options.results), {}, campaign.problems};
  for (const Run& run : campaign.runs) plan.runs.push_back({run.name, run.file, settings_hash(run, hash)});
  Json json = object("tool", object("name", "tribofit", "version", version));
  json.update(json_of(plan));
  return sealed(text_of(json));
}

bool follow_plan(const BatchOptions& options, Campaign& campaign) {
  if (!folder_of_campaign(options.results)) return false;  // none, or a damaged one
  const std::vector<PlannedRun> plan = ResultReader(options.results).plan().runs;
  if (is_done(options.results, plan)) return false;

  std::map<std::string, Run> found;
  for (Run& run : campaign.runs) found.emplace(run.name, std::move(run));
  const std::string hash = options_hash(options);
  campaign.runs.clear();
  for (const PlannedRun& planned : plan) {
    Run& run = campaign.runs.emplace_back();
    if (auto at = found.extract(planned.name)) {
      run = std::move(at.mapped());
      if (settings_hash(run, hash) == planned.settings) continue;
      throw InputError(fmt::format("another shard planned {} with other options or conditions", planned.file),
                       "give every shard the same ones, or plan anew with --again",
                       {(fs::path(options.results) / campaign_name).string(), 0, ""});
    }
    run.name = planned.name;
    run.file = planned.file;
    run.problem = planned.file + ": was there when the campaign was planned and is gone";
  }
  if (!found.empty()) {
    campaign.notes.push_back(fmt::format(
        "{} left out, {} the first: not there when the first shard planned the campaign; a shard that starts when all "
        "that was planned is done takes {} in",
        found.size() == 1 ? "1 run is" : fmt::format("{} runs are", found.size()), found.begin()->second.file,
        found.size() == 1 ? "it" : "them"));
  }
  return true;
}

}  // namespace tribofit
