#include <fmt/format.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <system_error>

#include "campaign/described_results.hpp"
#include "campaign/kept_samples.hpp"
#include "json_parts.hpp"
#include "tribofit/campaign/compare.hpp"
#include "tribofit/output/text.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/report/campaign.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

// Summary.

Json fit_json(const ResultFit& fit) {
  const auto parameter = [](const ResultParameter& p) {
    return object("name", p.name, "value", p.value, "std_error", p.std_error, "unit", p.unit, "effect",
                  text_or_null(p.effect), "systematic_error", positive_or_null(p.systematic), "at_bound", p.at_bound);
  };
  return object("law", fit.law, "protocol", fit.protocol, "effects", fit.effects, "parameters",
                list_of(fit.parameters, parameter), "error", json_of(fit.error), "floor_rmse", fit.floor.rmse,
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

/// A row of summary.csv by names of columns: what every run has, further conditions, the analysis.
using SummaryRow = std::array<Json, 3>;

void add_fit(const ResultFit& fit, const std::string& friction_unit, Json& row) {
  const auto add = [&](const std::string& name, const std::string& unit, double value) {
    row[with_unit(fit.law + "_" + fit.protocol + "_" + name, unit)] = number(value);
  };
  for (const ResultParameter& p : fit.parameters) {
    add(p.name, p.unit, p.value);
    add(p.name + "_std_error", p.unit, p.std_error);
    if (p.systematic > 0) add(p.name + "_systematic_error", p.unit, p.systematic);
  }
  add("rmse", friction_unit, fit.error.rmse);
  add("held_out_rmse", friction_unit, fit.error.held_out_rmse);
  add("floor_rmse", friction_unit, fit.floor.rmse);
  add("mean_relative", "1", fit.error.mean_relative);
  add("max_relative", "1", fit.error.max_relative);
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

/// The columns are those that any run has, in the order in which they are met. A further condition that is called like
/// a column of ours has a longer name.
std::string summary_csv(const std::vector<SummaryRow>& rows) {
  std::array<std::vector<std::string>, 3> names;
  std::array<std::set<std::string>, 3> known;
  std::string text;
  CsvLine line;
  for (const SummaryRow& row : rows) {
    for (std::size_t part = 0; part < row.size(); ++part) {
      for (const auto& [name, value] : row[part].items()) {
        if (known[part].insert(name).second) names[part].push_back(name);
      }
    }
  }
  for (std::size_t part = 0; part < names.size(); ++part) {
    for (const std::string& name : names[part]) {
      const bool is_ours = part == 1 && (known[0].contains(name) || known[2].contains(name));
      line.add(is_ours ? "condition " + name : name);
    }
  }
  text += line.take();
  for (const SummaryRow& row : rows) {
    for (std::size_t part = 0; part < row.size(); ++part) {
      for (const std::string& name : names[part]) line.add(row[part].value(name, Json()));
    }
    text += line.take();
  }
  return text;
}

// What the runs say together.

/// Of a pooled value, after what it belongs to: members in JSON, cells in CSV.
Json numbers_json(const PooledValue& v) {
  return object("unit", v.unit, "runs", v.runs, "mean", v.mean, "mean_std_error", v.standard_error_of_mean, "value",
                v.value, "std_error", v.std_error, "ci95", interval_json(v.lower95, v.upper95), "statistical",
                v.statistical, "between_runs", v.between, "systematic", positive_or_null(v.systematic));
}

Json value_json(const PooledValue& v) {
  Json json = object("name", v.name, "effect", text_or_null(v.effect));
  json.update(numbers_json(v));
  return json;
}

Json trend_json(const Trend& t) {
  return object("law", t.law, "name", t.parameter, "unit", t.unit, "condition", t.condition, "condition_unit",
                t.condition_unit, "runs", t.runs, "slope", t.slope, "std_error", t.std_error, "ci95",
                interval_json(t.lower95, t.upper95), "p_value", t.p_value, "p_corrected", t.p_corrected);
}

std::string pooled_csv(const Pooled& pooled) {
  const ConditionCells columns{std::span<const PooledGroup>(pooled.groups)};
  std::string text = columns.header() + ",law,protocol,name," + csv_names(numbers_json({})) + "\n";
  for (const PooledGroup& group : pooled.groups) {
    const Json conditions = columns.of(group.conditions, group.others);
    const auto add = [&](const PooledValue& value, const std::string& law, const std::string& protocol) {
      text += csv_line(conditions, law, protocol, full_name(value.name, value.effect), numbers_json(value));
    };
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& value : fit.parameters) add(value, fit.law, fit.protocol);
    }
    for (const PooledValue& value : group.measures) add(value, "", "");
  }
  return text;
}

/// What runs share, then what each has for itself: no mean and no parts of its error.
std::string shared_csv(const Pooled& pooled, std::span<const RunResult> runs) {
  std::string text = "law,name,condition,level,run," + csv_names(numbers_json({})) + "\n";
  for (const SharedFit& fit : pooled.shared) {
    for (const SharedFit::Parameter& common : fit.common) {
      for (std::size_t l = 0; l < common.values.size(); ++l) {
        text += csv_line(fit.law, common.name, common.condition, common.levels[l], "", numbers_json(common.values[l]));
      }
    }
    for (const SharedFit::OfRun& run : fit.runs) {
      for (std::size_t k = 0; k < fit.names.size(); ++k) {
        Json own = numbers_json({});
        for (Json& cell : own) cell = nullptr;
        own["ci95"] = interval_json(std::nan(""), std::nan(""));
        add_members(own, "unit", fit.units[k], "runs", 1, "value", run.value[k], "std_error", run.std_error[k]);
        text += csv_line(fit.law, fit.names[k], "", "", runs[run.run].run.name, own);
      }
    }
  }
  return text;
}

Json shared_json(const SharedFit& fit, std::span<const RunResult> runs) {
  const auto common = [](const SharedFit::Parameter& p) {
    return object("name", p.name, "condition", text_or_null(p.condition), "levels", p.levels, "values",
                  list_of(p.values, value_json));
  };
  const auto each = [&](const SharedFit::OfRun& run) {
    Json parameters = Json::array();
    for (std::size_t k = 0; k < fit.names.size(); ++k) {
      parameters.push_back(
          object("name", fit.names[k], "unit", fit.units[k], "value", run.value[k], "std_error", run.std_error[k]));
    }
    return object("name", runs[run.run].run.name, "parameters", std::move(parameters));
  };
  const SharedFit::Test& test = fit.test;
  const bool tested = std::isfinite(test.held_out_together);
  return object("law", fit.law, "method", fit.is_joint ? "all-samples" : "single-fits", "sharing",
                tested ? object("p_value", test.p_value, "variance_ratio", test.ratio, "refused", test.is_refused,
                                "most_different", test.most_different, "held_out_rmse_together", test.held_out_together,
                                "held_out_rmse_alone", test.held_out_alone, "held_out_p_value", test.held_out_p_value)
                       : Json(nullptr),
                "common", list_of(fit.common, common), "runs", list_of(fit.runs, each), "notes", fit.notes);
}

Json pooled_json(const Pooled& pooled, std::span<const RunResult> runs) {
  const auto fit = [](const PooledGroup::OfFit& f) {
    return object("law", f.law, "protocol", f.protocol, "parameters", list_of(f.parameters, value_json), "best_in",
                  f.best_in);
  };
  const auto group = [&](const PooledGroup& g) {
    return object("conditions", json_of(g.conditions), "others", json_of(g.others), "runs",
                  list_of(g.runs, [&](std::size_t r) { return Json(runs[r].run.name); }), "fits", list_of(g.fits, fit),
                  "measures", list_of(g.measures, value_json));
  };
  const auto confounded = [](const Confounded& c) { return object("a", c.a, "b", c.b, "correlation", c.correlation); };
  return object("tool", object("name", "tribofit", "version", version), "groups", list_of(pooled.groups, group),
                "shared", list_of(pooled.shared, [&](const SharedFit& s) { return shared_json(s, runs); }), "trends",
                list_of(pooled.trends.trends, trend_json), "confounded", list_of(pooled.trends.confounded, confounded),
                "warnings", pooled.trends.warnings);
}

// Earlier values.

Json group_json(const PooledGroup& group) {
  Json json = condition_values(group.conditions), others = Json::object();
  for (const OtherCondition& other : group.others) others[other.name] = other.value;
  json["others"] = std::move(others);
  return json;
}

/// A compared value in the order of comparison.csv, without its conditions.
Json compared_json(const ComparedValue& v) {
  return object("name", v.earlier.name, "law", text_or_null(v.law), "protocol", text_or_null(v.protocol), "unit",
                v.ours.unit, "earlier", v.earlier.value, "earlier_std_error", v.earlier.std_error, "value",
                v.ours.value, "std_error", v.ours.std_error, "systematic_error", positive_or_null(v.ours.systematic),
                "ci95", interval_json(v.ours.lower95, v.ours.upper95), "runs", v.ours.runs, "difference_percent",
                v.percent, "difference_in_std_errors", v.in_std_errors, "earlier_inside_ci95", v.inside95, "line",
                v.earlier.line, "column", v.earlier.column);
}

Json preference_json(const LawPreference& p) {
  if (p.runs == 0) return nullptr;
  return object("better", p.better, "other", p.other, "runs", p.runs, "better_in", p.better_in, "ratio", p.ratio,
                "p_value", p.p_value);
}

Json error_json(const ErrorStatement& e, const PooledGroup& group) {
  return object("conditions", group_json(group), "law", e.law, "protocol", e.protocol, "runs", e.runs,
                "share_below_0.08", e.below_limit, "share_of_bins_below_0.08", e.bins_below_limit, "largest_of_bins",
                e.largest_of_bins, "mean", e.mean_relative, "largest", e.max_relative);
}

}  // namespace

