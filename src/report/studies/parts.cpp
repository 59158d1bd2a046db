#include "parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "tribofit/fit/identification.hpp"

namespace tribofit {

std::string other_machine_warning(std::string_view subject, const Fit& fit, double ratio, const std::string& command) {
  return fmt::format(
      "the {} law leaves {:.1f} times the noise floor of the record: {} not represent this machine until the effect "
      "behind it is found: {}",
      fit.model.name(), ratio, subject, command);
}

namespace {

/// Each kind with its title, and the study that goes on from it.
struct StudyKind {
  const char *key, *title, *purpose;
  std::vector<std::string> next;
};
const StudyKind kKinds[] = {{"speed", "Motion over speed", "to see which number matters", {"sensitivity"}},
                            {"phase", "Phase portraits", "to see the speed at which stick vanishes", {"speed"}},
                            {"response", "Response to a force", "to see portraits of the motion", {"phase"}},
                            {"map", "Map of the motion", "to see the speeds at which stick vanishes", {"speed"}},
                            {"sensitivity",
                             "Which number matters",
                             "to vary two numbers at once",
                             {"map", "--x", "stiffness", "--y", "mass", "--csv", "map/"}}};

/// "mu_s = 0.5090, mu_k = 0.3180, alpha = 0.05214 s/mm".
std::string friction_sentence(const Machine& m) {
  std::vector<std::string> parameters;
  for (std::size_t k = 0; k < m.parameters.size(); ++k) {
    const FrictionModel::Slot& slot = m.model.parameters()[k];
    const Parameter& q = slot.parameter;
    parameters.push_back(
        fmt::format("{} = {}{}", slot.full_name(), significant(m.parameters[k] / q.si, 4), unit_behind(q.unit)));
  }
  return fmt::format("{}", fmt::join(parameters, ", "));
}

ReportTable machine_table(const StudiedMachine& studied) {
  std::vector<ResultParameter> values;
  std::vector<std::string> meanings;
  for (const Variable& v : variables_of(studied.machine)) {
    values.push_back({{value_of(studied.machine, v.name) / v.si, std_error_of(studied, v.name) / v.si, std::nan("")},
                      v.name,
                      v.unit == "1" ? "" : v.unit});
    meanings.push_back(v.meaning);
  }
  ReportTable table = value_table("number", values);
  table.caption = "Numbers of the machine";
  table.add({"meaning"}, std::move(meanings));
  return table;
}

/// The numbers of rig and drive, then the law.
Facts facts_of(const StudiedMachine& studied, const std::string& kind, const ReportOptions& options) {
  Facts facts = {{"machine", studied.source}};
  for (const char* name : {"mass", "stiffness", "damping", "damping-ratio", "load", "radius", "speed", "velocity"}) {
    const Variable v = variable_named(studied.machine, name);
    facts.emplace_back(name == std::string("velocity") ? "omega r" : v.name,
                       significant(value_of(studied.machine, v.name) / v.si, 4) + unit_behind(v.unit));
  }
  facts.emplace_back("natural frequency", significant(studied.machine.natural_hertz(), 4) + " Hz");
  const std::string law = studied.machine.model.name(), sharpness = significant(1e-3 * studied.sharpness, 4);
  facts.emplace_back("law", studied.sharpness > 0
                                ? fmt::format("{}, smoothed by an arctangent of sharpness {} s/mm", law, sharpness)
                                : law);
  facts.emplace_back("friction", friction_sentence(studied.machine));
  facts.emplace_back("study", kind);
  if (studied.record || !options.inputs.empty()) {
    facts.emplace_back("record", studied.record ? studied.record->path : options.inputs.front());
  }
  return facts;
}

Json machine_json(const StudiedMachine& studied) {
  const Machine& m = studied.machine;
  Json parameters = Json::array();
  for (std::size_t k = 0; k < m.parameters.size(); ++k) {
    const FrictionModel::Slot& slot = m.model.parameters()[k];
    parameters.push_back(object("name", slot.parameter.name, "value", m.parameters[k] / slot.parameter.si, "unit",
                                slot.parameter.unit, "effect", text_or_null(slot.effect)));
  }
  return object("source", studied.source, "mass_kg", m.rig.mass, "damping_N_s_per_mm", 1e-3 * m.rig.damping,
                "stiffness_N_per_mm", 1e-3 * m.rig.stiffness, "damping_ratio", m.rig.damping_ratio(), "load_N", m.load,
                "radius_mm", m.radius / kMillimetre, "speed_rpm", m.speed / kRpm, "velocity_mm_s",
                m.disc_velocity() / kMillimetre, "law", to_string(m.model.law()), "effects", m.model.effect_names(),
                "parameters", parameters, "sharpness_s_per_mm", positive_or_null(1e-3 * studied.sharpness), "warnings",
                studied.warnings, "notes", studied.notes);
}

}  // namespace

Report study_report(const StudiedMachine& studied, const char* kind, std::string lead,
                    std::vector<ReportSection> sections, const ReportOptions& options,
                    const std::vector<std::string>& seen) {
  const StudyKind& own = *std::find_if(std::begin(kKinds), std::end(kKinds),
                                       [&](const StudyKind& one) { return one.key == std::string_view(kind); });
  Report report = titled_report("study", own.title, std::move(lead));
  report.warnings = joined(studied.warnings, seen);
  std::erase(report.warnings, "");
  report.facts = facts_of(studied, kind, options);
  report.next = {
      {own.purpose, command_line(words_of(joined({"study"}, own.next), options.shared_arguments), options.inputs)}};
  ReportSection begin{"record", "", {}, Medium::terminal};
  for (const std::string& warning : studied.warnings) begin.warning(warning);
  begin.text(ReportText::Kind::title, fmt::format("{}: {}", studied.source, studied.machine.model.name()));
  begin.add(ReportFacts{report.facts});
  ReportSection machine{"machine", "The machine", {machine_table(studied)}, Medium::page};
  for (const std::string& note : studied.notes) {
    begin.plain(note);
    machine.soft("Note: " + note);
  }
  std::vector<std::string> inputs = options.inputs;
  std::string checksum;
  if (studied.record) {
    inputs = options.inputs_or(studied.record->path);
    checksum = fmt::format(" Checksum of the rows of the record (XXH64): {:016x}.", studied.record->checksum);
  }
  const std::string command = command_line(words_of({"study", kind}, options.arguments), inputs);
  report.add({std::move(begin)});
  report.add(std::move(sections));
  report.add({std::move(machine), run_section(report, command, {}, checksum)});
  return report;
}

std::string study_text(const StudiedMachine& studied, const char* kind, const Json& body, const JsonOptions& options) {
  Json study = object("kind", kind, "machine", machine_json(studied));
  study.update(body);
  return text_of(object("tool", tool_json(options), "study", std::move(study)));
}

Json settled_json(const Settled& settled, const std::string& way) {
  const std::string before = way.empty() ? "" : way + "_";
  Json out;
  out[way.empty() ? "regime" : "regime_" + way] = to_string(settled.regime);
  for (const MeasureInfo& m : measures()) out[before + m.column] = number(settled.*m.value / m.si);
  return out;
}

Json explained_json(const Settled& settled) {
  Json out = settled_json(settled);
  if (!settled.seen.empty()) out["seen"] = settled.seen;
  return out;
}

ReportTable settled_table(const char* caption, const std::vector<const char*>& more) {
  ReportTable table(caption);
  table.columns.push_back({"speed [mm/s]", true, 0, "mm/s"});
  for (const char* name : more) table.text({name});
  table.text({"regime"});
  for (const MeasureInfo& m : measures()) table.columns.push_back({with_unit(m.name, m.unit), true, 0, m.heading});
  return table;
}

std::vector<std::string> row_of(std::vector<std::string> row, const Settled& settled) {
  row.emplace_back(to_string(settled.regime));
  for (const MeasureInfo& measure : measures()) row.push_back(measure_text(settled, measure));
  return row;
}

std::string velocity_text(double velocity, const Machine& machine) {
  return fmt::format("{} mm/s ({} rpm)", significant(velocity / kMillimetre, 4),
                     significant(velocity / machine.radius / kRpm, 4));
}

std::string measure_text(const Settled& settled, const MeasureInfo& measure) {
  return significant(settled.*measure.value / measure.si, 4);
}

std::string seen_sentence(const Settled& settled) {
  return settled.regime == Regime::not_settled ? "did not settle: " + settled.seen : "";
}

}  // namespace tribofit
