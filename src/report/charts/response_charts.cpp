#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"
#include "report/study_tables.hpp"
#include "study_parts.hpp"
#include "styles.hpp"

namespace tribofit {
namespace {

void mark_natural(const Response& study, Chart& chart) {
  const double f = study.damped_natural_frequency;
  if (!(f > 0)) return;
  chart.marks.push_back({f, true, Dash::dashed, "damped natural " + significant(f, 3) + " Hz", 0});
}

Chart curve_chart(const Response& study) {
  Chart chart{.id = "response-curve",
              .title = "Amplitude that a force of each frequency would give",
              .note = fmt::format("A(omega) = F/sqrt((k - m omega^2)^2 + (c omega)^2) with F = {} N.",
                                  significant(study.force, 4)),
              .x = {.quantity = "frequency", .unit = "Hz", .logarithmic = true},
              .panels = {{.axis = {.quantity = "amplitude of the displacement", .unit = "mm", .logarithmic = true}}},
              .lines = {{"A(omega)", study.frequency, in_unit(study.amplitude, kMillimetre), stroke_of(0)}},
              .height = 400};
  if (study.frequency.empty() || study.amplitude.empty()) return chart;
  const double least = 0.1 * *std::min_element(study.amplitude.begin(), study.amplitude.end());  // else off the paper
  ChartLine lines{.name = "lines of the settled motion", .stroke = marked(1, false)};
  for (const ResponseLine& h : study.harmonics) {
    const bool there = h.frequency >= study.frequency.front() && h.frequency <= study.frequency.back();
    if (there && h.displacement >= least) lines.add(h.frequency, h.displacement / kMillimetre);
  }
  if (!lines.x.empty()) chart.lines.push_back(std::move(lines));
  mark_natural(study, chart);
  if (!study.harmonics.empty()) {
    const double f = study.settled.frequency;
    chart.marks.push_back({f, true, Dash::dotted, "response " + significant(f, 3) + " Hz", 0});
  }
  return chart;
}

/// Upright lines with a point at their ends.
Chart spectrum_chart(const Response& study, const char* id, const char* title, ChartAxis axis,
                     double ResponseLine::*amplitude, double unit) {
  axis.from_zero = true;
  Chart chart{.id = id,
              .title = title,
              .x = {.quantity = "frequency", .unit = "Hz", .from_zero = true},
              .panels = {{std::move(axis)}},
              .half = true};
  ChartLine stems{.name = "lines", .stroke = {.colour = Colour::blue, .width = 2}, .listed = false};
  ChartLine ends{.name = "amplitude", .stroke = dots(Colour::blue, Symbol::square)};
  for (const ResponseLine& h : study.harmonics) {
    stems.add(h.frequency, 0);
    stems.add(h.frequency, h.*amplitude / unit);
    stems.add(h.frequency, std::numeric_limits<double>::quiet_NaN());
    ends.add(h.frequency, h.*amplitude / unit);
  }
  chart.lines = {std::move(stems), std::move(ends)};
  mark_natural(study, chart);
  return chart;
}

}  // namespace

Report report_of(const StudiedMachine& of, const Response& study, const ReportOptions& options) {
  std::string lead =
      fmt::format("Natural frequency {} Hz, damped {} Hz; response frequency {}. {}.",
                  significant(study.natural_frequency, 5), significant(study.damped_natural_frequency, 5),
                  study.harmonics.empty() ? "none: " + std::string(to_string(study.settled.regime))
                                          : significant(study.settled.frequency, 5) + " Hz",
                  response_sentence(of, study));
  Report report = study_report(of, "response", "Response to a force", std::move(lead), options);
  const std::string seen = seen_sentence(study.settled);
  if (!seen.empty()) report.warnings.push_back(seen);
  ReportSection& section = report.sections.emplace_back(ReportSection{"response", "Response and spectra", {}});
  section.items.emplace_back(curve_chart(study));
  if (study.harmonics.empty()) {
    section.items.emplace_back(ReportText{
        fmt::format("There is no settled vibration, so there are no spectra ({}).", to_string(study.settled.regime)),
        ReportText::Kind::soft});
  } else {
    section.items.emplace_back(spectrum_chart(study, "spectrum-force", "Spectrum of the friction force",
                                              {.quantity = "friction force", .unit = "N"}, &ResponseLine::force, 1));
    section.items.emplace_back(spectrum_chart(study, "spectrum-displacement", "Spectrum of the displacement",
                                              {.quantity = "displacement", .unit = "mm"}, &ResponseLine::displacement,
                                              kMillimetre));
    section.items.emplace_back(harmonics_table(study));
  }
  add_machine_sections(of, "response", options, report);
  return report;
}

}  // namespace tribofit