void write_run(const std::string& results, const RunRecord& run, const Identification* result,
               const JsonOptions& options) {
  Json json = result != nullptr ? identification_json(*result, options)
                                : object("tool", tool_json(options), "trace", object("path", run.file), "conditions",
                                         json_of(run.conditions), "fits", Json::array(), "best", nullptr, "analysed",
                                         false, "warnings", Json::array({run.message}));
  keep_samples(results, run, result);
  json["run"] = json_of(run);
  write_whole(result_path(results, run.name), sealed(text_of(json)));
}

CampaignSummary write_summary(const ResultReader& results, const std::string& comparison) {
  const std::filesystem::path folder(results.folder());
  WholeFile csv((folder / "summary.csv").string()), json((folder / summary_name).string());
  json.write("{\"tool\": " + line_of(object("name", "tribofit", "version", version)) + ",\n\"runs\": [");
  std::vector<SummaryRow> rows;
  CampaignSummary summary;
  for (std::size_t k = 0; k < results.size(); ++k) {
    json.write(k == 0 ? "\n" : ",\n");
    if (const auto result = results.read(k)) {
      const RunRecord& run = result->run;
      rows.push_back(summary_row(*result));
      json.write(line_of(result_json(*result)));
      ++(run.status == RunStatus::ok ? summary.fitted : summary.failed);
      const bool failed = run.status == RunStatus::failed;
      const std::string why = (failed ? run.file + ": the analysis could not be done: " : "") + run.message;
      if (run.status != RunStatus::ok) summary.errors.push_back(why);
    } else {
      const PlannedRun& run = results.plan().runs[k];
      rows.push_back(summary_row(run.name, run.file, "missing"));
      json.write(line_of(object("name", run.name, "file", run.file, "status", "missing", "message", nullptr)));
      ++summary.missing;
      summary.errors.push_back(run.file + ": there is no result of it yet");
    }
  }
  csv.write(summary_csv(rows));
  json.write("\n],\n\"problems\": " + line_of(results.plan().problems));
  if (!comparison.empty()) json.write(",\n\"comparison\": " + comparison);
  json.write("}\n");
  json.finish();
  csv.commit();
  json.commit();
  return summary;
}

