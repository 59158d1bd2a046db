#include "tribofit/report/pooled.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "campaign_cells.hpp"
#include "conditions_cells.hpp"
#include "csv_cells.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "style.hpp"
#include "tribofit/campaign/earlier.hpp"
#include "tribofit/report/whole_file.hpp"
#include "tribofit/version.hpp"

namespace tribofit {
namespace {

constexpr double kChance = 0.05;  ///< corrected p-value above which a trend is not spoken of

constexpr const char* kValueColumns =
    "unit,runs,mean,mean_std_error,value,std_error,ci95_lower,ci95_upper,statistical,between_runs,systematic";

std::string cells(const PooledValue& value) {
  std::string text = cell(value.unit) + "," + std::to_string(value.runs);
  for (const double x : {value.mean, value.standard_error_of_mean, value.value, value.std_error, value.lower95,
                         value.upper95, value.statistical, value.between, value.systematic}) {
    text += "," + cell(x);
  }
  return text;
}

std::string pooled_csv(const Pooled& pooled) {
  const ConditionCells columns{std::span<const PooledGroup>(pooled.groups)};
  std::string text = columns.header() + ",law,protocol,name," + kValueColumns + "\n";
  for (const PooledGroup& group : pooled.groups) {
    const std::string conditions = columns.of(group.conditions, group.others);
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& value : fit.parameters) {
        text +=
            fmt::format("{},{},{},{},{}\n", conditions, fit.law, fit.protocol, cell(full_name(value)), cells(value));
      }
    }
    for (const PooledValue& value : group.measures) {
      text += fmt::format("{},,,{},{}\n", conditions, value.name, cells(value));
    }
  }
  return text;
}

std::string shared_csv(const Pooled& pooled, std::span<const RunResult> runs) {
  std::string text = "law,name,condition,level,run," + std::string(kValueColumns) + "\n";
  for (const SharedFit& fit : pooled.shared) {
    for (const SharedFit::Parameter& common : fit.common) {
      for (std::size_t l = 0; l < common.values.size(); ++l) {
        text += fmt::format("{},{},{},{},,{}\n", fit.law, cell(common.name), cell(common.condition),
                            cell(common.levels[l]), cells(common.values[l]));
      }
    }
    for (const SharedFit::OfRun& run : fit.runs) {
      for (std::size_t k = 0; k < fit.names.size(); ++k) {
        text += fmt::format("{},{},,,{},{},1,,,{},{},,,,,\n", fit.law, cell(fit.names[k]), cell(runs[run.run].run.name),
                            cell(fit.units[k]), cell(run.value[k]), cell(run.std_error[k]));
      }
    }
  }
  return text;
}

std::string trends_csv(const Trends& trends) {
  std::string text =
      "law,name,unit,condition,condition_unit,runs,slope,std_error,ci95_lower,ci95_upper,p_value,p_corrected\n";
  for (const Trend& t : trends.trends) {
    text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{}\n", t.law, cell(t.parameter), cell(t.unit),
                        cell(t.condition), cell(t.condition_unit), t.runs, cell(t.slope), cell(t.std_error),
                        cell(t.lower95), cell(t.upper95), cell(t.p_value), cell(t.p_corrected));
  }
  return text;
}

Json json_of(const PooledValue& value) {
  return {{"name", value.name},
          {"effect", text_or_null(value.effect)},
          {"unit", value.unit},
          {"runs", value.runs},
          {"mean", number(value.mean)},
          {"mean_std_error", number(value.standard_error_of_mean)},
          {"value", number(value.value)},
          {"std_error", number(value.std_error)},
          {"ci95", {number(value.lower95), number(value.upper95)}},
          {"statistical", number(value.statistical)},
          {"between_runs", number(value.between)},
          {"systematic", number(value.systematic)}};
}

Json list_of(const std::vector<PooledValue>& values) {
  Json list = Json::array();
  for (const PooledValue& value : values) list.push_back(json_of(value));
  return list;
}

