#include "tribofit/study/twin.hpp"

#include <cmath>

#include "fit/assessment.hpp"
#include "json_parts.hpp"
#include "report/charts/motion_charts.hpp"
#include "report_parts.hpp"
#include "tribofit/report/study.hpp"

namespace tribofit {
namespace {

/// Measured and simulated measures, their differences in standard errors, and the root mean square of these.
ReportTable twin_table(const Twin& twin) {
  ReportTable table("Measured motion and its twin");
  table.text({""}).numbers({"measured"});
  std::vector<std::string> total = {"root mean square", ""};
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    table.numbers({twin.short_name(c), "off by"});
    total.insert(total.end(), {"", fixed(twin.rms_difference[c], 1)});
  }
  table.text({"unit"});
  for (const TwinMeasure& m : twin.measures) {
    const bool portrait = &m == &twin.measures.back();  // a distance: nothing is measured
    auto& row = table.rows.emplace_back();
    row = {m.name, portrait ? "" : estimate_text({m.measured, m.measured_std_error}, m.si)};
    for (const TwinMeasure::Simulated& s : m.simulated) {
      row.push_back(portrait ? "" : fixed(s.value / m.si, places_for(s.std_error / m.si)));
      row.push_back(portrait ? fixed(s.difference, 1) : with_sign(s.difference, 1));
    }
    row.push_back(portrait ? "" : m.unit);
  }
  table.rows.push_back(std::move(total));
  return table;
}

/// The numbers of each law and of the rig beside it.
ReportSection twin_model(const TwinIdentification& result) {
  ReportSection section{"model", "Law and rig", {}};
  const std::size_t count = std::min(result.trace.fits.size(), result.rigs.size());
  for (std::size_t c = 0; c < count; ++c) {
    const Fit& fit = result.trace.fits[c];
    std::vector<std::string> parameters;
    for (const FitParameter& p : fit.parameters) {
      parameters.push_back(full_name(p) + " " + value_text(p, result.trace.motion));
    }
    section.item(
        fmt::format("{}: {}: {}", c == 0 ? "Law" : "With effects", fit.model.name(), fmt::join(parameters, ", ")));
    const auto [mass, damping, stiffness, frequency, ratio, by_stick] = shown_rig(result.rigs[c]);
    section.item(fmt::format("Rig beside it: {}, {}, {} {}, {}", mass.text(), stiffness.text(), ratio.name,
                             ratio.text(), frequency.text()));
  }
  return section;
}

Suggestion next_after_twin(const TwinIdentification& result, const std::vector<std::string>& arguments) {
  const auto of_verb = [&](std::vector<std::string> verb) {
    return command_line(words_of(std::move(verb), arguments), {result.trace.path});
  };
  return first_of({{!result.twin.reason.empty(), "to see the trace, its health and its law", of_verb({})},
                   {result.twin.reason.empty() && result.twin.agrees() && !result.law_falls_short(),
                    "to see at which speed stick-slip vanishes", of_verb({"study", "speed"})},
                   {true, "to see where the law fails and which effect explains it", of_verb({"diagnose"})}});
}

/// Whether the twin moves as the record does, and where it does not.
std::string twin_verdict(const TwinIdentification& result) {
  const Twin& twin = result.twin;
  if (!twin.reason.empty()) return "There is no twin: " + twin.reason + ".";
  const std::size_t last = twin.columns.size() - 1;
  const std::string& law = twin.columns[last];
  std::string text;
  if (last > 0 && std::isfinite(twin.rms_difference[0]) && std::isfinite(twin.rms_difference[last])) {
    text = fmt::format("With {} the disagreement falls from {:.1f} to {:.1f} standard errors. ",
                       law.substr(std::min(law.size(), law.find('+') + 2)), twin.rms_difference[0],
                       twin.rms_difference[last]);
  }
  if (!twin.agrees() && !std::isfinite(twin.rms_difference[last])) {
    return text + "The twin does not stick and slip as the record does.";
  }
  if (!twin.agrees()) {
    return text + fmt::format(
                      "The twin of the {} law fails in {} (the worst first): the law, the rig or the record is not as "
                      "assumed.",
                      law, fmt::join(twin.failures(last), ", "));
  }
  text +=
      fmt::format("The twin of the {} law moves as the record does: nothing is off by more than {:g} standard errors.",
                  law, kTwinIsOff);
  if (!result.law_falls_short()) return text;
  return text + fmt::format(
                    " But these are means over cycles: the held-out error of the law is {:.1f} times the noise floor, "
                    "so an effect that changes from cycle to cycle may remain.",
                    over_floor(result.trace.fits.back()));
}

/// Said first where the law leaves clearly more than noise: its twin does not represent the machine.
std::string warning_of(const TwinIdentification& result, const std::vector<std::string>& arguments) {
  if (!result.twin.reason.empty() || !result.law_falls_short()) return "";
  const Fit& fit = result.trace.fits.back();
  return other_machine_warning("the twin does", fit, over_floor(fit),
                               command_line(words_of({"diagnose"}, arguments), {result.trace.path}));
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
  return object("columns", twin.columns, "measures", list_of(twin.measures, measure), "rms_difference",
                list_of(twin.rms_difference, number), "failures", std::move(failures), "simulations", twin.simulations,
                "messages", twin.messages, "reason", text_or_null(twin.reason), "next",
                next_after_twin(result, options.arguments).command);
}

/// Differences in standard errors; within the marks they may be chance.
Chart differences_chart(const Twin& twin) {
  Chart chart = chart_of("twin-differences", "Simulated less measured", {"difference", "standard errors"}, {},
                         fmt::format("Beyond {:g} standard errors a difference is not chance.", kTwinIsOff));
  const std::size_t count = twin.measures.size();  // the first stands on top
  for (std::size_t k = count; k-- > 0;) chart.panels[0].names.push_back(twin.measures[k].name);
  double largest = 4;
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    ChartLine& line = chart.line(twin.short_name(c), marked(c + 1, false));
    line.stroke.size = 8;
    for (std::size_t k = 0; k < count; ++k) {
      const double d = twin.measures[k].simulated.at(c).difference;
      if (!std::isfinite(d)) continue;
      line.add(d, static_cast<double>(count - 1 - k));
      largest = std::max(largest, 1.1 * std::abs(d));
    }
  }
  chart.x.low = -largest, chart.x.high = largest;
  for (const double at : {-kTwinIsOff, 0.0, kTwinIsOff}) {
    chart.marks.push_back(
        {at, true, at == 0 ? Dash::solid : Dash::dashed, at == 0 ? "" : fmt::format("{:+.0f}", at), 0});
  }
  return chart;
}

