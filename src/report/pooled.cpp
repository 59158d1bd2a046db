#include "tribofit/report/pooled.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "campaign/described_results.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "tribofit/output/whole_file.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

/// Of a pooled value, after what it belongs to: members in JSON, cells in CSV.
Json numbers_json(const PooledValue& v) {
  return object("unit", v.unit, "runs", v.runs, "mean", v.mean, "mean_std_error", v.standard_error_of_mean, "value",
                v.value, "std_error", v.std_error, "ci95", interval_json(v.lower95, v.upper95), "statistical",
                v.statistical, "between_runs", v.between, "systematic", positive_or_null(v.systematic));
}

/// What a run has for itself beside what it shares: no mean and no parts of its error.
PooledValue of_one_run(const std::string& unit, double value, double std_error) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  PooledValue own;
  own.unit = unit;
  own.runs = 1;
  own.value = value;
  own.std_error = std_error;
  own.lower95 = own.upper95 = own.statistical = own.between = own.mean = own.standard_error_of_mean = kNone;
  return own;
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
        text += csv_line(fit.law, fit.names[k], "", "", runs[run.run].run.name,
                         numbers_json(of_one_run(fit.units[k], run.value[k], run.std_error[k])));
      }
    }
  }
  return text;
}

std::string trends_csv(const Trends& trends) {
  std::string text = csv_names(trend_json({})) + "\n";
  for (const Trend& trend : trends.trends) text += csv_line(trend_json(trend));
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

std::string pooled_json(const Pooled& pooled, std::span<const RunResult> runs) {
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
  return text_of(object("tool", object("name", "tribofit", "version", version), "groups", list_of(pooled.groups, group),
                        "shared", list_of(pooled.shared, [&](const SharedFit& s) { return shared_json(s, runs); }),
                        "trends", list_of(pooled.trends.trends, trend_json), "confounded",
                        list_of(pooled.trends.confounded, confounded), "warnings", pooled.trends.warnings));
}

Json group_json(const PooledGroup& group) {
  Json others = Json::object();
  for (const OtherCondition& other : group.others) others[other.name] = other.value;
  Json json = condition_values(group.conditions);
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

void write_pooled(const std::string& folder, std::span<const RunResult> runs, const Pooled& pooled) {
  const std::filesystem::path in(folder);
  const auto write = [&](const char* name, const std::string& text) { write_whole((in / name).string(), text); };
  write("pooled.csv", pooled_csv(pooled));
  write("trends.csv", trends_csv(pooled.trends));
  std::error_code ignored;
  if (pooled.shared.empty()) {
    std::filesystem::remove(in / "shared.csv", ignored);  // of another sharing
  } else {
    write("shared.csv", shared_csv(pooled, runs));
  }
  write("pooled.json", pooled_json(pooled, runs));
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
