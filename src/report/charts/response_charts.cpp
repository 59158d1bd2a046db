#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"
#include "study_parts.hpp"
#include "styles.hpp"

namespace tribofit {
namespace {

Chart curve_chart(const Response& study) {
  Chart chart;
  chart.id = "response-curve";
  chart.title = "Amplitude that a force of each frequency would give";
  chart.note =
      fmt::format("A(omega) = F/sqrt((k - m omega^2)^2 + (c omega)^2) with F = {} N.", significant(study.force, 4));
  chart.x = {.quantity = "frequency", .unit = "Hz", .logarithmic = true};
  chart.panels[0].axis = {.quantity = "amplitude of the displacement", .unit = "mm", .logarithmic = true};
  chart.lines.push_back({"A(omega)", study.frequency, in_unit(study.amplitude, kMillimetre), stroke_of(0)});
  ChartLine lines{"lines of the settled motion", {}, {}, marked(1, false)};
  const double first = study.frequency.empty() ? 0 : study.frequency.front();
  const double last = study.frequency.empty() ? 0 : study.frequency.back();
  const double least =
      study.amplitude.empty() ? 0 : 0.1 * *std::min_element(study.amplitude.begin(), study.amplitude.end());
  for (const ResponseLine& h : study.harmonics) {
    if (h.frequency < first || h.frequency > last || h.displacement < least) continue;
    lines.x.push_back(h.frequency);
    lines.y.push_back(h.displacement / kMillimetre);
  }
  if (!lines.x.empty()) chart.lines.push_back(std::move(lines));
  if (study.damped_natural_frequency > 0) {
    chart.marks.push_back({study.damped_natural_frequency, true, Dash::dashed,
                           "damped natural " + significant(study.damped_natural_frequency, 3) + " Hz", 0});
  }
  if (!study.harmonics.empty()) {
    chart.marks.push_back({study.settled.frequency, true, Dash::dotted,
                           "response " + significant(study.settled.frequency, 3) + " Hz", 0});
  }
  chart.height = 400;
  return chart;
}

/// Upright lines with a point at their ends.
Chart spectrum_chart(const Response& study, const std::string& id, const std::string& title, const ChartAxis& axis,
                     double ResponseLine::*amplitude, double unit) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x = {.quantity = "frequency", .unit = "Hz", .from_zero = true};
  chart.panels[0].axis = axis;
  chart.panels[0].axis.from_zero = true;
  constexpr double kGap = std::numeric_limits<double>::quiet_NaN();
  ChartLine stems{"lines", {}, {}, {.colour = Colour::blue, .width = 2}}, ends{"amplitude", {}, {}, marked(1, false)};
  ends.stroke.size = 5;
  stems.listed = false;
  for (const ResponseLine& h : study.harmonics) {
    const double y = h.*amplitude / unit;
    stems.x.insert(stems.x.end(), {h.frequency, h.frequency, kGap});
    stems.y.insert(stems.y.end(), {0, y, kGap});
    ends.x.push_back(h.frequency);
    ends.y.push_back(y);
  }
  chart.lines = {std::move(stems), std::move(ends)};
  if (study.damped_natural_frequency > 0) {
    chart.marks.push_back({study.damped_natural_frequency, true, Dash::dashed,
                           "damped natural " + significant(study.damped_natural_frequency, 3) + " Hz", 0});
  }
  chart.half = true;
  return chart;
}

ReportTable harmonics_table(const Response& study) {
  ReportTable table{"Spectra of settled motion",
                    {"harmonic", "frequency [Hz]", "friction [N]", "displacement [mm]", "velocity [mm/s]"},
                    {},
                    {0, 1, 2, 3, 4}};
  for (std::size_t n = 0; n < study.harmonics.size(); ++n) {
    const ResponseLine& h = study.harmonics[n];
    table.rows.push_back({fmt::format("{}", n + 1), significant(h.frequency, 4), significant(h.force, 4),
                          significant(h.displacement / kMillimetre, 4), significant(h.velocity / kMillimetre, 4)});
  }
  table.folded = table.rows.size() > 30;
  return table;
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