void write_pooled(const std::string& folder, std::span<const RunResult> runs, const Pooled& pooled) {
  const std::filesystem::path in(folder);
  const auto write = [&](const char* name, const std::string& text) { write_whole((in / name).string(), text); };
  write("pooled.csv", pooled_csv(pooled));
  std::string trends = csv_names(trend_json({})) + "\n";
  for (const Trend& trend : pooled.trends.trends) trends += csv_line(trend_json(trend));
  write("trends.csv", trends);
  if (std::error_code ignored; pooled.shared.empty()) {
    std::filesystem::remove(in / "shared.csv", ignored);  // of another sharing
  } else {
    write("shared.csv", shared_csv(pooled, runs));
  }
  write(pooled_name, text_of(pooled_json(pooled, runs)));
}

std::string comparison_csv(const ComparisonReport& report, std::span<const PooledGroup> groups) {
  std::string text = csv_names(group_json({})) + "," + csv_names(compared_json({})) + "\n";
  for (const ComparedValue& v : report.values.values) {
    const PooledGroup& group = groups[v.group];
    Json conditions = group_json(group);
    conditions["others"] = group.others.empty() ? "" : conditions_text({}, group.others);
    text += csv_line(conditions, compared_json(v));
  }
  return text;
}

std::string comparison_json(const ComparisonReport& report, std::span<const PooledGroup> groups) {
  const auto value = [&](const ComparedValue& v) {
    Json json = object("conditions", group_json(groups[v.group]));
    json.update(compared_json(v));
    return json;
  };
  const Statements& s = report.statements;
  Json preference = Json::array();
  for (std::size_t g = 0; g < s.preference.size(); ++g) {
    const LawPreference& p = s.preference[g];
    if (p.runs > 0) preference.push_back(object("conditions", group_json(groups[g]), "laws", preference_json(p)));
  }
  const auto error = [&](const ErrorStatement& e) { return error_json(e, groups[e.group]); };
  return line_of(object("path", report.values.path, "values", list_of(report.values.values, value), "unmatched",
                        report.values.unmatched, "relative_error", list_of(s.errors, error), "law_preference",
                        object("overall", preference_json(s.overall), "by_conditions", std::move(preference))));
}

}  // namespace tribofit