Json json_of(const PooledGroup& group, std::span<const RunResult> runs) {
  Json names = Json::array(), fits = Json::array(), others = Json::array();
  for (const std::size_t r : group.runs) names.push_back(runs[r].run.name);
  for (const OtherCondition& other : group.others) others.push_back({{"name", other.name}, {"value", other.value}});
  for (const PooledGroup::OfFit& fit : group.fits) {
    fits.push_back({{"law", fit.law},
                    {"protocol", fit.protocol},
                    {"parameters", list_of(fit.parameters)},
                    {"best_in", fit.best_in}});
  }
  return {{"conditions", conditions_json(group.conditions)},
          {"others", std::move(others)},
          {"runs", std::move(names)},
          {"fits", std::move(fits)},
          {"measures", list_of(group.measures)}};
}

Json json_of(const SharedFit& fit, std::span<const RunResult> runs) {
  Json common = Json::array(), each = Json::array();
  for (const SharedFit::Parameter& parameter : fit.common) {
    common.push_back({{"name", parameter.name},
                      {"condition", text_or_null(parameter.condition)},
                      {"levels", parameter.levels},
                      {"values", list_of(parameter.values)}});
  }
  for (const SharedFit::OfRun& run : fit.runs) {
    Json parameters = Json::array();
    for (std::size_t k = 0; k < fit.names.size(); ++k) {
      parameters.push_back({{"name", fit.names[k]},
                            {"unit", fit.units[k]},
                            {"value", number(run.value[k])},
                            {"std_error", number(run.std_error[k])}});
    }
    each.push_back({{"name", runs[run.run].run.name}, {"parameters", std::move(parameters)}});
  }
  return {{"law", fit.law}, {"common", std::move(common)}, {"runs", std::move(each)}, {"notes", fit.notes}};
}

Json json_of(const Trend& t) {
  return {{"law", t.law},
          {"name", t.parameter},
          {"unit", t.unit},
          {"condition", t.condition},
          {"condition_unit", t.condition_unit},
          {"runs", t.runs},
          {"slope", number(t.slope)},
          {"std_error", number(t.std_error)},
          {"ci95", {number(t.lower95), number(t.upper95)}},
          {"p_value", number(t.p_value)},
          {"p_corrected", number(t.p_corrected)}};
}

std::string pooled_json(const Pooled& pooled, std::span<const RunResult> runs) {
  Json groups = Json::array(), shared = Json::array(), trends = Json::array(), confounded = Json::array();
  for (const PooledGroup& group : pooled.groups) groups.push_back(json_of(group, runs));
  for (const SharedFit& fit : pooled.shared) shared.push_back(json_of(fit, runs));
  for (const Trend& trend : pooled.trends.trends) trends.push_back(json_of(trend));
  for (const Confounded& pair : pooled.trends.confounded) {
    confounded.push_back({{"a", pair.a}, {"b", pair.b}, {"correlation", number(pair.correlation)}});
  }
  return text_of({{"tool", {{"name", "tribofit"}, {"version", version}}},
                  {"groups", std::move(groups)},
                  {"shared", std::move(shared)},
                  {"trends", std::move(trends)},
                  {"confounded", std::move(confounded)},
                  {"warnings", pooled.trends.warnings}});
}

std::string shown(double value, double unit) {
  return std::isfinite(value) ? brief(value / unit) : "-";
}

std::string conditions_text(const PooledGroup& group) {
  std::string text;
  for (const OtherCondition& other : group.others) text += (text.empty() ? "" : ", ") + other.name + " " + other.value;
  return text;
}

std::string interval(const PooledValue& value) {
  if (value.runs == 0) return "-";
  return value.runs == 1 ? with_error(value.value, value.std_error) + " *" : with_error(value.value, value.std_error);
}

std::string repeats_table(const Pooled& pooled, const Style& style, const char* protocol) {
  constexpr std::size_t kMostRows = 40;
  Table table({"mm", "rpm", "N", "other", "runs", "law", "mu_s", "mu_k", "alpha, beta [s/mm]", "best in"},
              {false, false, false, true, false, true});
  std::size_t rows = 0;
  for (const PooledGroup& group : pooled.groups) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      if (fit.protocol != protocol || rows++ >= kMostRows) continue;
      std::vector<std::string> row = {shown(group.conditions.radius.value, kMillimetre),
                                      shown(group.conditions.speed.value, kRpm),
                                      shown(group.conditions.load.value, 1),
                                      conditions_text(group),
                                      std::to_string(group.runs.size()),
                                      fit.law};
      for (std::size_t k = 0; k < 3; ++k) row.push_back(k < fit.parameters.size() ? interval(fit.parameters[k]) : "");
      row.push_back(std::to_string(fit.best_in));
      table.add(std::move(row));
    }
  }
  std::string text = table.text(2, style.bold, style.off);
  if (rows > kMostRows) text += fmt::format("  ... and {} rows more: see pooled.csv\n", rows - kMostRows);
  return text;
}

