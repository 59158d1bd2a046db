#include "study_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "report/numbers.hpp"
#include "report/report_parts.hpp"
#include "report/study_sentences.hpp"
#include "tribofit/fit/identification.hpp"

namespace tribofit {
namespace {

ReportTable machine_table(const StudiedMachine& of) {
  ReportTable table("Numbers of the machine");
  table.text({"number"}).numbers({"value", "std error"}).text({"unit", "meaning"});
  for (const Variable& v : variables_of(of.machine)) {
    const double value = value_of(of.machine, v.name) / v.si, error = std_error_of(of, v.name) / v.si;
    const bool known = std::isfinite(error);
    table.rows.push_back({v.name, known ? fixed(value, places_for(error)) : significant(value, 5),
                          known ? fixed(error, places_for(error)) : "-", v.unit == "1" ? "" : v.unit, v.meaning});
  }
  return table;
}

/// The numbers of rig and drive, then the law.
std::vector<std::pair<std::string, std::string>> facts_of(const StudiedMachine& of) {
  std::vector<std::pair<std::string, std::string>> facts;
  for (const char* name : {"mass", "stiffness", "damping-ratio", "load", "radius", "speed", "velocity"}) {
    const Variable v = variable_named(of.machine, name);
    facts.emplace_back(name == std::string("velocity") ? "omega r" : v.name,
                       significant(value_of(of.machine, v.name) / v.si, 4) + (v.unit == "1" ? "" : " " + v.unit));
  }
  const double natural = of.machine.rig.natural_frequency() / (2 * std::numbers::pi);
  facts.emplace_back("natural frequency", significant(natural, 4) + " Hz");
  std::string law = of.machine.model.name();
  if (of.sharpness > 0) law += ", " + sharpness_text(of);
  facts.emplace_back("law", std::move(law));
  facts.emplace_back("friction", machine_sentences(of)[1]);
  return facts;
}

}  // namespace

Report study_report(const StudiedMachine& of, const std::string& kind, const std::string& title, std::string lead,
                    const ReportOptions& options) {
  Report report = titled_report("study", title, "Study", std::move(lead));
  report.warnings = of.warnings;
  report.facts.emplace_back("machine", of.source);
  for (auto& fact : facts_of(of)) report.facts.push_back(std::move(fact));
  report.facts.emplace_back("study", kind);
  if (!options.inputs.empty() || of.record) {
    report.facts.emplace_back("record", of.record ? of.record->path : options.inputs.front());
  }
  return report;
}

void add_machine_sections(const StudiedMachine& of, const std::string& kind, const ReportOptions& options,
                          Report& report) {
  ReportSection& machine = report.sections.emplace_back(ReportSection{"machine", "The machine", {}});
  machine.items.emplace_back(machine_table(of));
  for (const std::string& note : of.notes) machine.items.emplace_back(soft_text("Note: " + note));
  std::vector<std::string> inputs = options.inputs;
  if (inputs.empty() && of.record) inputs = {of.record->path};
  report.sections.push_back(run_section(
      command_line(words_of({"study", kind}, options.arguments), inputs),
      of.record ? fmt::format("Checksum of the rows of the record (XXH64): {:016x}.", of.record->checksum) : ""));
}

ChartAxis axis_of(const MeasureInfo& measure) {
  return {.quantity = measure.name, .unit = measure.unit};
}

BlockMotion measured_motion(const StudiedMachine& of) {
  if (!of.record) return {};
  return block_motion(of.record->motion, of.record->segmentation, of.machine.load / of.machine.rig.stiffness);
}

std::vector<double> in_unit(std::span<const double> values, double unit) {
  std::vector<double> out(values.begin(), values.end());
  for (double& value : out) value /= unit;
  return out;
}

}  // namespace tribofit
