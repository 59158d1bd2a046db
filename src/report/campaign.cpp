#include "tribofit/report/campaign.hpp"

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <set>

#include "campaign/described_results.hpp"
#include "campaign/kept_samples.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

Json fit_json(const ResultFit& fit) {
  const auto parameter = [](const ResultParameter& p) {
    return object("name", p.name, "value", p.value, "std_error", p.std_error, "unit", p.unit, "effect",
                  text_or_null(p.effect), "systematic_error", positive_or_null(p.systematic), "at_bound", p.at_bound);
  };
  return object("law", fit.law, "protocol", fit.protocol, "effects", fit.effects, "parameters",
                list_of(fit.parameters, parameter), "error", written(error_members, fit), "floor_rmse", fit.floor_rmse,
                "converged", fit.converged);
}

/// The measures of stick-slip; summary.csv has columns of the same names.
Json measures_json(const RunResult& r) {
  return object("cycles", r.cycles, "frequency_hz", r.frequency.value, "frequency_std_error_hz", r.frequency.std_error,
                "amplitude_mm_s", r.amplitude.value, "amplitude_std_error_mm_s", r.amplitude.std_error, "stick_time_s",
                r.stick_time.value, "stick_time_std_error_s", r.stick_time.std_error, "slip_time_s", r.slip_time.value,
                "slip_time_std_error_s", r.slip_time.std_error, "rms_velocity_mm_s", r.rms_velocity);
}

Json result_json(const RunResult& result) {
  const RunRecord& run = result.run;
  return object("name", run.name, "file", run.file, "status", to_string(run.status), "message",
                text_or_null(run.message), "conditions", json_of(result.known_conditions()), "repeat",
                json_of(run.repeat), "others", json_of(run.others), "friction_unit", result.friction_unit, "stick_slip",
                result.was_read() ? measures_json(result) : Json(nullptr), "fits", list_of(result.fits, fit_json),
                "best", result.fits.empty() ? Json(nullptr) : Json(result.best));
}

/// A row of summary.csv, values under the names of their columns: what every run has, further conditions, the analysis.
using SummaryRow = std::array<Json, 3>;

void add_fit(const ResultFit& fit, const std::string& friction_unit, Json& row) {
  const std::string of_fit = fit.law + "_" + fit.protocol + "_";
  const auto add = [&](const std::string& name, const std::string& unit, double value) {
    row[with_unit(of_fit + name, unit)] = number(value);
  };
  for (const ResultParameter& p : fit.parameters) {
    add(p.name, p.unit, p.value);
    add(p.name + "_std_error", p.unit, p.std_error);
    if (p.systematic > 0) add(p.name + "_systematic_error", p.unit, p.systematic);
  }
  add("rmse", friction_unit, fit.rmse);
  add("held_out_rmse", friction_unit, fit.held_out_rmse);
  add("floor_rmse", friction_unit, fit.floor_rmse);
  add("mean_relative", "1", fit.mean_relative);
  add("max_relative", "1", fit.max_relative);
}

SummaryRow summary_row(const std::string& name, const std::string& file, std::string_view status) {
  Json fixed = object("run", name, "file", file, "status", status, "message", nullptr);
  fixed.update(condition_values({}));
  fixed["repeat"] = nullptr;
  return {std::move(fixed), Json::object(), Json::object()};
}

SummaryRow summary_row(const RunResult& result) {
  const RunRecord& run = result.run;
  SummaryRow row = summary_row(run.name, run.file, to_string(run.status));
  auto& [fixed, conditions, analysis] = row;
  fixed.update(condition_values(result.known_conditions()));
  add_members(fixed, "message", run.message, "repeat", json_of(run.repeat));
  for (const OtherCondition& other : run.others) conditions[other.name] = other.value;
  if (!result.was_read()) return row;
  analysis = object("samples", result.samples, "duration_s", result.duration, "rate_hz", result.rate);
  analysis.update(measures_json(result));
  analysis["best_law"] = result.fits.empty() ? "" : result.fits[result.best].law;
  for (const ResultFit& fit : result.fits) add_fit(fit, result.friction_unit, analysis);
  return row;
}