std::string shared_table(const Pooled& pooled, const Style& style) {
  std::string text;
  for (const SharedFit& fit : pooled.shared) {
    text += style.heading(fmt::format("{} law, parameters that runs have in common", fit.law));
    Table table({"parameter", "over", "runs", "value", "95 % interval", "unit", "between runs"}, {true, true});
    for (const SharedFit::Parameter& common : fit.common) {
      for (std::size_t l = 0; l < common.values.size(); ++l) {
        const PooledValue& v = common.values[l];
        const int places = places_for(v.std_error);
        table.add({common.name, common.condition.empty() ? "all runs" : common.levels[l], std::to_string(v.runs),
                   with_error(v.value, v.std_error),
                   fmt::format("[{}, {}]", fixed(v.lower95, places), fixed(v.upper95, places)), v.unit,
                   std::isfinite(v.between) ? significant(v.between, 2) : "-"});
      }
    }
    text += table.text(2, style.bold, style.off);
    for (const std::string& note : fit.notes) text += "  " + wrapped(note, style.width, 2) + "\n";
  }
  return text;
}

std::string trends_text(const Trends& trends, const Style& style) {
  std::string text;
  for (const std::string& sentence : trend_sentences(trends)) text += "  " + wrapped(sentence, style.width, 4) + "\n";
  if (!text.empty()) text = style.heading("Trends") + text;
  for (const std::string& warning : trends.warnings) {
    text += "  " + std::string(style.yellow) + "warning" + std::string(style.off) + "  " +
            wrapped(warning, style.width, 11) + "\n";
  }
  return text;
}

}  // namespace

std::vector<std::string> trend_sentences(const Trends& trends) {
  std::vector<std::string> out;
  for (const Trend& t : trends.trends) {
    // What goes exactly with a condition before it is named in the warnings.
    const bool said = std::any_of(trends.confounded.begin(), trends.confounded.end(), [&](const Confounded& pair) {
      return pair.b == t.condition && std::abs(pair.correlation) > 0.999;
    });
    if (t.p_corrected > kChance || said) continue;
    const std::string per = t.condition == "order" ? "run" : t.condition_unit;
    const std::string unit = (t.unit == "1" ? "" : " " + t.unit) + (per.empty() ? "" : " per " + per);
    out.push_back(fmt::format("{} ({} law) {} with {}: {}{} (p = {:.2g}, corrected for {} trends)", t.parameter, t.law,
                              t.rises() ? "rises" : "falls", t.condition, with_error(t.slope, t.std_error), unit,
                              t.p_corrected, trends.trends.size()));
  }
  if (out.empty() && !trends.trends.empty()) out.push_back("none that is no chance");
  return out;
}

Pooled pool_campaign(std::span<const RunResult> runs, const Sharing& sharing) {
  Pooled out;
  out.groups = pool_repeats(runs);
  if (!sharing.common.empty()) out.shared = fit_shared(runs, sharing);
  out.trends = find_trends(runs);
  return out;
}

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

std::string pooled_table(const Pooled& pooled, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  if (pooled.groups.empty()) return "";
  std::string text = style.heading("Repeats together (joint protocol; +/- is one standard error, from run to run)");
  text += repeats_table(pooled, style, "joint");
  const bool single = std::any_of(pooled.groups.begin(), pooled.groups.end(),
                                  [](const PooledGroup& group) { return group.runs.size() == 1; });
  if (single) text += "  * one run: what differs from run to run is not in its error\n";
  return text + shared_table(pooled, style) + trends_text(pooled.trends, style);
}

}  // namespace tribofit
