#include "tribofit/report/campaign.hpp"

#include <filesystem>
#include <utility>

#include "campaign/figures_json.hpp"
#include "json_parts.hpp"
#include "summary_tables.hpp"
#include "tribofit/report/whole_file.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

Json tool_only() {
  return {{"name", "tribofit"}, {"version", version}};
}

Json others_json(const std::vector<OtherCondition>& others) {
  Json list = Json::array();
  for (const OtherCondition& other : others) list.push_back({{"name", other.name}, {"value", other.value}});
  return list;
}

Json repeat_json(const RunRecord& run) {
  return run.repeat ? Json(*run.repeat) : Json(nullptr);
}

Json record_json(const RunRecord& run) {
  return {{"name", run.name},
          {"file", run.file},
          {"key", run.key},
          {"settings", run.settings},
          {"status", to_string(run.status)},
          {"message", text_or_null(run.message)},
          {"stated", conditions_json(run.conditions)},
          {"repeat", repeat_json(run)},
          {"others", others_json(run.others)}};
}

Json parameters_json(const ResultFit& fit) {
  Json list = Json::array();
  for (const ResultParameter& p : fit.parameters) {
    list.push_back({{"name", p.name},
                    {"value", number(p.value)},
                    {"std_error", number(p.std_error)},
                    {"unit", p.unit},
                    {"effect", text_or_null(p.effect)},
                    {"systematic_error", p.systematic > 0 ? number(p.systematic) : Json(nullptr)},
                    {"at_bound", p.at_bound}});
  }
  return list;
}

Json fit_json(const ResultFit& fit) {
  return {{"law", fit.law},
          {"protocol", fit.protocol},
          {"effects", fit.effects},
          {"parameters", parameters_json(fit)},
          {"error",
           {{"rmse", number(fit.rmse)},
            {"mean_relative", number(fit.mean_relative)},
            {"max_relative", number(fit.max_relative)},
            {"held_out_rmse", number(fit.held_out_rmse)}}},
          {"floor_rmse", number(fit.floor_rmse)},
          {"converged", fit.converged}};
}

Json measures_json(const RunResult& result) {
  return {{"cycles", result.cycles},
          {"frequency_hz", number(result.frequency.value)},
          {"frequency_std_error_hz", number(result.frequency.std_error)},
          {"amplitude_mm_s", number(result.amplitude.value)},
          {"amplitude_std_error_mm_s", number(result.amplitude.std_error)},
          {"stick_time_s", number(result.stick_time.value)},
          {"stick_time_std_error_s", number(result.stick_time.std_error)},
          {"slip_time_s", number(result.slip_time.value)},
          {"slip_time_std_error_s", number(result.slip_time.std_error)},
          {"rms_velocity_mm_s", number(result.rms_velocity)}};
}

Json result_json(const RunResult& result) {
  Json fits = Json::array();
  for (const ResultFit& fit : result.fits) fits.push_back(fit_json(fit));
  const bool read = result.run.status != RunStatus::unreadable;
  return {{"name", result.run.name},
          {"file", result.run.file},
          {"status", to_string(result.run.status)},
          {"message", text_or_null(result.run.message)},
          {"conditions", conditions_json(read ? result.conditions : result.run.conditions)},
          {"repeat", repeat_json(result.run)},
          {"others", others_json(result.run.others)},
          {"friction_unit", result.friction_unit},
          {"stick_slip", read ? measures_json(result) : Json(nullptr)},
          {"fits", std::move(fits)},
          {"best", result.fits.empty() ? Json(nullptr) : Json(result.best)}};
}

std::string complaint(const RunRecord& run) {
  return run.status == RunStatus::failed ? run.file + ": the analysis could not be done: " + run.message : run.message;
}

}  // namespace

std::string run_json(const RunRecord& run, const Identification* result, const JsonOptions& options) {
  Json json;
  if (result != nullptr) {
    json = identification_json(*result, options);
  } else {
    json = {{"tool", tool_json(options)},
            {"trace", {{"path", run.file}}},
            {"conditions", conditions_json(run.conditions)},
            {"fits", Json::array()},
            {"best", nullptr},
            {"analysed", false},
            {"warnings", {run.message}}};
  }
  json["run"] = record_json(run);
  std::string text = text_of(json);
  if (result != nullptr && result->analysed) {  // many numbers: on one line
    text.insert(text.size() - 3, ",\n  \"figures\": " + figures_text(figures_of(*result)));
  }
  return sealed(text);
}

std::string campaign_json(const Campaign& campaign, const BatchOptions& options) {
  const std::string hash = options_hash(options);
  Json runs = Json::array();
  for (const Run& run : campaign.runs) {
    runs.push_back({{"name", run.name}, {"file", run.file}, {"settings", settings_hash(run, hash)}});
  }
  std::error_code ignored;
  const std::string folder =
      campaign.folder.empty() ? "" : std::filesystem::weakly_canonical(campaign.folder, ignored).string();
  return sealed(text_of({{"tool", tool_only()},
                         {"folder", text_or_null(folder)},
                         {"runs", std::move(runs)},
                         {"problems", campaign.problems}}));
}

CampaignSummary write_summary(const ResultReader& results, const TerminalOptions& options,
                              const std::string& comparison) {
  const std::filesystem::path folder(results.folder());
  WholeFile csv((folder / "summary.csv").string()), json((folder / "summary.json").string());
  const auto line = [](const Json& object) { return object.dump(-1, ' ', false, Json::error_handler_t::replace); };
  json.write("{\"tool\": " + line(tool_only()) + ",\n\"runs\": [");
  std::string separator = "\n";
  const auto add = [&](const Json& run) {
    json.write(separator + line(run));
    separator = ",\n";
  };

  CampaignSummary summary;
  SummarySheet sheet;
  for_each_run(
      results, [&](const RunResult& result) { sheet.declare(result); }, [](const MissingRun&) {});
  csv.write(sheet.header());
  ResultTable table(options);
  for_each_run(
      results,
      [&](const RunResult& result) {
        csv.write(sheet.row(result));
        add(result_json(result));
        table.add(result);
        const bool ok = result.run.status == RunStatus::ok;
        ++(ok ? summary.fitted : summary.failed);
        if (!ok) summary.complaints.push_back(complaint(result.run));
      },
      [&](const MissingRun& run) {
        csv.write(sheet.row(run));
        add({{"name", run.name}, {"file", run.file}, {"status", "missing"}, {"message", nullptr}});
        table.add(run);
        ++summary.missing;
        summary.complaints.push_back(run.file + ": there is no result of it yet");
      });
  json.write("\n],\n\"problems\": " + line(results.problems()));
  if (!comparison.empty()) json.write(",\n\"comparison\": " + comparison);
  json.write("}\n");
  json.finish();
  csv.commit();
  json.commit();
  summary.table = table.text();
  return summary;
}

}  // namespace tribofit
