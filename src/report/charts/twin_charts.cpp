#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "motion_charts.hpp"
#include "report/numbers.hpp"
#include "report/report_parts.hpp"
#include "report/twin_parts.hpp"
#include "tribofit/report/report.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kBins = 400;

/// The measured motion and those of the twins, under their names.
std::vector<DrawnMotion> motions_of(const Twin& twin) {
  std::vector<DrawnMotion> out;
  if (twin.measured.size() > 0) out.emplace_back("measured", twin.measured);
  for (std::size_t c = 0; c < twin.simulated.size(); ++c) {
    if (twin.simulated[c].size() > 0) out.emplace_back("simulated, " + column_name(twin, c), twin.simulated[c]);
  }
  return out;
}

Stroke stroke_for(std::size_t k) {
  constexpr Colour kThree[] = {Colour::black, Colour::red, Colour::blue};
  constexpr Dash kThreeDashes[] = {Dash::solid, Dash::dashed, Dash::dotted};
  return {.colour = kThree[k % 3], .dash = kThreeDashes[k % 3], .width = k == 0 ? 1.8 : 1.4};
}

/// Differences in standard errors; within the marks they may be chance.
Chart differences_chart(const Twin& twin) {
  Chart chart;
  chart.id = "twin-differences";
  chart.title = "Simulated less measured";
  chart.note = "Beyond three standard errors a difference is not chance.";
  chart.x = {.quantity = "difference", .unit = "standard errors"};
  ChartAxis& names = chart.panels[0].axis;
  names.falling = true;
  for (const TwinMeasure& m : twin.measures) names.names.push_back(m.name);
  double largest = 4;
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    ChartLine line{column_name(twin, c), {}, {}, marked(c + 1, false)};
    line.stroke.colour = stroke_for(c + 1).colour;
    line.stroke.size = 8;
    for (std::size_t k = 0; k < twin.measures.size(); ++k) {
      const double d = twin.measures[k].simulated.at(c).difference;
      if (!std::isfinite(d)) continue;
      line.add(d, static_cast<double>(k));
      largest = std::max(largest, 1.1 * std::abs(d));
    }
    chart.lines.push_back(std::move(line));
  }
  chart.x.low = -largest, chart.x.high = largest;
  for (const double at : {-3.0, 0.0, 3.0}) {
    chart.marks.push_back(
        {at, true, at == 0 ? Dash::solid : Dash::dashed, at == 0 ? "" : fmt::format("{:+.0f}", at), 0});
  }
  chart.height = 130 + 26 * static_cast<int>(twin.measures.size());
  return chart;
}

Chart motion_chart(const Twin& twin, const std::string& friction_unit) {
  Chart chart{
      .id = "twin-motion",
      .title = "Three cycles, measured and simulated",
      .note =
          "Both begin at a break-away; the simulated cycles are those of one simulation, with numbers drawn within "
          "the errors and a scatter of its own. Shaded: stick as measured.",
      .x = {.quantity = "time since break-away", .unit = "s", .digits = 7},
      .height = 640};
  std::size_t k = 0;
  for (const DrawnMotion& motion : motions_of(twin)) {
    add_over_time(
        motion,
        {{{.quantity = "velocity v_{b}", .unit = "mm/s"}, &DrawnMotion::velocity, kMillimetre},
         {{.quantity = friction_unit == "N" ? "friction" : "mu", .unit = friction_unit}, &DrawnMotion::friction, 1},
         {{.quantity = "displacement", .unit = "mm"}, &DrawnMotion::displacement, kMillimetre}},
        kBins, stroke_for(k++), chart);
  }
  shade_sticks({"measured", twin.measured}, chart);
  if (twin.measured.size() > 0) chart.marks.push_back(disc_mark(twin.measured.disc_velocity));
  return chart;
}

Chart portrait_chart(const Twin& twin) {
  Chart chart = portrait_plane("twin-portrait", "Portraits, measured and simulated", twin.measured.disc_velocity);
  std::size_t k = 0;
  for (const DrawnMotion& motion : motions_of(twin)) add_loop(motion, kBins, stroke_for(k++), chart);
  return chart;
}

Animation animation_of(const Twin& twin) {
  Animation out{.id = "twin-block",
                .title = "The block on its disc",
                .note = "Three cycles each, from break-away to break-away.",
                .disc_velocity = twin.measured.disc_velocity / kMillimetre};
  for (const DrawnMotion& motion : motions_of(twin)) out.blocks.push_back(animated(motion));
  return out;
}

ReportSection how_it_was_run(const TwinIdentification& result, const ReportOptions& options) {
  const std::string path = options.inputs.empty() ? result.trace.path : options.inputs.front();
  return run_section(command_line(words_of({"twin"}, options.arguments), {path}), {&result.trace, 1},
                     next_after_twin(result, terminal_like(options)));
}

}  // namespace

Report report_of(const TwinIdentification& result, const ReportOptions& options) {
  const Identification& trace = result.trace;
  const Twin& twin = result.twin;
  Report report = titled_report("twin", file_name(trace.path),
                                "The measured motion beside those that law and rig predict,", twin_verdict(result));
  report.warnings = trace.warnings;
  if (std::string warning = law_warning(result, terminal_like(options)); !warning.empty())
    report.warnings.insert(report.warnings.begin(), std::move(warning));
  report.facts = facts_of(trace);
  report.facts.emplace_back("simulations of each law", std::to_string(twin.simulations));
  for (std::size_t c = 0; c < twin.columns.size(); ++c) {
    const double rms = twin.rms_difference[c];
    report.facts.emplace_back("off by, " + column_name(twin, c),
                              std::isfinite(rms) ? fmt::format("{:.1f} standard errors", rms) : "-");
  }
  if (twin.reason.empty() && !twin.columns.empty()) {
    ReportSection& motion = report.sections.emplace_back(ReportSection{"motion", "Measured and simulated motion", {}});
    if (!motions_of(twin).empty()) {
      motion.items.emplace_back(motion_chart(twin, friction_unit(trace.motion)));
      motion.items.emplace_back(portrait_chart(twin));
      motion.items.emplace_back(animation_of(twin));
    }
    ReportSection& measures =
        report.sections.emplace_back(ReportSection{"measures", "Measures in standard errors", {}});
    measures.items.emplace_back(differences_chart(twin));
    measures.items.emplace_back(twin_table(twin));
    measures.items.emplace_back(ReportText{twin_note(twin) + ".", ReportText::Kind::soft});
    report.sections.push_back(twin_model(result));
  }
  ReportSection& health = report.sections.emplace_back(ReportSection{"health", "Health of the data", {}});
  health.items.emplace_back(health_table({&trace, 1}));
  report.sections.push_back(how_it_was_run(result, options));
  return report;
}

}  // namespace tribofit
