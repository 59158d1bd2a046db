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

/// Standard error of a variable of an identified machine [SI]; NaN where none is known.
double std_error_of(const StudiedMachine& of, const std::string& variable) {
  const auto from = [](const std::vector<double>& covariance, std::size_t k) {
    const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(covariance.size()))));
    const bool known = k < n && covariance[k * n + k] > 0;
    return known ? std::sqrt(covariance[k * n + k]) : std::nan("");
  };
  constexpr const char* kRig[] = {"mass", "damping", "stiffness"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (variable == kRig[k]) return from(of.covariance.rig, k);
  }
  const auto& slots = of.machine.model.parameters();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    const std::string name = (slots[k].effect.empty() ? "" : slots[k].effect + ".") + slots[k].parameter.name;
    if (variable == name) return from(of.covariance.friction, k);
  }
  return std::nan("");
}

ReportTable machine_table(const StudiedMachine& of) {
  ReportTable table{"Numbers of the machine", {"number", "value", "std error", "unit", "meaning"}, {}, {1, 2}};
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
  if (of.sharpness > 0) {
    law += fmt::format(", smoothed by an arctangent of sharpness {} s/mm", significant(1e-3 * of.sharpness, 4));
  }
  facts.emplace_back("law", std::move(law));
  facts.emplace_back("friction", machine_sentences(of)[1]);
  return facts;
}

}  // namespace

Report study_report(const StudiedMachine& of, const std::string& kind, const std::string& title, std::string lead,
                    const ReportOptions& options) {
  Report report;
  report.kind = "study";
  report.title = title;
  report.subtitle = made_by("Study") + "; the machine: " + of.source + ".";
  report.lead = std::move(lead);
  report.facts = facts_of(of);
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
  ReportSection& run = report.sections.emplace_back(ReportSection{"run", "What was run", {}});
  std::vector<std::string> inputs = options.inputs;
  if (inputs.empty() && of.record) inputs = {of.record->path};
  run.items.emplace_back(plain_text("This report is made by"));
  run.items.emplace_back(ReportText{study_command(kind, options.arguments, inputs), ReportText::Kind::command});
  std::string made = made_by("Made") + ". Charts by plotly.js (MIT licence).";
  if (of.record) made += fmt::format(" Checksum of the rows of the record (XXH64): {:016x}.", of.record->checksum);
  run.items.emplace_back(soft_text(std::move(made)));
}

ReportTable measures_table(std::string caption, std::vector<std::string> header,
                           const std::vector<std::vector<std::string>>& first,
                           const std::vector<const Settled*>& settled) {
  ReportTable table{std::move(caption), std::move(header), {}, {}};
  for (const MeasureInfo& measure : measures()) {
    table.numeric.push_back(table.header.size());
    table.header.push_back(measure.name + " [" + measure.unit + "]");
  }
  for (std::size_t i = 0; i < settled.size(); ++i) {
    std::vector<std::string> row = first[i];
    for (const MeasureInfo& measure : measures()) row.push_back(measure_text(*settled[i], measure));
    table.rows.push_back(std::move(row));
  }
  return table;
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
