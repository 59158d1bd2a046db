#include "report_parts.hpp"

#include <fmt/format.h>

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

ReportText plain_text(std::string text) {
  return {std::move(text), ReportText::Kind::plain};
}

ReportText soft_text(std::string text) {
  return {std::move(text), ReportText::Kind::soft};
}

ReportText heading_text(std::string text) {
  return {std::move(text), ReportText::Kind::heading};
}

ReportText item_text(std::string text) {
  return {std::move(text), ReportText::Kind::item};
}

ReportText command_text(std::string text) {
  return {std::move(text), ReportText::Kind::command};
}

void add(std::vector<Chart> charts, ReportSection& section) {
  for (Chart& chart : charts) section.items.emplace_back(std::move(chart));
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
  const bool has_cycles = !windows.empty();
  if (drawn.trace.motion.size() < 2) return;
  if (!has_cycles) windows.push_back(record_chart(drawn));
  add(std::move(windows), trace);
  add(law_charts(drawn), law);
  add(error_charts(drawn), errors);
  add(measure_charts(drawn), cycles);
  if (has_cycles) cycles.items.emplace_back(record_chart(drawn));
}

void TraceSections::move_into(Report& report) {
  for (ReportSection* section : {&trace, &law, &errors, &cycles}) {
    if (!section->items.empty()) report.sections.push_back(std::move(*section));
  }
}

ReportSection run_section(const std::string& command, const std::string& more) {
  const std::string made = fmt::format("Made by tribofit {}. Charts by plotly.js (MIT licence).", version);
  return {"run",
          "What was run",
          {plain_text("This report is made by"), command_text(command),
           soft_text(more.empty() ? made : made + " " + more)}};
}

ReportSection run_section(const std::string& command, std::span<const Identification> traces, const Suggestion& next) {
  ReportSection section = run_section(command);
  const ReportItem made = std::move(section.items.back());
  section.items.pop_back();
  ReportTable inputs("Input");
  inputs.text({"file"}).numbers({"samples", "duration [s]"}).text({"checksum of the rows (XXH64)"});
  std::vector<std::string> notes;
  for (const Identification& trace : traces) {
    inputs.rows.push_back({trace.path, std::to_string(trace.samples), significant(trace.duration, 4),
                           fmt::format("{:016x}", trace.checksum)});
    notes.insert(notes.end(), trace.notes.begin(), trace.notes.end());
  }
  section.items.emplace_back(std::move(inputs));
  if (!notes.empty()) section.items.emplace_back(heading_text("How the input was read"));
  for (std::string& note : notes) section.items.emplace_back(item_text(std::move(note)));
  section.items.emplace_back(plain_text("Next, " + next.reason + ":"));
  section.items.emplace_back(command_text(next.command));
  section.items.push_back(made);
  return section;
}

}  // namespace tribofit
