#include "tribofit/report/twin.hpp"

#include <fmt/format.h>

#include <cmath>

#include "json_parts.hpp"
#include "numbers.hpp"
#include "style.hpp"
#include "terminal_parts.hpp"
#include "tribofit/study/twin.hpp"
#include "twin_sentences.hpp"
#include "verdict.hpp"

namespace tribofit {
namespace {

std::string difference(double d) {
  return std::isfinite(d) ? fmt::format("{:+.1f}", d) : "-";
}

/// The last column is what the user believes in.
bool agrees(const Twin& twin) {
  return twin.reason.empty() && !twin.columns.empty() && std::isfinite(twin.rms_difference.back()) &&
         twin.failures(twin.columns.size() - 1).empty();
}

/// Means over cycles may agree while the law misses what goes up and down between them: its error is well above the
/// floor.
bool law_falls_short(const TwinIdentification& result) {
  constexpr double kWell = 1.25;
  if (result.trace.fits.empty()) return false;
  const Fit& fit = result.trace.fits.back();
  return fit.error.held_out_rmse > kWell * fit.floor.rmse;
}

std::string table_of(const Twin& twin, const Style& style) {
  const std::vector<std::vector<std::string>> cells = twin_cells(twin);
  std::vector<bool> left(cells.front().size(), false);
  left.front() = left.back() = true;
  Table table(cells.front(), left);
  for (std::size_t k = 1; k < cells.size(); ++k) table.add(cells[k]);
  return table.text(2, style.dim, style.off);
}

Json twin_json(const TwinIdentification& result, const JsonOptions& options) {
  const Twin& twin = result.twin;
  Json measures = Json::array(), rms = Json::array(), failures = Json::array();
  for (const TwinMeasure& m : twin.measures) {
    Json simulated = Json::array();
    for (const TwinMeasure::Simulated& s : m.simulated) {
      simulated.push_back({{"value", number(s.value / m.si)},
                           {"std_error", number(s.std_error / m.si)},
                           {"difference_in_std_errors", number(s.difference)}});
    }
    measures.push_back(
        {{"name", m.name},
         {"unit", m.unit},
         {"measured", {{"value", number(m.measured / m.si)}, {"std_error", number(m.measured_std_error / m.si)}}},
         {"simulated", std::move(simulated)}});
  }
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    rms.push_back(number(twin.rms_difference[c]));
    failures.push_back(twin.failures(c));
  }
  TerminalOptions known;
  known.arguments = options.arguments;
  return {{"columns", twin.columns},
          {"measures", std::move(measures)},
          {"rms_difference", std::move(rms)},
          {"failures", std::move(failures)},
          {"simulations", twin.simulations},
          {"messages", twin.messages},
          {"reason", text_or_null(twin.reason)},
          {"next", next_after_twin(result, known).command}};
}

}  // namespace

/// The bare law by its name, the one with effects by what is added.
std::string column_name(const Twin& twin, std::size_t c) {
  const std::string& name = twin.columns[c];
  const std::size_t plus = name.find(" + ");
  return c == 0 || plus == std::string::npos ? name : name.substr(plus + 1);
}

std::vector<std::vector<std::string>> twin_cells(const Twin& twin) {
  std::vector<std::vector<std::string>> rows(1, {"", "measured"});
  std::vector<std::string> total = {"root mean square", ""};
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    rows[0].insert(rows[0].end(), {column_name(twin, c), "off by"});
    total.insert(total.end(),
                 {"", std::isfinite(twin.rms_difference[c]) ? fmt::format("{:.1f}", twin.rms_difference[c]) : "-"});
  }
  rows[0].push_back("unit");
  for (std::size_t k = 0; k < twin.measures.size(); ++k) {
    const TwinMeasure& m = twin.measures[k];
    const bool portrait = k + 1 == twin.measures.size();
    std::vector<std::string> row = {m.name, portrait ? "" : with_error(m.measured / m.si, m.measured_std_error / m.si)};
    for (const TwinMeasure::Simulated& s : m.simulated) {
      const bool known = std::isfinite(s.value) && !portrait;
      row.push_back(known ? fixed(s.value / m.si, places_for(s.std_error / m.si)) : portrait ? "" : "-");
      row.push_back(portrait && std::isfinite(s.difference) ? fmt::format("{:.1f}", s.difference)
                                                            : difference(s.difference));
    }
    row.push_back(portrait ? "" : m.unit);
    rows.push_back(std::move(row));
  }
  total.push_back("");
  rows.push_back(std::move(total));
  return rows;
}

std::string twin_note(const Twin& twin) {
  return fmt::format(
      "off by: simulated less measured, in standard errors; {} simulations with law and rig drawn within their errors, "
      "at the mean break-away of the record; the phase portrait is a distance of the loops",
      twin.simulations);
}

std::string rig_sentence(const RigFit& rig) {
  const std::string per = rig.per_unit_load ? "/N" : "";
  return fmt::format("{} kg{}, {} N/mm{}, damping ratio {}, {} Hz", with_error(rig.mass.value, rig.mass.std_error), per,
                     with_error(1e-3 * rig.stiffness.value, 1e-3 * rig.stiffness.std_error), per,
                     with_error(rig.damping_ratio.value, rig.damping_ratio.std_error),
                     with_error(rig.natural_frequency.value, rig.natural_frequency.std_error));
}

