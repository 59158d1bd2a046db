#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "campaign_parts.hpp"
#include "report/numbers.hpp"
#include "report/report_parts.hpp"
#include "report/study_sentences.hpp"
#include "report/verdict.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kMostRows = 1000, kMostWarnings = 200, kMostPoints = 300;

void add_table(std::string caption, CellRows cells, std::size_t words, ReportSection& section) {
  if (cells.rows.empty()) return;
  ReportTable table{std::move(caption), std::move(cells.header), std::move(cells.rows), {}};
  for (std::size_t k = words; k < table.header.size(); ++k) table.numeric.push_back(k);
  section.items.emplace_back(std::move(table));
}

/// Published values beside ours, and what [D] says in words.
ReportSection comparison_section(const DrawnCampaign& of) {
  ReportSection section{"comparison", "Beside earlier values", {}};
  if (of.comparison != nullptr) {
    add_table("This campaign beside " + of.earlier_name(), comparison_cells(*of.comparison, of.groups()), 3, section);
    for (const std::string& unmatched : of.comparison->values.unmatched) {
      section.items.emplace_back(ReportText{unmatched, ReportText::Kind::soft});
    }
  }
  return section;
}

ReportSection statements_section(const DrawnCampaign& of) {
  ReportSection section{"statements", "Which law predicts better", {}};
  const Statements statements =
      of.comparison != nullptr ? of.comparison->statements : statements_of(of.results, of.runs, of.groups());
  for (const std::string& sentence : preference_sentences(statements, of.groups())) {
    section.items.emplace_back(ReportText{sentence, ReportText::Kind::item});
  }
  add_table("Relative error (Eq 5), slip samples and means in 40 bins of v_r", error_cells(statements, of.groups()), 3,
            section);
  return section;
}

std::vector<std::string> row_of(const PooledValue& v, const std::string& law, const std::string& protocol,
                                const std::string& conditions) {
  const int places = places_for(v.std_error);
  const auto text = [&](double value) { return std::isfinite(value) && value != 0 ? significant(value, 2) : "-"; };
  const bool known = std::isfinite(v.std_error) && v.std_error > 0;
  return {conditions,
          full_name(v),
          law,
          protocol,
          with_error(v.value, v.std_error),
          known ? fmt::format("[{}, {}]", fixed(v.lower95, places), fixed(v.upper95, places)) : "-",
          text(v.statistical),
          text(v.between),
          text(v.systematic),
          std::to_string(v.runs),
          v.unit == "1" ? "" : v.unit};
}

const std::vector<std::string>& pooled_header() {
  static const std::vector<std::string> header = {"conditions", "value",         "law",         "protocol",
                                                  "mean",       "95 % interval", "statistical", "between runs",
                                                  "systematic", "runs",          "unit"};
  return header;
}

ReportTable groups_table(const DrawnCampaign& of) {
  ReportTable table{
      "Repeats together (the mean with one standard error, from run to run)", pooled_header(), {}, {4, 5, 6, 7, 8, 9}};
  for (std::size_t g = 0; g < of.groups().size(); ++g) {
    const PooledGroup& group = of.groups()[g];
    const std::string conditions = of.name_of(g);
    for (const PooledGroup::OfFit& fit : group.fits) {
      for (const PooledValue& v : fit.parameters) table.rows.push_back(row_of(v, fit.law, fit.protocol, conditions));
    }
    for (const PooledValue& v : group.measures) table.rows.push_back(row_of(v, "", "", conditions));
  }
  if (table.rows.size() > kMostRows) {
    table.caption += fmt::format("; the first {} of {} rows, pooled.csv has all", kMostRows, table.rows.size());
    table.rows.resize(kMostRows);
  }
  table.folded = table.rows.size() > 60;
  return table;
}

ReportTable shared_table(const SharedFit& fit) {
  ReportTable table{
      "Parameters that runs have in common, " + fit.law + " law", pooled_header(), {}, {4, 5, 6, 7, 8, 9}};
  for (const SharedFit::Parameter& common : fit.common) {
    for (std::size_t l = 0; l < common.values.size(); ++l) {
      table.rows.push_back(
          row_of(common.values[l], fit.law, "joint", common.condition.empty() ? "all runs" : common.levels[l]));
      table.rows.back()[1] = common.name;
    }
  }
  return table;
}

ReportTable trends_table(const Trends& trends) {
  ReportTable table{"Straight lines over the conditions",
                    {"parameter", "law", "over", "slope", "95 % interval", "unit", "runs", "p", "p, corrected"},
                    {},
                    {3, 4, 6, 7, 8}};
  for (const Trend& t : trends.trends) {
    const int places = places_for(t.std_error);
    const std::string per = t.condition == "order" ? "run" : t.condition_unit;
    table.rows.push_back({t.parameter, t.law, t.condition, with_error(t.slope, t.std_error),
                          fmt::format("[{}, {}]", fixed(t.lower95, places), fixed(t.upper95, places)),
                          t.unit + (per.empty() ? "" : " per " + per), std::to_string(t.runs),
                          significant(t.p_value, 2), significant(t.p_corrected, 2)});
  }
  if (table.rows.size() > kMostRows) table.rows.resize(kMostRows);
  table.folded = table.rows.size() > 20;
  return table;
}

