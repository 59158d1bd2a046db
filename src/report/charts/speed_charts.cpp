#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"
#include "report/study_tables.hpp"
#include "study_parts.hpp"
#include "styles.hpp"
#include "tribofit/fit/identification.hpp"

namespace tribofit {
namespace {

/// An upright mark at each critical speed; what happens at one speed shares a mark.
void add_critical(const SpeedStudy& study, Chart& chart) {
  constexpr double kSame = 1e-3;
  const std::size_t first = chart.marks.size();
  const auto add = [&](double at, Dash dash, const char* text) {
    if (!std::isfinite(at)) return;
    for (std::size_t k = first; k < chart.marks.size(); ++k) {
      ChartMark& mark = chart.marks[k];
      if (std::abs(mark.at * kMillimetre / at - 1) > kSame) continue;
      mark.text += std::string(", ") + text;
      return;
    }
    chart.marks.push_back({at / kMillimetre, true, dash, text, 0});
  };
  const CriticalSpeed& c = study.critical;
  for (const double v : c.linear) add(v, Dash::dotted, "stability of sliding");
  add(c.stick_vanishes, Dash::dashed, "stick vanishes");
  add(c.stick_returns, Dash::dash_dotted, "stick returns");
}

/// The range of a critical speed on the zero line of a panel, where the curve that it belongs to crosses it.
void add_range(const Range& range, std::size_t panel, Chart& chart) {
  if (!std::isfinite(range.lower95) || !std::isfinite(range.upper95)) return;
  chart.lines.push_back({.name = "95 % range of a critical speed",
                         .x = {range.lower95 / kMillimetre, range.upper95 / kMillimetre},
                         .y = {0, 0},
                         .stroke = {.colour = Colour::purple, .symbol = Symbol::diamond, .width = 4},
                         .panel = panel});
}

void add_sweeps(const SpeedStudy& study, const MeasureInfo& measure, std::size_t panel, Chart& chart) {
  const std::vector<double> velocity = in_unit(study.velocity, kMillimetre);
  const auto add = [&](const char* name, const std::vector<Settled>& settled, std::size_t kind, Dash dash) {
    ChartLine line{.name = name, .x = velocity, .stroke = marked(kind), .panel = panel};
    line.stroke.dash = dash;
    line.stroke.size = 5;
    for (const Settled& s : settled) line.y.push_back(s.*measure.value / measure.si);
    chart.lines.push_back(std::move(line));
  };
  add("begun in stick (way up)", study.up, 1, Dash::solid);
  add("begun in sliding (way down)", study.down, 2, Dash::dashed);
}

/// What the record says at its own speed; nothing where it does not.
void add_measured(const StudiedMachine& of, const MeasureInfo& measure, std::size_t panel, Chart& chart) {
  const Estimate* value = measured_value(of, measure);
  if (value == nullptr) return;
  ChartLine line{.name = "measured", .stroke = dots(Colour::black, Symbol::cross, 9), .bars = true, .panel = panel};
  line.add(of.machine.disc_velocity() / kMillimetre, value->value / measure.si, 1.96 * value->std_error / measure.si);
  chart.lines.push_back(std::move(line));
}

/// Speeds in equal ratios are seen apart on a logarithmic axis.
ChartAxis speed_axis(const SpeedStudy& study) {
  constexpr double kWide = 20;
  const std::vector<double>& v = study.velocity;
  const bool wide = !v.empty() && v.front() > 0 && v.back() > kWide * v.front();
  return {.quantity = "speed of the disc", .unit = "mm/s", .logarithmic = wide};
}

Chart over_speed(const StudiedMachine& of, const SpeedStudy& study, const char* id, const char* title,
                 const std::vector<std::string>& names) {
  Chart chart{.id = id,
              .title = title,
              .x = speed_axis(study),
              .panels = {},
              .height = 150 + 170 * static_cast<int>(names.size())};
  for (const std::string& name : names) {
    const MeasureInfo& measure = measure_named(name);
    const std::size_t panel = chart.panels.size();
    ChartPanel& added = chart.panels.emplace_back();
    added.axis = axis_of(measure);
    added.axis.from_zero = true;
    add_sweeps(study, measure, panel, chart);
    add_measured(of, measure, panel, chart);
    if (name == "frequency") {
      const double natural = of.machine.rig.natural_frequency() / (2 * std::numbers::pi);
      chart.marks.push_back({natural, false, Dash::dotted, "natural frequency", panel});
    }
    if (name == "stick-time") {
      add_range(study.vanishes_range, panel, chart);
      add_range(study.returns_range, panel, chart);
    }
  }
  add_critical(study, chart);
  return chart;
}

Chart growth_chart(const SpeedStudy& study) {
  Chart chart{.id = "growth-rate",
              .title = "Growth of a small vibration about steady sliding",
              .note = "Above zero steady sliding is unstable: a vibration grows until it sticks or is held by the law.",
              .x = speed_axis(study),
              .panels = {{.axis = {.quantity = "growth rate", .unit = "1/s"}}},
              .lines = {{"growth rate", in_unit(study.velocity, kMillimetre), study.growth_rate, stroke_of(0)}}};
  add_range(study.linear_range, 0, chart);
  chart.marks.push_back({0, false, Dash::solid, "", 0});
  add_critical(study, chart);
  return chart;
}

}  // namespace

Report report_of(const StudiedMachine& of, const SpeedStudy& study, const ReportOptions& options) {
  std::string lead;
  for (const std::string& sentence : critical_sentences(of, study)) {
    lead += (lead.empty() ? "" : " ") + capitalised(sentence) + ".";
  }
  const std::string between = bistable_sentence(study.critical);
  if (!between.empty()) lead += " " + between;
  Report report = study_report(of, "speed", "Motion over speed", std::move(lead), options);
  if (study.own.regime == Regime::not_settled) report.warnings.push_back(seen_sentence(study.own));

  ReportSection& section = report.sections.emplace_back(ReportSection{"speed", "Over the speed of the disc", {}});
  Chart motion = over_speed(of, study, "speed-motion", "Frequency, stick and amplitude over speed",
                            {"frequency", "stick-time", "peak-to-peak"});
  motion.note = "Where the two ways differ, both motions go on where they have begun.";
  section.items.emplace_back(std::move(motion));
  section.items.emplace_back(over_speed(
      of, study, "speed-energy", "Energy before break-away and fastest slip over speed", {"energy", "peak-speed"}));
  section.items.emplace_back(growth_chart(study));
  section.items.emplace_back(own_table(of, study));
  constexpr std::size_t kMostRows = 200;
  ReportTable table = speed_table(study, kMostRows);
  table.folded = true;
  section.items.emplace_back(std::move(table));
  add_machine_sections(of, "speed", options, report);
  return report;
}

}  // namespace tribofit
