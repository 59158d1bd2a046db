#include "tribofit/report/rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "json_parts.hpp"
#include "numbers.hpp"
#include "style.hpp"
#include "terminal_parts.hpp"
#include "tribofit/fit/identification.hpp"
#include "verdict.hpp"

namespace tribofit {
namespace {

/// A quantity of the rig, in the unit people read.
struct Shown {
  const char* name;
  RigValue value;
  double si;         // of one unit
  const char* unit;  // as a table shows it
  const char* key;   // as JSON names it
};

std::array<Shown, 6> shown_values(const RigFit& rig) {
  const bool per = rig.per_unit_load;
  return {{{"mass", rig.mass, 1, per ? "kg/N" : "kg", per ? "mass_kg_per_N" : "mass_kg"},
           {"damping", rig.damping, 1e3, per ? "s/mm" : "N s/mm", per ? "damping_s_per_mm" : "damping_N_s_per_mm"},
           {"stiffness", rig.stiffness, 1e3, per ? "1/mm" : "N/mm", per ? "stiffness_per_mm" : "stiffness_N_per_mm"},
           {"natural frequency", rig.natural_frequency, 1, "Hz", "natural_frequency_hz"},
           {"damping ratio", rig.damping_ratio, 1, "1", "damping_ratio"},
           {"stiffness by stick", rig.stick_slope_stiffness, 1e3, per ? "1/mm" : "N/mm",
            per ? "stick_slope_stiffness_per_mm" : "stick_slope_stiffness_N_per_mm"}}};
}

std::string table_of(const RigFit& rig, const Style& style) {
  Table table({"quantity", "value", "std error", "", "95 % interval", "unit", ""},
              {true, false, false, false, false, true, true});
  for (const Shown& q : shown_values(rig)) {
    const RigValue& v = q.value;
    if (!v.determined) continue;
    const int places = places_for(v.std_error / q.si);
    const std::string remark =
        v.systematic > 0 ? fmt::format("+/- {} systematic", significant(v.systematic / q.si, 2)) : "";
    table.add({q.name, fixed(v.value / q.si, places), fixed(v.std_error / q.si, places),
               v.value != 0 ? "(" + percent(v.std_error / std::abs(v.value)) + ")" : "",
               fmt::format("[{}, {}]", fixed(v.lower95 / q.si, places), fixed(v.upper95 / q.si, places)), q.unit,
               remark});
  }
  return table.empty() ? "" : table.text(2, style.dim, style.off);
}

std::string rig_lines(const RigFit& rig, const Style& style) {
  const std::string table = table_of(rig, style);
  if (table.empty() && rig.messages.empty()) return "";
  std::string text = style.heading("Rig") + table;
  if (rig.stiffness.determined && rig.mass.determined) {
    std::string from = fmt::format("force balance over {} cycles, leaves {} {} in {} ms means", rig.cycles,
                                   significant(rig.residual_rmse, 2), rig.per_unit_load ? "of the load" : "N",
                                   significant(rig.smoothing / kMillisecond, 2));
    text += item(style, "from", from);
    if (rig.stick_slope_stiffness.determined) {
      text += item(style, "check",
                   fmt::format("the balance's stiffness is {:+.1f} standard errors from that by the slope of stick, "
                               "N (dmu/dt)/(omega r)",
                               rig.stick_slope_difference));
    }
  }
  for (const std::string& message : rig.messages) text += item(style, "note", message);
  return text;
}

Suggestion next_of(const RigIdentification& result, const TerminalOptions& options) {
  const Identification& trace = result.trace;
  const auto of_verb = [&](const std::string& verb, const std::string& more) {
    TerminalOptions known = options;
    std::erase(known.arguments, "--keep-high-pass");
    if (!verb.empty()) known.arguments.insert(known.arguments.begin(), verb);
    return command_line(known, more, trace.path);
  };
  if (trace.segmentation.kind == MotionKind::stick_slip && trace.motion.high_pass == 0 && trace.motion.size() > 0 &&
      std::find(options.arguments.begin(), options.arguments.end(), "--keep-high-pass") != options.arguments.end()) {
    return {"to undo the high-pass", of_verb("rig", "")};
  }
  if (!result.rig.determined) return {"to see the trace, its health and its law", of_verb("", "")};
  if (trace.segmentation.kind != MotionKind::stick_slip) {
    return {"to see where its law fails and which effect is missing", of_verb("diagnose", "")};
  }
  const bool placed = trace.motion.conditions.radius.known();
  return {"to lay the motion that law and rig predict beside the measured one",
          of_verb("twin", placed ? "" : "--radius 15mm")};
}

std::string verdict_on(const RigFit& rig) {
  std::string text = fmt::format("The block is {} {} on {} {}; it swings at {} Hz and loses by a damping ratio of {}.",
                                 significant(rig.mass.value, 3), rig.per_unit_load ? "kg/N" : "kg",
                                 significant(1e-3 * rig.stiffness.value, 3), rig.per_unit_load ? "1/mm" : "N/mm",
                                 significant(rig.natural_frequency.value, 3), significant(rig.damping_ratio.value, 2));
  if (rig.damping_doubtful) text += " Do not rely on the damping: a note says what is in its way.";
  return text;
}

Json value_json(const RigValue& v, double si) {
  if (!v.determined) return nullptr;
  return {{"value", number(v.value / si)},
          {"std_error", number(v.std_error / si)},
          {"ci95", Json::array({number(v.lower95 / si), number(v.upper95 / si)})},
          {"systematic_error", v.systematic > 0 ? number(v.systematic / si) : Json(nullptr)}};
}

}  // namespace

Json rig_json(const RigFit& rig) {
  Json json = {{"determined", rig.determined},
               {"reason", text_or_null(rig.reason)},
               {"per_unit_load", rig.per_unit_load},
               {"cycles", rig.cycles}};
  const auto values = shown_values(rig);
  for (const Shown& q : values) json[q.key] = value_json(q.value, q.si);
  Json rows = Json::array();
  for (std::size_t i = 0; i < 3 && rig.mass.determined; ++i) {
    Json row = Json::array();
    for (std::size_t j = 0; j < 3; ++j) row.push_back(number(rig.covariance[3 * i + j] / values[i].si / values[j].si));
    rows.push_back(std::move(row));
  }
  json["covariance"] = std::move(rows);
  json["stick_slope_difference_in_std_errors"] =
      rig.stick_slope_stiffness.determined && rig.mass.determined ? number(rig.stick_slope_difference) : Json(nullptr);
  json["mass_below_declared"] = rig.mass_below_declared;
  json["mass_below_kg"] = value_json(rig.mass_below, 1);
  json["damping_doubtful"] = rig.damping_doubtful;
  json["delay_ms"] = value_json(rig.delay, kMillisecond);
  json["high_pass_hz"] = value_json(rig.high_pass, 1);
  json[rig.per_unit_load ? "residual_rmse" : "residual_rmse_N"] = number(rig.residual_rmse);
  json["smoothing_ms"] = number(rig.smoothing / kMillisecond);
  json["degrees_of_freedom"] = number(rig.degrees_of_freedom);
  json["messages"] = rig.messages;
  return json;
}

std::string render_rig(const RigIdentification& result, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  const Identification& trace = result.trace;
  std::string text = trace_lines(trace, style) + condition_lines(trace, style) + health_lines(trace, style);
  text += rig_lines(result.rig, style);
  text += style.heading("Result");
  for (const std::string& warning : trace.warnings) {
    text += fmt::format("  {}warning{} ", style.yellow, style.off) + wrapped(warning, style.width, 10) + "\n";
  }
  const RigFit& rig = result.rig;
  const std::string verdict = rig.determined ? verdict_on(rig) : "The rig could not be identified: " + rig.reason + ".";
  text += "  " + wrapped(verdict, style.width, 2) + "\n";
  const Suggestion next = next_of(result, options);
  text += "\n" + wrapped("Next, " + next.reason + ":", style.width, 0) + "\n  " + next.command + "\n";
  return text;
}

std::string to_json(const RigIdentification& result, const JsonOptions& options) {
  const Identification& trace = result.trace;
  return text_of({{"tool", tool_json(options)},
                  {"trace", trace_json(trace)},
                  {"conditions", conditions_of(trace.motion)},
                  {"health", health_json(trace.motion)},
                  {"stick_slip", stick_slip_json(trace)},
                  {"rig", rig_json(result.rig)},
                  {"analysed", trace.analysed},
                  {"warnings", trace.warnings}});
}

}  // namespace tribofit
