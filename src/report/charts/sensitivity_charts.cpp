#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"
#include "report/study_tables.hpp"
#include "study_parts.hpp"
#include "styles.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kShown = 6;  // sweeps that are not switched off at first

/// A measure over each variable, those that matter most first.
Chart sweep_chart(const std::vector<Sensitivity>& study, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart{.id = "sweep-" + info.name,
              .title = "The " + info.name + " over each number of the machine",
              .x = {.quantity = "value over that of the machine", .unit = "1", .logarithmic = true},
              .panels = {{axis_of(info)}},
              .marks = {{1, true, Dash::dotted, "the machine", 0}},
              .height = 380,
              .half = true};
  std::size_t k = 0;
  for (const std::size_t i : ranked(study, measure)) {
    const Sensitivity& one = study[i];
    if (!(one.base != 0)) continue;
    ChartLine line{one.variable.name, in_unit(one.values, one.base), {}, stroke_of(k)};
    for (const Settled& s : one.settled) line.y.push_back(s.*info.value / info.si);
    line.shown = k++ < kShown;
    chart.lines.push_back(std::move(line));
  }
  return chart;
}

Chart bar_chart(const std::vector<Sensitivity>& study, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart{.id = "elasticity-" + info.name,
              .title = "What moves the " + info.name,
              .x = {.quantity = "change of the " + info.name + " for 1 % of the number", .unit = "%"},
              .half = true};
  ChartAxis& names = chart.panels[0].axis;
  names.falling = true;  // the largest stands on top
  ChartBars bars{info.name, {}};
  for (const std::size_t i : ranked(study, measure)) {
    const double e = study[i].elasticities[measure];
    if (!std::isfinite(e)) continue;
    names.names.push_back(study[i].variable.name);
    bars.values.push_back(e);
  }
  chart.bars.push_back(std::move(bars));
  chart.height = 110 + 26 * static_cast<int>(names.names.size());
  return chart;
}

}  // namespace

Report report_of(const StudiedMachine& of, const std::vector<Sensitivity>& study, const ReportOptions& options) {
  std::string lead;
  for (std::size_t k = 0; k < measures().size(); ++k) {
    const std::vector<std::size_t> order = ranked(study, k);
    if (order.empty() || !std::isfinite(study[order.front()].elasticities[k])) continue;
    lead += fmt::format("{}{} answers most to {} ({} % for 1 %)", lead.empty() ? "" : "; ", measures()[k].name,
                        study[order.front()].variable.name, elasticity_text(study[order.front()].elasticities[k]));
  }
  lead = lead.empty() ? "At this machine no measure has an elasticity." : capitalised(lead) + ".";
  Report report = study_report(of, "sensitivity", "Which number matters", std::move(lead), options);
  ReportSection bars{"elasticities", "Ranked elasticities", {}}, sweeps{"sweeps", "Each measure over each number", {}};
  for (std::size_t k = 0; k < measures().size(); ++k) {
    Chart chart = bar_chart(study, k);
    if (!chart.bars.front().values.empty()) bars.items.emplace_back(std::move(chart));
    sweeps.items.emplace_back(sweep_chart(study, k));
  }
  bars.items.emplace_back(elasticity_table(study));
  report.sections.push_back(std::move(bars));
  report.sections.push_back(std::move(sweeps));
  add_machine_sections(of, "sensitivity", options, report);
  return report;
}

}  // namespace tribofit
