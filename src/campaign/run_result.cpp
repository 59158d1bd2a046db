#include "tribofit/campaign/run_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "described_results.hpp"
#include "ingest/content_hash.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"
#include "tribofit/output/text.hpp"

namespace tribofit {
namespace {

constexpr std::string_view kEnd = "\n}\n", kSeal = ",\n  \"checksum\": \"";

CampaignPlan plan_in(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / campaign_name).string();
  std::error_code ignored;
  // On a network file system this asks the server what is there now: without, what was looked for in vain a moment ago
  // stays missing for a while.
  const std::filesystem::directory_iterator asked_anew(folder, ignored);
  if (!std::filesystem::exists(path, ignored)) {
    throw InputError("holds no results of a campaign (there is no campaign.json)",
                     "name the folder given to --out, or make it: identify runs/ --out " + folder, {folder, 0, ""});
  }
  const auto json = read_sealed(path);
  if (!json) {
    throw InputError("is damaged", "run the batch again: it writes the file anew and keeps the results", {path, 0, ""});
  }
  try {
    json->at("runs");
    return read_from<CampaignPlan>(*json);
  } catch (const Json::exception&) {  // whole, but of another make
    throw InputError("is no list of runs", "run the batch again with --again: it writes the file anew", {path, 0, ""});
  }
}

}  // namespace

constexpr std::array<std::string_view, 3> kStatuses = {"ok", "failed", "unreadable"};

std::string_view to_string(RunStatus status) {
  return kStatuses[static_cast<std::size_t>(status)];
}

const ResultFit* RunResult::fit(std::string_view law, std::string_view protocol) const {
  const auto found = std::ranges::find_if(
      fits, [&](const ResultFit& f) { return f.law == law && f.protocol == protocol && !f.parameters.empty(); });
  return found == fits.end() ? nullptr : &*found;
}

std::vector<const ResultFit*> joint_fits(std::span<const RunResult> runs, bool with_covariance) {
  std::vector<const ResultFit*> laws;
  for (const RunResult& run : runs) {
    for (const ResultFit& fit : run.fits) {
      const bool known = std::ranges::any_of(laws, [&](const ResultFit* other) { return other->law == fit.law; });
      const bool usable = !fit.parameters.empty() && (!with_covariance || !fit.covariance.empty());
      if (fit.protocol == to_string(Protocol::joint) && usable && !known) laws.push_back(&fit);
    }
  }
  return laws;
}

void read_json(const Json& json, RunStatus& status) {
  const auto known = std::ranges::find(kStatuses, json.get<std::string>());
  status = known == kStatuses.end() ? RunStatus::unreadable : static_cast<RunStatus>(known - kStatuses.begin());
}

std::string sealed(std::string_view json) {
  std::string text(json.substr(0, json.find_last_not_of('\n', json.rfind('}') - 1) + 1));
  const std::string checksum = hexadecimal(xxh64(text));
  text += std::string(kSeal) + checksum + "\"" + std::string(kEnd);
  return text;
}

bool is_whole(std::string_view text) {
  const std::size_t at = text.rfind(kSeal);
  return at != std::string_view::npos && text == sealed(std::string(text.substr(0, at)) + std::string(kEnd));
}

std::optional<Json> read_sealed(const std::string& path) {
  try {
    const std::string bytes = text_of_file(path, std::uint64_t{1} << 30, "name a result of a batch");
    Json json = is_whole(bytes) && !is_nested_deeper(bytes) ? Json::parse(bytes, nullptr, false) : Json();
    if (json.is_object()) return json;
  } catch (const InputError&) {  // it cannot be read
  }
  return std::nullopt;
}

std::optional<RunRecord> read_record(const std::string& path) {
  try {
    if (const auto json = read_sealed(path)) return read_from<RunRecord>(json->at("run"));
  } catch (const Json::exception&) {  // whole, but of another make
  }
  return std::nullopt;
}

std::optional<std::string> folder_of_campaign(const std::string& results) {
  const auto json = read_sealed((std::filesystem::path(results) / campaign_name).string());
  if (!json || !json->contains("folder")) return std::nullopt;
  const Json& folder = json->at("folder");
  return folder.is_string() ? folder.get<std::string>() : "";
}

ResultReader::ResultReader(std::string folder) : folder_(std::move(folder)), plan_(plan_in(folder_)) {}

std::optional<RunResult> ResultReader::read(std::size_t k) const {
  const PlannedRun& run = plan_.runs.at(k);
  try {
    const auto json = read_sealed(result_path(folder_, run.name));
    if (!json || json->at("run").at("settings") != run.settings) return std::nullopt;
    RunResult result = read_from<RunResult>(*json);
    result.position = k;
    if (result.best >= result.fits.size()) result.best = 0;
    return result;
  } catch (const Json::exception&) {  // whole, but of another make: as if it were not there
    return std::nullopt;
  }
}

std::vector<RunResult> read_results(const std::string& folder) {
  const ResultReader reader(folder);
  std::vector<RunResult> runs;
  for (std::size_t k = 0; k < reader.size(); ++k) {
    if (auto result = reader.read(k)) runs.push_back(std::move(*result));
  }
  put_in_order(runs);
  count_copies_once(runs);
  return runs;
}

void count_copies_once(std::vector<RunResult>& runs) {
  std::map<std::string, std::string> first;  // file of each record
  for (RunResult& run : runs) {
    if (run.checksum.empty() || run.fits.empty()) continue;
    const auto [at, is_new] = first.emplace(run.checksum, run.run.file);
    if (is_new) continue;
    run.run.status = RunStatus::failed;
    run.run.message =
        fmt::format("{} holds the same values as {}: a copy is no repeat, it counts once", run.run.file, at->second);
    run.fits.clear();
  }
}

}  // namespace tribofit
