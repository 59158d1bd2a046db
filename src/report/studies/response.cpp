#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "parts.hpp"

namespace tribofit {
namespace {

/// A(omega) at rest and at the natural frequency.
std::string response_sentence(const Response& study) {
  return fmt::format(
      "A(omega) of a force of {} N ({}): {} mm at rest, {} mm at the natural frequency", significant(study.force, 4),
      study.harmonics.empty() ? "half the drop of friction" : "the fundamental of friction",
      significant(study.amplitude_at_rest / kMillimetre, 4), significant(study.amplitude_at_natural / kMillimetre, 4));
}

ReportTable harmonics_table(const Response& study) {
  ReportTable table("Spectra of settled motion", "harmonics.csv (--csv)");
  table.numbers({"harmonic", "frequency [Hz]", "friction [N]", "displacement [mm]", "velocity [mm/s]"});
  for (std::size_t n = 0; n < study.harmonics.size(); ++n) {
    const ResponseLine& h = study.harmonics[n];
    table.rows.push_back({fmt::format("{}", n + 1), significant(h.frequency, 4), significant(h.force, 4),
                          significant(h.displacement / kMillimetre, 4), significant(h.velocity / kMillimetre, 4)});
  }
  return table;
}

Json harmonic_json(const ResponseLine& h) {
  return object("frequency_hz", h.frequency, "force_N", h.force, "displacement_mm", h.displacement / kMillimetre,
                "velocity_mm_s", h.velocity / kMillimetre);
}

void mark_natural(const Response& study, Chart& chart) {
  const double f = study.damped_natural_frequency;
  if (!(f > 0)) return;
  chart.marks.push_back({f, true, Dash::dashed, "damped natural " + significant(f, 3) + " Hz", 0});
}

Chart curve_chart(const Response& study) {
  Chart chart = chart_of(
      "response-curve", "Amplitude that a force of each frequency would give",
      {.quantity = "frequency", .unit = "Hz", .logarithmic = true},
      {.quantity = "amplitude of the displacement", .unit = "mm", .logarithmic = true},
      fmt::format("A(omega) = F/sqrt((k - m omega^2)^2 + (c omega)^2) with F = {} N.", significant(study.force, 4)));
  chart.lines = {{"A(omega)", study.frequency, in_unit(study.amplitude, kMillimetre), stroke_of(0)}};
  if (study.frequency.empty() || study.amplitude.empty()) return chart;
  const double least = 0.1 * *std::min_element(study.amplitude.begin(), study.amplitude.end());  // else off the paper
  ChartLine& lines = chart.line("lines of the settled motion", marked(1, false));
  for (const ResponseLine& h : study.harmonics) {
    const bool there = h.frequency >= study.frequency.front() && h.frequency <= study.frequency.back();
    if (there && h.displacement >= least) lines.add(h.frequency, h.displacement / kMillimetre);
  }
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
  Chart chart = half_chart(id, title, {.quantity = "frequency", .unit = "Hz", .from_zero = true}, std::move(axis));
  ChartLine stems{.name = "amplitude", .stroke = {.colour = Colour::blue, .width = 2}};
  ChartLine ends{.name = "amplitude", .stroke = dots(Colour::blue, Symbol::square)};
  for (const ResponseLine& h : study.harmonics) {
    const double value = h.*amplitude / unit;
    for (const double y : {0.0, value, std::nan("")}) stems.add(h.frequency, y);
    ends.add(h.frequency, value);
  }
  chart.lines = {std::move(stems), std::move(ends)};
  mark_natural(study, chart);
  return chart;
}

}  // namespace

std::string study_json(const StudiedMachine& studied, const Response& study, const JsonOptions& options) {
  Json curve = Json::array();
  for (std::size_t i = 0; i < study.frequency.size(); ++i) {
    curve.push_back(interval_json(study.frequency[i], study.amplitude[i] / kMillimetre));
  }
  return study_text(
      studied, "response",
      object("natural_frequency_hz", study.natural_frequency, "damped_natural_frequency_hz",
             study.damped_natural_frequency, "force_N", study.force, "settled", explained_json(study.settled),
             "harmonics", list_of(study.harmonics, harmonic_json), "curve_hz_mm", curve),
      options);
}

void write_study(const std::string& folder, const Response& study) {
  WholeFolder files(folder);
  write_rows(files, "response.csv", study.frequency.size(), [&](std::size_t i) {
    return object("frequency_hz", study.frequency[i], "displacement_amplitude_mm", 1e3 * study.amplitude[i]);
  });
  write_rows(files, "harmonics.csv", study.harmonics.size(), [&](std::size_t n) {
    Json row = object("harmonic", n + 1);
    row.update(harmonic_json(study.harmonics.empty() ? ResponseLine{} : study.harmonics[n]));
    return row;
  });
  files.commit();
}

Report report_of(const StudiedMachine& studied, const Response& study, const ReportOptions& options) {
  const std::string frequencies =
      fmt::format("natural frequency {} Hz, damped {} Hz; response frequency {}",
                  significant(study.natural_frequency, 5), significant(study.damped_natural_frequency, 5),
                  study.harmonics.empty() ? "none: " + std::string(to_string(study.settled.regime))
                                          : significant(study.settled.frequency, 5) + " Hz");
  const std::string seen = seen_sentence(study.settled);
  ReportSection section{"response", "Response to a force", {}};
  section.plain(frequencies, Medium::terminal);
  section.plain(response_sentence(study) + " (--csv: response.csv)", Medium::terminal);
  section.text(ReportText::Kind::item, seen, Medium::terminal);
  section.add(curve_chart(study));
  if (study.harmonics.empty()) {
    section.soft(
        fmt::format("There is no settled vibration, so there are no spectra ({}).", to_string(study.settled.regime)));
  } else {
    section.add(spectrum_chart(study, "spectrum-force", "Spectrum of the friction force",
                               {.quantity = "friction force", .unit = "N"}, &ResponseLine::force, 1));
    section.add(spectrum_chart(study, "spectrum-displacement", "Spectrum of the displacement",
                               {.quantity = "displacement", .unit = "mm"}, &ResponseLine::displacement, kMillimetre));
  }
  section.add(harmonics_table(study));
  return study_report(studied, "response", capitalised(frequencies) + ". " + response_sentence(study) + ".",
                      {std::move(section)}, options, {seen});
}

}  // namespace tribofit