std::string law_sentence(const Fit& fit, const Motion& motion) {
  std::string text = fit.model.name() + ":";
  for (const FitParameter& p : fit.parameters) {
    const std::string unit = shown_unit(p, motion);
    text += fmt::format("{} {}{} {}{}", &p == &fit.parameters.front() ? "" : ",",
                        p.effect.empty() ? "" : p.effect + ".", p.parameter.name,
                        with_error(shown(p, p.value), shown(p, p.std_error)), unit == "1" ? "" : " " + unit);
  }
  return text;
}

Suggestion next_after_twin(const TwinIdentification& result, const TerminalOptions& options) {
  const auto of_verb = [&](std::vector<std::string> words) {
    TerminalOptions known = options;
    known.arguments.insert(known.arguments.begin(), words.begin(), words.end());
    return command_line(known, "", result.trace.path);
  };
  if (!result.twin.reason.empty()) return {"to see the trace, its health and its law", of_verb({})};
  if (agrees(result.twin) && !law_falls_short(result))
    return {"to see at which speed stick-slip vanishes", of_verb({"study", "speed"})};
  return {"to see where the law fails and which effect is missing", of_verb({"diagnose"})};
}

std::string twin_verdict(const TwinIdentification& result) {
  const Twin& twin = result.twin;
  if (!twin.reason.empty()) return "There is no twin: " + twin.reason + ".";
  const std::size_t last = twin.columns.size() - 1;
  std::string text;
  if (last > 0 && std::isfinite(twin.rms_difference[0]) && std::isfinite(twin.rms_difference[last])) {
    text = fmt::format("With {} the disagreement goes from {:.1f} to {:.1f} standard errors. ",
                       twin.columns[last].substr(std::min(twin.columns[last].size(), twin.columns[last].find('+') + 2)),
                       twin.rms_difference[0], twin.rms_difference[last]);
  }
  if (agrees(twin)) {
    text += fmt::format(
        "The twin of the {} law moves as the record does: nothing is off by more than three standard errors.",
        twin.columns[last]);
    if (!law_falls_short(result)) return text;
    const Fit& fit = result.trace.fits.back();
    return text + fmt::format(
                      " But these are means over cycles: on data it has not seen the law leaves {:.1f} times the error "
                      "of the floor, so that something is missing that comes and goes between them.",
                      fit.error.held_out_rmse / fit.floor.rmse);
  }
  if (!std::isfinite(twin.rms_difference[last])) return text + "The twin does not stick and slip as the record does.";
  std::string names;
  for (const std::string& name : twin.failures(last)) names += (names.empty() ? "" : ", ") + name;
  return text + fmt::format(
                    "The twin of the {} law fails over {} (the worst first): the law, the rig or the record holds "
                    "something else.",
                    twin.columns[last], names);
}

std::string render_twin(const TwinIdentification& result, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  const Identification& trace = result.trace;
  std::string text = trace_lines(trace, style) + condition_lines(trace, style) + health_lines(trace, style);
  const Twin& twin = result.twin;
  if (twin.reason.empty()) {
    text += style.heading("Law and rig");
    for (std::size_t c = 0; c < trace.fits.size(); ++c) {
      text += item(style, c == 0 ? "law" : "with effects", law_sentence(trace.fits[c], trace.motion));
      text += item(style, "rig", rig_sentence(result.rigs[c]));
    }
    text += style.heading("Measured motion and its twin");
    text += table_of(twin, style);
    text += "  " + wrapped(twin_note(twin), style.width, 2) + "\n";
  }
  text += style.heading("Result");
  for (const std::string& warning : trace.warnings) {
    text += fmt::format("  {}warning{} ", style.yellow, style.off) + wrapped(warning, style.width, 10) + "\n";
  }
  text += "  " + wrapped(twin_verdict(result), style.width, 2) + "\n";
  const Suggestion next = next_after_twin(result, options);
  text += "\n" + wrapped("Next, " + next.reason + ":", style.width, 0) + "\n" +
          folded_command(next.command, style.width) + "\n";
  return text;
}

std::string to_json(const TwinIdentification& result, const JsonOptions& options) {
  const Identification& trace = result.trace;
  Json rigs = Json::array();
  for (const RigFit& rig : result.rigs) rigs.push_back(rig_json(rig));
  return text_of({{"tool", tool_json(options)},
                  {"trace", trace_json(trace)},
                  {"conditions", conditions_of(trace.motion)},
                  {"health", health_json(trace.motion)},
                  {"stick_slip", stick_slip_json(trace)},
                  {"fits", fits_json(trace.fits, trace.motion)},
                  {"rig", result.rigs.empty() ? Json(nullptr) : rig_json(result.rigs.front())},
                  {"rigs", std::move(rigs)},
                  {"twin", twin_json(result, options)},
                  {"analysed", trace.analysed},
                  {"warnings", trace.warnings}});
}

}  // namespace tribofit