/// The measured motion and those of the twins over time, as portraits, and alive.
ReportSection motion_section(const Twin& twin, const std::string& unit) {
  ReportSection section{"motion", "Measured and simulated motion", {}};
  const double disc = twin.measured.disc_velocity;
  std::vector<DrawnMotion> motions;
  Animation alive{.id = "twin-block",
                  .title = "The block on its disc",
                  .note = "Three cycles each, from break-away to break-away.",
                  .disc_velocity = disc / kMillimetre};
  const auto add = [&](const std::string& name, const auto& motion) {
    if (motion.size() == 0) return;
    alive.blocks.push_back(drawn_motion(name, motion));
    motions.push_back({alive.blocks.back(), stroke_of(motions.size())});
  };
  add("measured", twin.measured);
  for (std::size_t c = 0; c < twin.simulated.size(); ++c) {
    add("simulated, " + twin.short_name(c), twin.simulated[c]);
  }
  if (motions.empty()) return section;
  Chart chart = motion_chart("twin-motion", "Three cycles, measured and simulated", disc,
                             {unit == "N" ? "friction" : "mu", unit}, motions);
  chart.note =
      "Both begin at a break-away; the simulated cycles are those of one simulation, with numbers drawn within the "
      "errors and a scatter of its own. Shaded: stick as measured.";
  chart.x.quantity = "time since break-away";
  section.add(std::move(chart));
  section.add(portrait_chart("twin-portrait", "Portraits, measured and simulated", disc, motions));
  section.add(std::move(alive));
  return section;
}

}  // namespace

std::string to_json(const TwinIdentification& result, const JsonOptions& options) {
  const Identification& trace = result.trace;
  std::vector<std::string> warnings = trace.warnings;
  const std::string first = warning_of(result, options.arguments);
  if (!first.empty()) warnings.insert(warnings.begin(), first);
  Json json = record_json(trace, options);
  add_members(json, "fits", fits_json(trace.fits, trace.motion), "rig",
              result.rigs.empty() ? Json(nullptr) : rig_json(result.rigs.front()), "rigs",
              list_of(result.rigs, rig_json), "twin", twin_json(result, options), "analysed", trace.analysed,
              "warnings", warnings);
  return text_of(json);
}

Report report_of(const TwinIdentification& result, const ReportOptions& options) {
  const Identification& trace = result.trace;
  const Twin& twin = result.twin;
  Report report = titled_report("twin", file_name(trace.path), twin_verdict(result));
  report.warnings = trace.warnings;
  ReportSection end = result_section(report), first{"first", "", {}, Medium::terminal};
  if (const std::string warning = warning_of(result, options.arguments); !warning.empty()) {
    report.warnings.insert(report.warnings.begin(), warning);
    first.warning(warning);
  }
  report.next = {next_after_twin(result, options.arguments)};
  add_facts(trace, report);
  report.add({std::move(first), record_section(trace)});
  if (twin.reason.empty() && !twin.columns.empty()) {
    ReportSection measures{"measures", "Measures in standard errors", {}};
    measures.add(differences_chart(twin));
    measures.add(twin_table(twin));
    measures.soft(fmt::format(
        "off by: simulated less measured, in standard errors; {} simulations with law and rig drawn within their "
        "errors, at the mean break-away of the record; the phase portrait is a distance of the loops",
        twin.simulations));
    report.add({motion_section(twin, friction_unit(trace.motion)), std::move(measures), twin_model(result)});
  }
  const std::string command = command_line(words_of({"twin"}, options.arguments), options.inputs_or(trace.path));
  report.add({{"health", "Health of the data", {health_table({&trace, 1})}, Medium::page},
              std::move(end),
              run_section(report, command, {&trace, 1})});
  return report;
}

}  // namespace tribofit