/// The columns of summary.csv: those that any run has, in the order in which they are met. A further condition that is
/// called like a column of ours has a longer name.
class SummaryColumns {
 public:
  void declare(const SummaryRow& row) {
    for (std::size_t part = 0; part < row.size(); ++part) {
      for (const auto& [name, value] : row[part].items()) {
        if (known_[part].insert(name).second) names_[part].push_back(name);
      }
    }
  }
  std::string header() const {
    const auto& [fixed, conditions, analysis] = known_;
    std::vector<std::string> header = names_[0];
    for (const std::string& name : names_[1]) {
      const bool is_ours = fixed.contains(name) || analysis.contains(name);
      header.push_back(is_ours ? "condition " + name : name);
    }
    header.insert(header.end(), names_[2].begin(), names_[2].end());
    return csv_line(Json(header));
  }
  std::string line(const SummaryRow& row) const {
    CsvLine line;
    for (std::size_t part = 0; part < row.size(); ++part) {
      for (const std::string& name : names_[part]) line.add(row[part].value(name, Json()));
    }
    return line.take();
  }

 private:
  std::array<std::vector<std::string>, 3> names_;
  std::array<std::set<std::string>, 3> known_;
};

std::string error_line(const RunRecord& run) {
  return run.status == RunStatus::failed ? run.file + ": the analysis could not be done: " + run.message : run.message;
}

}  // namespace

void write_run(const std::string& results, const RunRecord& run, const Identification* result,
               const JsonOptions& options) {
  Json json;
  if (result != nullptr) {
    json = identification_json(*result, options);
  } else {
    json = object("tool", tool_json(options), "trace", object("path", run.file), "conditions", json_of(run.conditions),
                  "fits", Json::array(), "best", nullptr, "analysed", false, "warnings", Json::array({run.message}));
  }
  keep_samples(results, run, result);
  json["run"] = json_of(run);
  write_whole(result_path(results, run.name), sealed(text_of(json)));
}

CampaignSummary write_summary(const ResultReader& results, const std::string& comparison) {
  const std::filesystem::path folder(results.folder());
  WholeFile csv((folder / "summary.csv").string()), json((folder / "summary.json").string());
  json.write("{\"tool\": " + line_of(object("name", "tribofit", "version", version)) + ",\n\"runs\": [");
  SummaryColumns columns;
  columns.declare(summary_row("", "", ""));
  for (std::size_t k = 0; k < results.size(); ++k) {
    if (const auto result = results.read(k)) columns.declare(summary_row(*result));
  }
  csv.write(columns.header());
  CampaignSummary summary;
  for (std::size_t k = 0; k < results.size(); ++k) {
    const auto result = results.read(k);
    const PlannedRun& planned = results.plan()[k];
    csv.write(columns.line(result ? summary_row(*result) : summary_row(planned.name, planned.file, "missing")));
    json.write((k == 0 ? "\n" : ",\n") + line_of(result ? result_json(*result)
                                                        : object("name", planned.name, "file", planned.file, "status",
                                                                 "missing", "message", nullptr)));
    const bool ok = result && result->run.status == RunStatus::ok;
    ++(ok ? summary.fitted : result ? summary.failed : summary.missing);
    if (!ok) {
      summary.errors.push_back(result ? error_line(result->run) : planned.file + ": there is no result of it yet");
    }
  }
  json.write("\n],\n\"problems\": " + line_of(results.problems()));
  if (!comparison.empty()) json.write(",\n\"comparison\": " + comparison);
  json.write("}\n");
  json.finish();
  csv.commit();
  json.commit();
  return summary;
}

}  // namespace tribofit
