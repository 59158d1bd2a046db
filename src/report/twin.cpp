#include <fmt/format.h>

#include <cmath>

#include "fit/assessment.hpp"
#include "json_parts.hpp"
#include "numbers.hpp"
#include "record_parts.hpp"
#include "report_parts.hpp"
#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/terminal.hpp"
#include "twin_parts.hpp"

namespace tribofit {
namespace {

std::string decimal(double value, const char* format = "{:+.1f}") {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

/// The last column is what the user believes in.
bool agrees(const Twin& twin) {
  return twin.reason.empty() && !twin.columns.empty() && std::isfinite(twin.rms_difference.back()) &&
         twin.failures(twin.columns.size() - 1).empty();
}

/// Means over cycles may agree while the law misses what goes up and down between them.
bool law_falls_short(const TwinIdentification& result) {
  return !result.trace.fits.empty() && well_above_floor(result.trace.fits.back());
}

/// "0.84990 +/- 0.00022 kg, 16.1970 +/- 0.0021 N/mm, damping ratio ..., 21.9712 +/- 0.0025 Hz".
std::string rig_text(const RigFit& rig) {
  const std::string per = rig.per_unit_load ? "/N" : "";
  return fmt::format("{} kg{}, {} N/mm{}, damping ratio {}, {} Hz", with_error(rig.mass.value, rig.mass.std_error), per,
                     with_error(1e-3 * rig.stiffness.value, 1e-3 * rig.stiffness.std_error), per,
                     with_error(rig.damping_ratio.value, rig.damping_ratio.std_error),
                     with_error(rig.natural_frequency.value, rig.natural_frequency.std_error));
}

/// "exponential: mu_s 0.5090 +/- 0.0012, ...".
std::string law_text(const Fit& fit, const Motion& motion) {
  std::string text;
  for (const FitParameter& p : fit.parameters) {
    text += (text.empty() ? "" : ", ") + full_name(p) + " " + value_text(p, motion);
  }
  return fit.model.name() + ": " + text;
}

Json twin_json(const TwinIdentification& result, const JsonOptions& options) {
  const Twin& twin = result.twin;
  const auto measure = [](const TwinMeasure& m) {
    const auto simulated = [&](const TwinMeasure::Simulated& s) {
      return object("value", s.value / m.si, "std_error", s.std_error / m.si, "difference_in_std_errors", s.difference);
    };
    return object("name", m.name, "unit", m.unit, "measured",
                  object("value", m.measured / m.si, "std_error", m.measured_std_error / m.si), "simulated",
                  list_of(m.simulated, simulated));
  };
  Json failures = Json::array();
  for (std::size_t c = 0; c < twin.columns.size(); ++c) failures.push_back(twin.failures(c));
  TerminalOptions known;
  known.arguments = options.arguments;
  return object("columns", twin.columns, "measures", list_of(twin.measures, measure), "rms_difference",
                list_of(twin.rms_difference, number), "failures", std::move(failures), "simulations", twin.simulations,
                "messages", twin.messages, "reason", text_or_null(twin.reason), "next",
                next_after_twin(result, known).command);
}

}  // namespace

std::string column_name(const Twin& twin, std::size_t c) {
  const std::string& name = twin.columns[c];
  const std::size_t plus = name.find(" + ");
  return c == 0 || plus == std::string::npos ? name : name.substr(plus + 1);
}

ReportTable twin_table(const Twin& twin) {
  ReportTable table("Measured motion and its twin");
  table.text({""}).numbers({"measured"});
  std::vector<std::string> total = {"root mean square", ""};
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    table.numbers({column_name(twin, c), "off by"});
    total.insert(total.end(), {"", decimal(twin.rms_difference[c], "{:.1f}")});
  }
  table.text({"unit"});
  for (const TwinMeasure& m : twin.measures) {
    const bool portrait = &m == &twin.measures.back();  // a distance: nothing is measured
    std::vector<std::string> row = {m.name, portrait ? "" : with_error(m.measured / m.si, m.measured_std_error / m.si)};
    for (const TwinMeasure::Simulated& s : m.simulated) {
      row.push_back(portrait ? "" : fixed(s.value / m.si, places_for(s.std_error / m.si)));
      row.push_back(decimal(s.difference, portrait ? "{:.1f}" : "{:+.1f}"));
    }
    row.push_back(portrait ? "" : m.unit);
    table.rows.push_back(std::move(row));
  }
  table.rows.push_back(std::move(total));
  return table;
}

std::string twin_note(const Twin& twin) {
  return fmt::format(
      "off by: simulated less measured, in standard errors; {} simulations with law and rig drawn within their errors, "
      "at the mean break-away of the record; the phase portrait is a distance of the loops",
      twin.simulations);
}

ReportSection twin_model(const TwinIdentification& result) {
  ReportSection section{"model", "Law and rig", {}};
  const std::size_t count = std::min(result.trace.fits.size(), result.rigs.size());
  for (std::size_t c = 0; c < count; ++c) {
    section.items.emplace_back(
        item_text((c == 0 ? "Law: " : "With effects: ") + law_text(result.trace.fits[c], result.trace.motion)));
    section.items.emplace_back(item_text("Rig beside it: " + rig_text(result.rigs[c])));
  }
  return section;
}

Suggestion next_after_twin(const TwinIdentification& result, const TerminalOptions& options) {
  const auto of_verb = [&](std::vector<std::string> verb) {
    return command_line(words_of(std::move(verb), options.arguments), {result.trace.path});
  };
  if (!result.twin.reason.empty()) return {"to see the trace, its health and its law", of_verb({})};
  if (agrees(result.twin) && !law_falls_short(result)) {
    return {"to see at which speed stick-slip vanishes", of_verb({"study", "speed"})};
  }
  return {"to see where the law fails and which effect is missing", of_verb({"diagnose"})};
}

std::string twin_verdict(const TwinIdentification& result) {
  const Twin& twin = result.twin;
  if (!twin.reason.empty()) return "There is no twin: " + twin.reason + ".";
  const std::size_t last = twin.columns.size() - 1;
  const std::string& law = twin.columns[last];
  std::string text;
  if (last > 0 && std::isfinite(twin.rms_difference[0]) && std::isfinite(twin.rms_difference[last])) {
    text = fmt::format("With {} the disagreement goes from {:.1f} to {:.1f} standard errors. ",
                       law.substr(std::min(law.size(), law.find('+') + 2)), twin.rms_difference[0],
                       twin.rms_difference[last]);
  }
  if (agrees(twin)) {
    text += fmt::format(
        "The twin of the {} law moves as the record does: nothing is off by more than three standard errors.", law);
    if (!law_falls_short(result)) return text;
    const Fit& fit = result.trace.fits.back();
    return text + fmt::format(
                      " But these are means over cycles: the held-out error of the law is {:.1f} times the noise "
                      "floor, so an effect is not covered that comes and goes between them.",
                      fit.error.held_out_rmse / fit.floor.rmse);
  }
  if (!std::isfinite(twin.rms_difference[last])) return text + "The twin does not stick and slip as the record does.";
  return text + fmt::format(
                    "The twin of the {} law fails over {} (the worst first): the law, the rig or the record "
                    "holds something else.",
                    law, fmt::join(twin.failures(last), ", "));
}

std::string law_warning(const TwinIdentification& result, const TerminalOptions& options) {
  if (!result.twin.reason.empty() || !law_falls_short(result)) return "";
  const Fit& fit = result.trace.fits.back();
  if (!(over_floor(fit) > 1)) return "";
  return fmt::format(
      "the {} law leaves {:.1f} times the noise floor of the record: its twin is that of another machine until the "
      "missing effect is found: {}",
      fit.model.name(), over_floor(fit), command_line(words_of({"diagnose"}, options.arguments), {result.trace.path}));
}

std::string render_twin(const TwinIdentification& result, const TerminalOptions& options) {
  TerminalText text(options);
  if (const std::string warning = law_warning(result, options); !warning.empty()) text.warning(warning);
  add_record(result.trace, text);
  if (result.twin.reason.empty()) {
    const ReportSection model = twin_model(result);
    text.heading(model.title);
    text.items(model.items);
    const ReportTable table = twin_table(result.twin);
    text.heading(table.caption);
    text.table(table);
    text.line(twin_note(result.twin));
  }
  text.result(result.trace.warnings, twin_verdict(result), next_after_twin(result, options));
  return text.take();
}

std::string to_json(const TwinIdentification& result, const JsonOptions& options) {
  const Identification& trace = result.trace;
  Json json = record_json(trace, options);
  TerminalOptions known;
  known.arguments = options.arguments;
  std::vector<std::string> warnings = trace.warnings;
  if (std::string warning = law_warning(result, known); !warning.empty()) warnings.push_back(std::move(warning));
  add_members(json, "fits", fits_json(trace.fits, trace.motion), "rig",
              result.rigs.empty() ? Json(nullptr) : rig_json(result.rigs.front()), "rigs",
              list_of(result.rigs, rig_json), "twin", twin_json(result, options), "analysed", trace.analysed,
              "warnings", warnings);
  return text_of(json);
}

}  // namespace tribofit
