#include "json_parts.hpp"
#include "report_parts.hpp"

namespace tribofit {

std::array<ShownRigValue, 6> shown_rig(const RigFit& rig) {
  const bool per = rig.per_unit_load;
  const char *stiffness = per ? "1/mm" : "N/mm", *damping = per ? "s/mm" : "N s/mm";
  return {{{"mass", rig.mass, 1, per ? "kg/N" : "kg", per ? "mass_kg_per_N" : "mass_kg"},
           {"damping", rig.damping, 1e3, damping, per ? "damping_s_per_mm" : "damping_N_s_per_mm"},
           {"stiffness", rig.stiffness, 1e3, stiffness, per ? "stiffness_per_mm" : "stiffness_N_per_mm"},
           {"natural frequency", rig.natural_frequency, 1, "Hz", "natural_frequency_hz"},
           {"damping ratio", rig.damping_ratio, 1, "1", "damping_ratio"},
           {"stiffness by stick", rig.stick_slope_stiffness, 1e3, stiffness,
            per ? "stick_slope_stiffness_per_mm" : "stick_slope_stiffness_N_per_mm"}}};
}

std::string ShownRigValue::text() const {
  return estimate_text({value.value, value.std_error}, si, unit);
}

namespace {

ReportTable rig_table(const RigFit& rig) {
  std::vector<ResultParameter> values;
  std::vector<std::string> systematic;
  for (const ShownRigValue& q : shown_rig(rig)) {
    const RigValue& v = q.value;
    if (!v.determined) continue;
    values.push_back({{v.value / q.si, v.std_error / q.si, v.lower95 / q.si, v.upper95 / q.si}, q.name, q.unit});
    systematic.push_back(v.systematic > 0 ? significant(v.systematic / q.si, 2) : "");
  }
  ReportTable table = value_table("quantity", values);
  table.add({"systematic", true}, std::move(systematic));
  return table;
}

/// Where the values come from, how they were checked, and what limits them.
Facts behind_rig(const RigFit& rig) {
  Facts facts;
  const bool found = rig.stiffness.determined && rig.mass.determined;
  if (found) {
    facts.emplace_back(
        "from", fmt::format("force balance over {} cycles; its residual is {} {} (RMS of means over {} "
                            "ms)",
                            rig.cycles, significant(rig.residual_rmse, 2), rig.per_unit_load ? "of the load" : "N",
                            significant(rig.smoothing / kMillisecond, 2)));
  }
  if (found && rig.stick_slope_stiffness.determined) {
    facts.emplace_back("check", fmt::format("the stiffness from the force balance is {} standard errors from that by "
                                            "the slope of stick, N (dmu/dt)/(omega r)",
                                            with_sign(rig.stick_slope_difference, 1)));
  }
  for (const std::string& message : rig.messages) facts.emplace_back("note", message);
  return facts;
}

Suggestion next_of(const RigIdentification& result, const ReportOptions& options) {
  const Motion& motion = result.trace.motion;
  const auto of_verb = [&](std::vector<std::string> verb, const std::vector<std::string>& more = {}) {
    return command_line(joined(words_of(std::move(verb), options.arguments, {"--keep-high-pass"}), more),
                        {result.trace.path});
  };
  const bool sticks = result.trace.segmentation.kind == MotionKind::stick_slip;
  const bool kept = motion.high_pass == 0 && motion.size() > 0 && has_option(options.arguments, "--keep-high-pass");
  std::vector<std::string> radius;
  if (!motion.conditions.radius.known()) radius = {"--radius", "15mm"};
  return first_of(
      {{sticks && kept, "to undo the high-pass", of_verb({"rig"})},
       {!result.rig.determined, "to see the trace, its health and its law", of_verb({})},
       {!sticks, "to see where its law fails and which effect explains it", of_verb({"diagnose"})},
       {true, "to put the motion that law and rig predict beside the measured one", of_verb({"twin"}, radius)}});
}

std::string verdict_on(const RigFit& rig) {
  if (!rig.determined) return "The rig could not be identified: " + rig.reason + ".";
  const auto [mass, damping, stiffness, frequency, ratio, by_stick] = shown_rig(rig);
  const auto text_of = [](const ShownRigValue& q, int digits) {
    return significant(q.value.value / q.si, digits) + unit_behind(q.unit);
  };
  return fmt::format("The block is {} on {}; its natural frequency is {}, its damping ratio {}.{}", text_of(mass, 3),
                     text_of(stiffness, 3), text_of(frequency, 3), text_of(ratio, 2),
                     rig.damping_doubtful ? " Do not rely on the damping: a note says why." : "");
}

Json value_json(const RigValue& v, double si) {
  if (!v.determined) return nullptr;
  return object("value", v.value / si, "std_error", v.std_error / si, "ci95",
                interval_json(v.lower95 / si, v.upper95 / si), "systematic_error", positive_or_null(v.systematic / si));
}

}  // namespace

Json rig_json(const RigFit& rig) {
  Json json = object("determined", rig.determined, "reason", text_or_null(rig.reason), "per_unit_load",
                     rig.per_unit_load, "cycles", rig.cycles);
  const auto values = shown_rig(rig);
  for (const ShownRigValue& q : values) json[q.key] = value_json(q.value, q.si);
  Json rows = Json::array();
  for (std::size_t i = 0; i < 3 && rig.mass.determined; ++i) {
    Json& row = rows.emplace_back(Json::array());
    for (std::size_t j = 0; j < 3; ++j) row.push_back(number(rig.covariance[3 * i + j] / values[i].si / values[j].si));
  }
  const bool checked = rig.stick_slope_stiffness.determined && rig.mass.determined;
  add_members(json, "covariance", std::move(rows), "stick_slope_difference_in_std_errors",
              checked ? number(rig.stick_slope_difference) : Json(nullptr), "mass_below_declared",
              rig.mass_below_declared, "mass_below_kg", value_json(rig.mass_below, 1), "damping_doubtful",
              rig.damping_doubtful, "delay_ms", value_json(rig.delay, kMillisecond), "high_pass_hz",
              value_json(rig.high_pass, 1), rig.per_unit_load ? "residual_rmse" : "residual_rmse_N", rig.residual_rmse,
              "smoothing_ms", rig.smoothing / kMillisecond, "degrees_of_freedom", rig.degrees_of_freedom, "messages",
              rig.messages);
  return json;
}

Report report_of(const RigIdentification& result, const ReportOptions& options) {
  const Identification& trace = result.trace;
  const RigFit& rig = result.rig;
  Report report = titled_report("rig", file_name(trace.path), verdict_on(rig));
  report.warnings = trace.warnings;
  report.next = {next_of(result, options)};
  add_facts(trace, report);
  ReportSection values{"rig", "Rig", {}};
  values.add(rig_table(rig));
  values.add(ReportFacts{behind_rig(rig)});
  TraceSections sections;
  if (options.charts) sections.add_trace(DrawnTrace(trace, {}, "t1"));
  sections.trace.title = "The record";
  sections.trace.add(health_table({&trace, 1}), Medium::page);
  const std::string command = command_line(words_of({"rig"}, options.arguments), options.inputs_or(trace.path));
  report.add({record_section(trace), std::move(values), std::move(sections.trace), std::move(sections.cycles),
              result_section(report), run_section(report, command, {&trace, 1})});
  return report;
}

std::string to_json(const RigIdentification& result, const JsonOptions& options) {
  Json json = record_json(result.trace, options);
  add_members(json, "rig", rig_json(result.rig), "analysed", result.trace.analysed, "warnings", result.trace.warnings);
  return text_of(json);
}

}  // namespace tribofit