/// A parameter of every run, beside the mean of its group: what repeats scatter by.
Chart scatter_chart(const DrawnCampaign& of, const std::string& law) {
  Chart chart;
  chart.id = "scatter-" + law;
  chart.title = "The parameters of each run, " + law + " law";
  chart.note =
      "Joint protocol; bars: 95 % of the run's own error. Repeats that lie further apart differ from run to run.";
  chart.x = {.quantity = "run", .digits = 7};
  chart.panels.clear();
  for (std::size_t p = 0; chart.panels.size() == p; ++p) {  // as many as the law has
    std::string name, unit;
    for (std::size_t k = 0; k < of.shown.size(); ++k) {
      ChartLine line{
          .name = of.name_of(of.shown[k]), .stroke = marked(k, false), .bars = true, .panel = chart.panels.size()};
      const std::vector<std::size_t>& runs = of.groups()[of.shown[k]].runs;
      for (const std::size_t i : thinned(runs.size(), kMostPoints)) {
        const RunResult& run = of.runs[runs[i]];
        const ResultFit* fit = run.fit(law, "joint");
        if (fit == nullptr || fit->parameters.size() <= p || !fit->parameters[p].effect.empty()) continue;
        const ResultParameter& value = fit->parameters[p];
        name = value.name, unit = value.unit;
        const bool known = std::isfinite(value.lower95) && std::isfinite(value.upper95);
        line.add(static_cast<double>(run.position + 1), value.value);
        line.low.push_back(known ? value.lower95 : value.value);
        line.high.push_back(known ? value.upper95 : value.value);
      }
      if (!line.x.empty()) chart.lines.push_back(std::move(line));
    }
    if (!name.empty()) chart.panels.push_back({.axis = {.quantity = name, .unit = unit}});
  }
  chart.height = 110 + 130 * static_cast<int>(chart.panels.size());
  return chart;
}

std::vector<std::string> laws_of(const DrawnCampaign& of) {
  std::vector<std::string> laws;
  for (const PooledGroup& group : of.groups()) {
    for (const PooledGroup::OfFit& fit : group.fits) {
      if (fit.protocol == "joint" && std::find(laws.begin(), laws.end(), fit.law) == laws.end())
        laws.push_back(fit.law);
    }
  }
  return laws;
}

std::vector<std::string> run_row(const RunResult& r) {
  std::vector<std::string> row = {r.run.name, std::string(to_string(r.run.status)),
                                  conditions_text(r.conditions, r.run.others), std::to_string(r.cycles),
                                  with_error(r.frequency.value, r.frequency.std_error)};
  const ResultFit* best = r.best < r.fits.size() ? &r.fits[r.best] : nullptr;
  row.push_back(best != nullptr ? best->law : "");
  for (std::size_t k = 0; k < 3; ++k) {
    const bool there = best != nullptr && k < best->parameters.size();
    row.push_back(there ? with_error(best->parameters[k].value, best->parameters[k].std_error) : "");
  }
  row.push_back(best != nullptr ? significant(best->held_out_rmse, 3) : "");
  row.push_back(best != nullptr ? significant(best->floor_rmse, 3) : "");
  row.push_back(r.run.message.empty() ? std::to_string(r.warnings.size()) : r.run.message);
  return row;
}

ReportTable runs_table(const DrawnCampaign& of) {
  const std::string unit = of.friction_unit() == "1" ? "" : " [" + of.friction_unit() + "]";
  ReportTable table{fmt::format("{} runs", of.results.size()),
                    {"run", "status", "conditions", "cycles", "frequency [Hz]", "best law", "mu_s" + unit,
                     "mu_k" + unit, "alpha, beta [s/mm]", "held-out RMSE" + unit, "floor" + unit, "warnings"},
                    {},
                    {3, 4, 6, 7, 8, 9, 10}};
  std::size_t next = 0;
  for (std::size_t k = 0; k < of.results.size() && k < kMostRows; ++k) {
    if (next < of.runs.size() && of.runs[next].position == k) {
      table.rows.push_back(run_row(of.runs[next++]));
    } else {
      table.rows.push_back({of.results.missing(k).name, "missing"});
    }
    table.rows.back().resize(table.header.size());
  }
  if (of.results.size() > kMostRows) {
    table.caption += fmt::format("; the first {}, summary.csv has all", kMostRows);
  }
  table.folded = table.rows.size() > 60;
  return table;
}

