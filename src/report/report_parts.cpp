#include "report_parts.hpp"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <set>
#include <utility>

#include "report/pictures/text.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/version.hpp"

namespace tribofit {

std::string file_name(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  return one_line(name.empty() ? path : name);
}

void ReportSection::add(ReportItem item, Medium where) {
  item.medium = where;
  if (const auto* text = std::get_if<ReportText>(&item); text != nullptr && text->text.empty()) return;
  if (const auto* facts = std::get_if<ReportFacts>(&item); facts != nullptr && facts->facts.empty()) return;
  if (const auto* table = std::get_if<ReportTable>(&item); table != nullptr && table->rows.empty()) return;
  if (auto* chart = std::get_if<Chart>(&item)) {
    std::erase_if(chart->lines, [](const ChartLine& line) { return line.x.empty(); });
    if (chart->lines.empty() && !chart->map) return;
  }
  items.push_back(std::move(item));
}

void ReportTable::add(ReportColumn column, std::vector<std::string> cells) {
  if (std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); })) return;
  columns.push_back(std::move(column));
  for (std::size_t k = 0; k < rows.size(); ++k) rows[k].push_back(std::move(cells[k]));
}

void ReportSection::add(std::vector<Chart> charts) {
  for (Chart& chart : charts) add(std::move(chart));
}

void Report::add(std::vector<ReportSection> more) {
  for (ReportSection& section : more) {
    if (!section.items.empty()) sections.push_back(std::move(section));
  }
}

void Report::keep_for(Medium medium) {
  const auto elsewhere = [&](const auto& part) { return part.medium != Medium::any && part.medium != medium; };
  std::erase_if(sections, elsewhere);
  for (ReportSection& section : sections) std::erase_if(section.items, elsewhere);
}

Report titled_report(const std::string& kind, const std::string& title, std::string lead) {
  Report report;
  report.kind = kind;
  report.title = title;
  report.subtitle =
      fmt::format("{} by tribofit {}; ± is one standard error, everywhere in this report.", capitalised(kind), version);
  report.lead = std::move(lead);
  return report;
}

DrawnLaws drawn_laws(std::span<const Fit> fits, std::size_t best, std::size_t most,
                     const std::function<bool(const Fit&)>& wanted, std::span<const Fit> others) {
  DrawnLaws drawn;
  for (const Fit& fit : fits) {
    if (!fit.parameters.empty() && (&fit == &fits[best] || wanted(fit))) drawn.models.push_back(&fit);
  }
  const auto is_best = [&](const Fit* fit) { return fit == &fits[best]; };
  std::stable_partition(drawn.models.begin(), drawn.models.end(), is_best);
  drawn.models.resize(std::min(drawn.models.size(), most));
  std::vector<const Fit*> all = drawn.models;
  for (const Fit& fit : others) all.push_back(&fit);
  std::set<std::string> names;
  for (const Fit* fit : all) {
    const bool is_drawn = !fit->parameters.empty() && fit->fastest > 0 && names.insert(curve_name(*fit)).second;
    if (is_drawn) drawn.curves.push_back(fit);
  }
  return drawn;
}

void TraceSections::add_trace(const DrawnTrace& drawn) {
  add_models(drawn);
  add_cycles(drawn);
}

void TraceSections::add_models(const DrawnTrace& drawn) {
  if (drawn.trace.motion.size() < 2) return;
  std::vector<Chart> windows, of_errors;
  Chart of_law;  // it alone evaluates models, whose formulas must not be shared between threads
  const std::function<void()> draw[] = {[&] { of_law = law_chart(drawn); }, [&] { of_errors = error_charts(drawn); },
                                        [&] { windows = cycle_charts(drawn); }};
  run_tasks(std::size(draw), drawn.threads, [&](std::size_t k) { draw[k](); });
  trace.add(std::move(windows));
  law.add(std::move(of_law));
  errors.add(std::move(of_errors));
}

void TraceSections::add_cycles(const DrawnTrace& drawn) {
  if (drawn.trace.motion.is_points() || drawn.trace.motion.size() < 2) return;
  cycles.add(measure_charts(drawn));
}

ReportSection result_section(const Report& report) {
  ReportSection section{"result", "Result", {}, Medium::terminal};
  for (const std::string& warning : report.warnings) section.warning(warning);
  section.plain(report.lead);
  return section;
}

ReportSection run_section(const Report& report, const std::string& command, std::span<const Identification> traces,
                          const std::string& more) {
  ReportSection section{"run", "What was run", {}, Medium::page};
  section.plain("This report is made by");
  section.command(command);
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
  if (!report.next.empty()) {
    section.plain("Next, " + report.next.front().reason + ":");
    section.command(report.next.front().command);
  }
  section.soft(fmt::format("Made by tribofit {}. Charts by plotly.js (MIT licence).{}", version, more));
  return section;
}

}  // namespace tribofit
