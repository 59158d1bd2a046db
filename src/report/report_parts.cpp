#include "report_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "json_parts.hpp"
#include "numbers.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

TerminalOptions terminal_like(const ReportOptions& options) {
  TerminalOptions terminal;
  terminal.arguments = options.arguments;
  terminal.inputs = options.inputs;
  terminal.instruments_declared = options.instruments_declared;
  return terminal;
}

std::string file_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  // Names of files need not be valid UTF-8; reports are.
  return Json::parse(line_of(name.empty() ? path : name)).get<std::string>();
}

void ReportSection::add(ReportItem item) {
  const auto* table = std::get_if<ReportTable>(&item);
  const auto* chart = std::get_if<Chart>(&item);
  const auto has_values = [](const ChartBars& bars) { return !bars.values.empty(); };
  if (table != nullptr && table->rows.empty()) return;
  if (chart != nullptr && chart->lines.empty() && !chart->map &&
      std::none_of(chart->bars.begin(), chart->bars.end(), has_values))
    return;
  items.push_back(std::move(item));
}

void ReportSection::add(std::vector<Chart> charts) {
  for (Chart& chart : charts) add(std::move(chart));
}

void Report::add(std::vector<ReportSection> more) {
  for (ReportSection& section : more) {
    if (!section.items.empty()) sections.push_back(std::move(section));
  }
}

Report titled_report(const std::string& kind, const std::string& title, const std::string& made, std::string lead) {
  Report report;
  report.kind = kind;
  report.title = title;
  report.subtitle =
      fmt::format("{} by tribofit {}; ± is one standard error, everywhere in this report.", made, version);
  report.lead = std::move(lead);
  return report;
}

Facts facts_of(const Identification& r) {
  Facts facts = {{"record", record_sentence(r)}};
  for (auto& fact : condition_facts(r.motion)) facts.push_back(std::move(fact));
  for (auto& fact : stick_slip_facts(r)) facts.push_back(std::move(fact));
  return facts;
}

std::vector<DrawnModel> drawn_models(std::span<const Fit> fits, std::size_t best, std::size_t most,
                                     const std::function<bool(const Fit&)>& wanted) {
  std::vector<DrawnModel> models;
  if (fits.empty()) return models;
  if (has_parameters(fits[best])) models.push_back({curve_name(fits[best]), &fits[best]});
  for (const Fit& fit : fits) {
    if (&fit == &fits[best] || !wanted(fit) || !has_parameters(fit) || models.size() == most) continue;
    models.push_back({curve_name(fit), &fit});
  }
  return models;
}

std::vector<DrawnModel> drawn_curves(const std::vector<DrawnModel>& models, std::span<const Fit> others) {
  std::vector<DrawnModel> curves;
  std::set<std::string> names;
  const auto draw = [&](const Fit& fit) {
    const bool known = has_parameters(fit) && fit.fastest > 0;
    if (known && names.insert(curve_name(fit)).second) curves.push_back({curve_name(fit), &fit});
  };
  for (const DrawnModel& model : models) draw(*model.fit);
  for (const Fit& fit : others) draw(fit);
  return curves;
}

void TraceSections::add_trace(const DrawnTrace& drawn) {
  std::vector<Chart> windows = cycle_charts(drawn);
  if (drawn.trace.motion.size() < 2) return;
  ReportSection& whole = windows.empty() ? trace : cycles;
  trace.add(std::move(windows));
  law.add(law_chart(drawn));
  errors.add(error_charts(drawn));
  cycles.add(measure_charts(drawn));
  whole.add(record_chart(drawn));
}

ReportSection run_section(const std::string& command, const std::string& more) {
  ReportSection section{"run", "What was run", {}};
  section.plain("This report is made by");
  section.command(command);
  section.soft(fmt::format("Made by tribofit {}. Charts by plotly.js (MIT licence).{}", version, more));
  return section;
}

ReportSection run_section(const std::string& command, std::span<const Identification> traces, const Suggestion& next) {
  ReportSection section = run_section(command);
  ReportTable inputs("Input");
  inputs.text({"file"}).numbers({"samples", "duration [s]"}).text({"checksum of the rows (XXH64)"});
  std::vector<std::string> notes;
  for (const Identification& trace : traces) {
    inputs.rows.push_back({trace.path, std::to_string(trace.samples), significant(trace.duration, 4),
                           fmt::format("{:016x}", trace.checksum)});
    notes.insert(notes.end(), trace.notes.begin(), trace.notes.end());
  }
  section.add(std::move(inputs));
  if (!notes.empty()) section.heading("How the input was read");
  for (std::string& note : notes) section.item(std::move(note));
  section.plain("Next, " + next.reason + ":");
  section.command(next.command);
  std::rotate(section.items.begin() + 2, section.items.begin() + 3, section.items.end());  // its maker is said last
  return section;
}

}  // namespace tribofit