ReportSection runs_section(const DrawnCampaign& of) {
  ReportSection section{"runs", "The runs", {}};
  for (const std::string& law : laws_of(of)) {
    Chart chart = scatter_chart(of, law);
    if (!chart.lines.empty()) section.items.emplace_back(std::move(chart));
  }
  section.items.emplace_back(runs_table(of));
  ReportTable warnings{"Warnings of the runs", {"run", "warning"}, {}, {}};
  std::size_t count = 0;
  for (const RunResult& r : of.runs) {
    for (const std::string& warning : r.warnings) {
      if (++count <= kMostWarnings) warnings.rows.push_back({r.run.name, warning});
    }
  }
  if (count > kMostWarnings) {
    warnings.caption += fmt::format("; {} of {}, summary.json has all", kMostWarnings, count);
  }
  warnings.folded = count > 20;
  if (count > 0) section.items.emplace_back(std::move(warnings));
  return section;
}

struct Counts {
  std::size_t fitted = 0, failed = 0, missing = 0;
};

Counts counts_of(const DrawnCampaign& of) {
  Counts out;
  for (const RunResult& r : of.runs) (r.run.status == RunStatus::ok ? out.fitted : out.failed) += 1;
  out.missing = of.results.size() - of.runs.size();
  return out;
}

std::string lead_of(const DrawnCampaign& of) {
  const Counts counts = counts_of(of);
  std::string text = fmt::format("{} of {} runs fitted, under {} condition{}.", counts.fitted, of.results.size(),
                                 of.groups().size(), of.groups().size() == 1 ? "" : "s");
  if (of.comparison != nullptr) {
    std::size_t inside = 0, all = 0;
    for (const ComparedValue& v : of.comparison->values.values) {
      if (v.protocol == "published") continue;
      ++all;
      inside += static_cast<std::size_t>(v.inside95);
    }
    if (all > 0) {
      text += fmt::format(" {} of {} values of {} lie in our 95 % intervals.", inside, all, of.earlier_name());
    }
  }
  for (const std::string& trend : trend_sentences(of.pooled.trends)) {
    if (of.pooled.trends.trends.empty() || trend.rfind("none", 0) == 0) continue;
    text += " Trend: " + trend + ".";
    if (text.size() > 300) break;
  }
  return text;
}

void add_sections(const DrawnCampaign& of, Report& report) {
  const auto add = [&](ReportSection section) {
    if (!section.items.empty()) report.sections.push_back(std::move(section));
  };
  add(comparison_section(of));
  add(motion_figures(of));
  add(law_figures(of));
  add(statements_section(of));
  ReportSection pooled{"pooled", "All values", {}};
  if (!of.groups().empty()) pooled.items.emplace_back(groups_table(of));
  for (const SharedFit& fit : of.pooled.shared) {
    pooled.items.emplace_back(shared_table(fit));
    for (const std::string& note : fit.notes) pooled.items.emplace_back(ReportText{note, ReportText::Kind::soft});
  }
  add(std::move(pooled));
  ReportSection trends{"trends", "Trends", {}};
  for (const std::string& sentence : trend_sentences(of.pooled.trends)) {
    trends.items.emplace_back(ReportText{sentence, ReportText::Kind::item});
  }
  if (!of.pooled.trends.trends.empty()) trends.items.emplace_back(trends_table(of.pooled.trends));
  add(std::move(trends));
  add(runs_section(of));
}

}  // namespace

Report report_of(const ResultReader& results, std::span<const RunResult> runs, const Pooled& pooled,
                 const std::optional<ComparisonReport>& comparison, const ReportOptions& options) {
  const DrawnCampaign of = drawn_campaign(results, runs, pooled, comparison);
  const Counts counts = counts_of(of);
  const std::string input = !options.inputs.empty()    ? options.inputs.front()
                            : results.traces().empty() ? results.folder()
                                                       : results.traces();
  Report report;
  report.kind = "campaign";
  report.title = file_name(results.traces().empty() ? results.folder() : results.traces());
  report.subtitle = made_by("Campaign") + "; ± is one standard error, everywhere in this report.";
  report.lead = lead_of(of);
  report.facts = {{"runs", std::to_string(results.size())},
                  {"fitted", std::to_string(counts.fitted)},
                  {"failed", std::to_string(counts.failed)},
                  {"missing", std::to_string(counts.missing)},
                  {"conditions", std::to_string(of.groups().size())}};
  report.warnings = pooled.trends.warnings;
  for (std::size_t k = 0; k < std::min(results.problems().size(), kMostWarnings); ++k) {
    report.warnings.push_back(results.problems()[k]);
  }
  add_sections(of, report);
  ReportSection& run = report.sections.emplace_back(ReportSection{"run", "What was run", {}});
  run.items.emplace_back(plain_text("This report is made by"));
  run.items.emplace_back(ReportText{command_line(terminal_like(options), "", input), ReportText::Kind::command});
  run.items.emplace_back(soft_text(made_by("Made") +
                                   ". Charts by plotly.js (MIT licence). Checksums of the traces stand in the results "
                                   "of the runs."));
  return report;
}

}  // namespace tribofit
