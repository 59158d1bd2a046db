#include "tribofit/report/comparison.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "campaign_cells.hpp"
#include "csv_cells.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "style.hpp"

namespace tribofit {
namespace {

Json group_json(const PooledGroup& group) {
  Json others = Json::object();
  for (const OtherCondition& other : group.others) others[other.name] = other.value;
  return {{"radius_mm", number(group.conditions.radius.value / kMillimetre)},
          {"speed_rpm", number(group.conditions.speed.value / kRpm)},
          {"load_N", number(group.conditions.load.value)},
          {"others", std::move(others)}};
}

Json value_json(const ComparedValue& v, const PooledGroup& group) {
  return {{"conditions", group_json(group)},
          {"name", v.earlier.name},
          {"law", text_or_null(v.law)},
          {"protocol", text_or_null(v.protocol)},
          {"unit", v.ours.unit},
          {"earlier", number(v.earlier.value)},
          {"earlier_std_error", number(v.earlier.std_error)},
          {"value", number(v.ours.value)},
          {"std_error", number(v.ours.std_error)},
          {"systematic_error", v.ours.systematic > 0 ? number(v.ours.systematic) : Json(nullptr)},
          {"ci95", Json::array({number(v.ours.lower95), number(v.ours.upper95)})},
          {"runs", v.ours.runs},
          {"difference_percent", number(v.percent)},
          {"difference_in_std_errors", number(v.in_std_errors)},
          {"earlier_inside_ci95", v.inside95},
          {"line", v.earlier.line},
          {"column", v.earlier.column}};
}

Json preference_json(const LawPreference& p) {
  if (p.runs == 0) return nullptr;
  return {{"better", p.better},       {"other", p.other},         {"runs", p.runs},
          {"better_in", p.better_in}, {"ratio", number(p.ratio)}, {"p_value", number(p.p_value)}};
}

Json error_json(const ErrorStatement& e, const PooledGroup& group) {
  return {{"conditions", group_json(group)},
          {"law", e.law},
          {"protocol", e.protocol},
          {"runs", e.runs},
          {"share_below_0.08", number(e.below_limit)},
          {"share_of_bins_below_0.08", number(e.bins_below_limit)},
          {"largest_of_bins", number(e.largest_of_bins)},
          {"mean", number(e.mean_relative)},
          {"largest", number(e.max_relative)}};
}

/// Values of one earlier value and law: joint and published protocol side by side.
struct Pair {
  const ComparedValue *first = nullptr, *published = nullptr;
};

std::vector<Pair> pairs_of(const std::vector<ComparedValue>& values) {
  std::vector<Pair> pairs;
  for (const ComparedValue& v : values) {
    const ComparedValue* last = pairs.empty() ? nullptr : pairs.back().first;
    const bool same = last != nullptr && last->group == v.group && last->law == v.law &&
                      last->earlier.line == v.earlier.line && last->earlier.column == v.earlier.column &&
                      last->earlier.name == v.earlier.name;
    if (same && v.protocol == "published" && last->protocol != "published") {
      pairs.back().published = &v;
    } else {
      pairs.push_back({&v, nullptr});
    }
  }
  return pairs;
}

std::string percent_text(double percent) {
  return std::isfinite(percent) ? fmt::format("{:+.2f} %", percent) : "-";
}

std::string signed_text(double value) {
  if (!std::isfinite(value)) return "-";
  return std::abs(value) < 100 ? fmt::format("{:+.1f}", value) : fmt::format("{:+.0f}", value);
}

std::string preference_text(const LawPreference& p) {
  const std::string chance =
      std::isfinite(p.p_value) ? (p.p_value < 1e-4 ? ", p < 0.0001" : fmt::format(", p {:.2g}", p.p_value)) : "";
  return fmt::format("{} in {} of {} run{}; held-out error of {} {:.3f} times as large{}", p.better, p.better_in,
                     p.runs, p.runs == 1 ? "" : "s", p.other, p.ratio, chance);
}

std::string text_of(const CellRows& cells, const Style& style) {
  Table table(cells.header, {true, true, true});
  for (const std::vector<std::string>& row : cells.rows) table.add(row);
  return table.text(2, style.bold, style.off);
}

}  // namespace

CellRows comparison_cells(const ComparisonReport& report, std::span<const PooledGroup> groups) {
  CellRows out{{"conditions", "value", "law", "earlier", "joint fit", "difference", "std errors", "published protocol",
                "difference"},
               {}};
  std::string before;
  for (const Pair& pair : pairs_of(report.values.values)) {
    const ComparedValue& v = *pair.first;
    const bool only_published = v.protocol == "published";
    const ComparedValue* published = only_published ? &v : pair.published;
    const std::string conditions = conditions_text(groups[v.group].conditions, groups[v.group].others);
    const std::string name = v.earlier.name + (v.ours.unit == "1" ? "" : " [" + v.ours.unit + "]");
    std::vector<std::string> row = {conditions == before ? "" : conditions, name, v.law,
                                    with_error(v.earlier.value, v.earlier.std_error)};
    before = conditions;
    row.push_back(only_published ? "" : with_error(v.ours.value, v.ours.std_error));
    row.push_back(only_published ? "" : percent_text(v.percent));
    row.push_back(only_published ? "" : signed_text(v.in_std_errors));
    row.push_back(published != nullptr ? significant(published->ours.value, 4) : "");
    row.push_back(published != nullptr ? percent_text(published->percent) : "");
    out.rows.push_back(std::move(row));
  }
  return out;
}

CellRows error_cells(const Statements& statements, std::span<const PooledGroup> groups) {
  CellRows out{
      {"conditions", "law", "protocol", "samples below 0.08", "mean", "largest", "bins below 0.08", "largest of bins"},
      {}};
  std::string before;
  for (const ErrorStatement& e : statements.errors) {
    const std::string conditions = conditions_text(groups[e.group].conditions, groups[e.group].others);
    out.rows.push_back({conditions == before ? "" : conditions, e.law, e.protocol, share_text(e.below_limit),
                        significant(e.mean_relative, 2), significant(e.max_relative, 2), share_text(e.bins_below_limit),
                        significant(e.largest_of_bins, 2)});
    before = conditions;
  }
  return out;
}

std::vector<std::string> preference_sentences(const Statements& s, std::span<const PooledGroup> groups) {
  std::vector<std::string> out;
  if (s.overall.runs == 0) return out;
  out.push_back("all: " + preference_text(s.overall));
  for (std::size_t g = 0; g < s.preference.size(); ++g) {
    if (s.preference[g].runs == 0) continue;
    out.push_back(conditions_text(groups[g].conditions, groups[g].others) + ": " + preference_text(s.preference[g]));
  }
  return out;
}

std::string comparison_csv(const ComparisonReport& report, std::span<const PooledGroup> groups) {
  std::string text =
      "radius_mm,speed_rpm,load_N,others,name,law,protocol,unit,earlier,earlier_std_error,value,std_error,"
      "systematic_error,lower95,upper95,runs,difference_percent,difference_in_std_errors,earlier_inside_95,line,"
      "column\n";
  for (const ComparedValue& v : report.values.values) {
    const PooledGroup& group = groups[v.group];
    const std::string cells[] = {cell(group.conditions.radius.value / kMillimetre),
                                 cell(group.conditions.speed.value / kRpm),
                                 cell(group.conditions.load.value),
                                 group.others.empty() ? "" : cell(conditions_text({}, group.others)),
                                 v.earlier.name,
                                 v.law,
                                 v.protocol,
                                 v.ours.unit,
                                 cell(v.earlier.value),
                                 cell(v.earlier.std_error),
                                 cell(v.ours.value),
                                 cell(v.ours.std_error),
                                 v.ours.systematic > 0 ? cell(v.ours.systematic) : "",
                                 cell(v.ours.lower95),
                                 cell(v.ours.upper95),
                                 std::to_string(v.ours.runs),
                                 cell(v.percent),
                                 cell(v.in_std_errors),
                                 v.inside95 ? "1" : "0",
                                 std::to_string(v.earlier.line),
                                 cell(v.earlier.column)};
    std::string line;
    for (const std::string& one : cells) line += (&one == &cells[0] ? "" : ",") + one;
    text += line + "\n";
  }
  return text;
}

std::string comparison_json(const ComparisonReport& report, std::span<const PooledGroup> groups) {
  Json values = Json::array(), errors = Json::array(), preference = Json::array();
  for (const ComparedValue& v : report.values.values) values.push_back(value_json(v, groups[v.group]));
  for (const ErrorStatement& e : report.statements.errors) errors.push_back(error_json(e, groups[e.group]));
  for (std::size_t g = 0; g < report.statements.preference.size(); ++g) {
    const LawPreference& p = report.statements.preference[g];
    if (p.runs > 0) preference.push_back({{"conditions", group_json(groups[g])}, {"laws", preference_json(p)}});
  }
  const Json json = {
      {"path", report.values.path},
      {"values", std::move(values)},
      {"unmatched", report.values.unmatched},
      {"relative_error", std::move(errors)},
      {"law_preference",
       {{"overall", preference_json(report.statements.overall)}, {"by_conditions", std::move(preference)}}}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string render_comparison(const ComparisonReport& report, std::span<const PooledGroup> groups,
                              const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = style.heading("Beside " + report.values.path);
  if (!report.values.values.empty()) {
    text += text_of(comparison_cells(report, groups), style);
    text += "  " +
            wrapped(
                "std errors: the difference over the error of ours, statistical, between runs and "
                "systematic, and that of the earlier value where it is stated",
                style.width, 2) +
            "\n";
  }
  for (const std::string& unmatched : report.values.unmatched) text += "  " + wrapped(unmatched, style.width, 4) + "\n";
  const Statements& s = report.statements;
  if (s.overall.runs > 0) {
    text += style.heading("Which law predicts better (joint protocol, held-out cycles)");
    for (const std::string& sentence : preference_sentences(s, groups)) {
      text += "  " + wrapped(sentence, style.width, 4) + "\n";
    }
  }
  if (!s.errors.empty()) {
    text += style.heading("Relative error (Eq 5), slip samples and means in 40 bins of v_r");
    text += text_of(error_cells(s, groups), style);
  }
  return text + "\n";
}

}  // namespace tribofit
