#include "tribofit/campaign/run_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <utility>

#include "condensed_json.hpp"
#include "condition_cells.hpp"
#include "figures_json.hpp"
#include "ingest/content_hash.hpp"
#include "order.hpp"
#include "output/json.hpp"
#include "tribofit/campaign/batch.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/text_of_file.hpp"

namespace tribofit {
namespace {

constexpr std::string_view kFigures = "\n  \"figures\": {", kCondensed = "\n  \"condensed\": {";
constexpr std::string_view kEnd = "\n}\n", kSeal = ",\n  \"checksum\": \"";

/// A number, NaN for null and for what is not there.
double number(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number() ? found->get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string text(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

std::size_t count(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_number_unsigned() ? found->get<std::size_t>() : 0;
}

std::vector<std::string> texts(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() ? found->get<std::vector<std::string>>() : std::vector<std::string>{};
}

Conditions conditions_of(const Json& json) {
  Conditions conditions;
  for (const ConditionInfo& info : condition_infos) {
    conditions.*info.member = {number(json, info.column) * info.si, text(json, source_key(info).c_str())};
  }
  return conditions;
}

RunStatus status_of(const std::string& name) {
  if (name == "ok") return RunStatus::ok;
  return name == "failed" ? RunStatus::failed : RunStatus::unreadable;
}

RunRecord record_of(const Json& run) {
  RunRecord record;
  record.name = text(run, "name");
  record.file = text(run, "file");
  record.key = text(run, "key");
  record.settings = text(run, "settings");
  record.status = status_of(text(run, "status"));
  record.message = text(run, "message");
  record.conditions = conditions_of(run.at("stated"));
  if (run.at("repeat").is_number()) record.repeat = run.at("repeat").get<int>();
  for (const Json& other : run.at("others")) record.others.push_back({text(other, "name"), text(other, "value")});
  return record;
}

ResultParameter parameter_of(const Json& json) {
  ResultParameter p;
  p.name = text(json, "name");
  p.unit = text(json, "unit");
  p.effect = text(json, "effect");
  p.value = number(json, "value");
  p.std_error = number(json, "std_error");
  p.systematic = json.at("systematic_error").is_null() ? 0 : number(json, "systematic_error");
  const Json& ci = json.at("ci95");
  const auto end = [&](std::size_t k) {
    return ci.at(k).is_number() ? ci.at(k).get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  p.lower95 = end(0);
  p.upper95 = end(1);
  p.at_bound = json.at("at_bound").get<bool>();
  return p;
}

ResultFit fit_of(const Json& json) {
  ResultFit fit;
  fit.law = text(json, "law");
  fit.protocol = text(json, "protocol");
  fit.effects = texts(json, "effects");
  for (const Json& parameter : json.at("parameters")) fit.parameters.push_back(parameter_of(parameter));
  for (const Json& row : json.at("covariance")) {
    for (const Json& value : row) {
      fit.covariance.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
    }
  }
  fit.degrees_of_freedom = number(json, "degrees_of_freedom");
  const Json& error = json.at("error");
  fit.rmse = number(error, "rmse");
  fit.held_out_rmse = number(error, "held_out_rmse");
  fit.mean_relative = number(error, "mean_relative");
  fit.max_relative = number(error, "max_relative");
  fit.floor_rmse = number(json, "floor_rmse");
  fit.explained = number(json, "explained");
  fit.converged = json.at("converged").get<bool>();
  fit.cycles = count(json, "cycles");
  fit.messages = texts(json, "messages");
  return fit;
}

void read_stick_slip(const Json& json, RunResult& result) {
  result.cycles = count(json, "cycles");
  result.frequency = {number(json.at("frequency_hz"), "value"), number(json.at("frequency_hz"), "std_error")};
  result.amplitude = {number(json, "amplitude_mm_s"), number(json, "amplitude_std_error_mm_s")};
  result.stick_time = {number(json, "stick_time_s"), number(json, "stick_time_std_error_s")};
  result.slip_time = {number(json, "slip_time_s"), number(json, "slip_time_std_error_s")};
  result.rms_velocity = number(json, "rms_velocity_mm_s");
}

RunResult result_of(const Json& json) {
  RunResult result;
  result.run = record_of(json.at("run"));
  if (json.contains("conditions")) result.conditions = conditions_of(json.at("conditions"));
  if (json.contains("trace")) {
    const Json& trace = json.at("trace");
    if (trace.contains("friction_unit")) result.friction_unit = text(trace, "friction_unit");
    result.samples = count(trace, "samples");
    result.duration = number(trace, "duration_s");
    result.rate = number(trace, "rate_hz");
    if (trace.contains("checksum")) result.checksum = text(trace, "checksum");
  }
  if (json.contains("stick_slip")) read_stick_slip(json.at("stick_slip"), result);
  for (const Json& fit : json.at("fits")) result.fits.push_back(fit_of(fit));
  result.best = json.contains("best") && json.at("best").is_number() ? count(json, "best") : 0;
  if (result.best >= result.fits.size()) result.best = 0;
  result.warnings = texts(json, "warnings");
  return result;
}

/// The bytes of a file, empty where it cannot be read.
std::string bytes_of(const std::string& path) {
  constexpr std::uint64_t most = std::uint64_t{1} << 30;
  try {
    return text_of_file(path, most, "name a result of a batch");
  } catch (const InputError&) {
    return {};
  }
}

/// The line that begins so in the text of a result, with the line break before it; empty where it has none.
std::string_view line_with(std::string_view begins, std::string_view text) {
  const std::size_t begin = text.find(begins);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find('\n', begin + 1) - begin);
}

/// The object in a sealed file without the lines of many numbers that few ask for; or nothing.
std::optional<Json> object_in(const std::string& path) {
  std::string bytes = bytes_of(path);
  if (!is_whole(bytes)) return std::nullopt;
  for (const std::string_view begins : {kFigures, kCondensed}) {
    const std::string_view line = line_with(begins, bytes);
    if (!line.empty()) bytes.erase(static_cast<std::size_t>(line.data() - bytes.data()), line.size());
  }
  Json json = Json::parse(bytes, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  return json;
}

/// What `read` makes of the object on that line of a sealed file; nothing where it has none.
template <class Read>
auto read_line(const std::string& path, std::string_view begins, Read&& read) -> std::optional<decltype(read(Json()))> {
  const std::string bytes = bytes_of(path);
  const std::string_view line = line_with(begins, bytes);
  if (line.empty() || !is_whole(bytes)) return std::nullopt;
  const std::size_t begin = line.find('{'), end = line.rfind('}') + 1;
  try {
    return read(Json::parse(line.substr(begin, end - begin)));
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

Json campaign_object(const std::string& folder) {
  const std::string path = (std::filesystem::path(folder) / campaign_name).string();
  std::error_code ignored;
  // On a network file system this asks the server what is there now: without, what was looked for in vain a moment ago
  // stays missing for a while.
  const std::filesystem::directory_iterator asked_anew(folder, ignored);
  if (!std::filesystem::exists(path, ignored)) {
    throw InputError("holds no results of a campaign (there is no campaign.json)",
                     "name the folder given to --out, or make it: identify runs/ --out " + folder, {folder, 0, ""});
  }
  auto json = object_in(path);
  if (!json) {
    throw InputError("is damaged", "run the batch again: it writes the file anew and keeps the results", {path, 0, ""});
  }
  return std::move(*json);
}

}  // namespace

std::string_view to_string(RunStatus status) {
  if (status == RunStatus::ok) return "ok";
  return status == RunStatus::failed ? "failed" : "unreadable";
}

const ResultFit* RunResult::fit(std::string_view law, std::string_view protocol) const {
  const auto found = std::find_if(fits.begin(), fits.end(), [&](const ResultFit& f) {
    return f.law == law && f.protocol == protocol && !f.parameters.empty();
  });
  return found == fits.end() ? nullptr : &*found;
}

std::string sealed(std::string_view json) {
  std::string text(json.substr(0, json.size() - std::min(json.size(), kEnd.size())));
  const std::string checksum = hexadecimal(xxh64(text));
  text += std::string(kSeal) + checksum + "\"" + std::string(kEnd);
  return text;
}

bool is_whole(std::string_view text) {
  const std::size_t at = text.rfind(kSeal);
  return at != std::string_view::npos && text == sealed(std::string(text.substr(0, at)) + std::string(kEnd));
}

std::optional<RunRecord> read_record(const std::string& path) {
  try {
    const auto json = object_in(path);
    if (!json) return std::nullopt;
    return record_of(json->at("run"));
  } catch (const Json::exception&) {  // whole, but of another make
    return std::nullopt;
  }
}

std::optional<std::string> folder_of_campaign(const std::string& results) {
  const auto json = object_in((std::filesystem::path(results) / campaign_name).string());
  if (!json) return std::nullopt;
  return text(*json, "folder");
}

ResultReader::ResultReader(std::string folder) : folder_(std::move(folder)) {
  const Json campaign = campaign_object(folder_);
  traces_ = text(campaign, "folder");
  try {
    problems_ = texts(campaign, "problems");
    for (const Json& run : campaign.at("runs")) {
      runs_.push_back({text(run, "name"), text(run, "file"), text(run, "settings")});
    }
  } catch (const Json::exception&) {  // whole, but of another make
    throw InputError("is no list of runs", "run the batch again with --again: it writes the file anew",
                     {(std::filesystem::path(folder_) / campaign_name).string(), 0, ""});
  }
}

std::optional<RunResult> ResultReader::read(std::size_t k) const {
  const PlannedRun& run = runs_.at(k);
  try {
    const auto json = object_in(result_path(folder_, run.name));
    if (!json || text(json->at("run"), "settings") != run.settings) return std::nullopt;
    RunResult result = result_of(*json);
    result.position = k;
    return result;
  } catch (const Json::exception&) {  // whole, but of another make: as if it were not there
    return std::nullopt;
  }
}

std::optional<RunFigures> ResultReader::figures(std::size_t k) const {
  return read_line(result_path(folder_, runs_.at(k).name), kFigures, figures_from);
}

std::optional<CondensedRun> ResultReader::condensed(std::size_t k) const {
  return read_line(result_path(folder_, runs_.at(k).name), kCondensed, condensed_from);
}

MissingRun ResultReader::missing(std::size_t k) const {
  return {runs_.at(k).name, runs_.at(k).file, k};
}

CampaignResults read_campaign(const std::string& folder) {
  const ResultReader reader(folder);
  CampaignResults results;
  results.folder = reader.traces();
  results.problems = reader.problems();
  for (std::size_t k = 0; k < reader.size(); ++k) {
    if (auto result = reader.read(k)) {
      results.runs.push_back(std::move(*result));
    } else {
      results.missing.push_back(reader.missing(k));
    }
  }
  put_in_order(results.runs);
  count_copies_once(results.runs);
  return results;
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

std::vector<RunResult> read_results(const std::string& folder) {
  return read_campaign(folder).runs;
}

}  // namespace tribofit
