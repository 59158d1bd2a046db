#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "report/study_sentences.hpp"
#include "study_parts.hpp"
#include "styles.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawn = 8;  // portraits
constexpr std::size_t kStartBins = 400, kCycleBins = 300;

std::string speed_text(const Portrait& portrait) {
  return significant(portrait.velocity / kMillimetre, 4) + " mm/s";
}

/// Whether this portrait is made at the speed of the machine, at which there may be a record.
bool is_own(const StudiedMachine& of, const Portrait& portrait) {
  constexpr double kSame = 1e-3;
  return std::abs(portrait.velocity / of.machine.disc_velocity() - 1) < kSame;
}

/// motion: simulated or measured, in the plane of displacement and velocity.
template <class AnyMotion>
void add_loop(const std::string& name, const AnyMotion& motion, std::size_t bins, const Stroke& stroke, Chart& chart) {
  const std::vector<std::size_t> kept = kept_samples({motion.displacement, motion.velocity}, motion.sticks, bins);
  chart.lines.push_back(
      {name, picked(motion.displacement, kept, kMillimetre), picked(motion.velocity, kept, kMillimetre), stroke});
}

/// A settled cycle, closed by the sample it began with.
void add_cycle(const std::string& name, const SimulatedMotion& cycle, const Stroke& stroke, Chart& chart) {
  add_loop(name, cycle, kCycleBins, stroke, chart);
  ChartLine& line = chart.lines.back();
  line.x.push_back(line.x.front());
  line.y.push_back(line.y.front());
}

Chart plane(const std::string& id, const std::string& title) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x = {.quantity = "displacement of the block", .unit = "mm"};
  chart.panels[0].axis = {.quantity = "velocity of the block", .unit = "mm/s"};
  return chart;
}

Chart portrait_chart(const StudiedMachine& of, const Portrait& portrait, std::size_t number) {
  Chart chart = plane(fmt::format("phase-{}", number),
                      fmt::format("Portrait at {}: {}", speed_text(portrait), to_string(portrait.settled.regime)));
  const Stroke start = {.colour = Colour::grey, .dash = Dash::dotted, .width = 1};
  add_loop("from the start", portrait.start, kStartBins, start, chart);
  if (portrait.cycle.size() > 0) {
    add_cycle("settled cycle", portrait.cycle, {.colour = Colour::black, .width = 2}, chart);
  }
  if (is_own(of, portrait)) {
    const BlockMotion measured = measured_motion(of);
    if (measured.size() > 0) {
      add_loop(fmt::format("measured, {} cycles", measured.cycles), measured, kCycleBins,
               {.colour = Colour::red, .dash = Dash::dashed, .width = 1.2}, chart);
    }
  }
  chart.marks.push_back({portrait.velocity / kMillimetre, false, Dash::dash_dotted, "speed of the disc", 0});
  chart.height = 380;
  chart.half = true;
  return chart;
}

Chart all_portraits(const std::vector<const Portrait*>& drawn) {
  Chart chart = plane("phase-all", "Settled cycles at all speeds");
  std::size_t k = 0;
  for (const Portrait* portrait : drawn) {
    const Stroke stroke = stroke_of(k++);
    if (portrait->cycle.size() == 0) continue;
    add_cycle(speed_text(*portrait), portrait->cycle, stroke, chart);
  }
  chart.height = 420;
  return chart;
}

std::vector<Stretch> sticks_of(const SimulatedMotion& motion) {
  std::vector<Stretch> out;
  constexpr std::size_t kMost = 60;
  for (std::size_t i = 0; i < motion.size() && out.size() < kMost;) {
    std::size_t end = i;
    while (end < motion.size() && motion.sticks[end] == motion.sticks[i]) ++end;
    if (motion.sticks[i] != 0) {
      out.push_back({motion.time[i], motion.time[std::min(end, motion.size() - 1)], Shade::stick});
    }
    i = end;
  }
  return out;
}

Chart time_chart(const Portrait& portrait, std::size_t number) {
  Chart chart;
  chart.id = fmt::format("motion-{}", number);
  chart.title = "Motion at " + speed_text(portrait) + " over time, from the start";
  chart.x = {.quantity = "time", .unit = "s", .digits = 7};
  chart.panels = {{.axis = {.quantity = "displacement", .unit = "mm"}},
                  {.axis = {.quantity = "velocity v_{b}", .unit = "mm/s"}},
                  {.axis = {.quantity = "friction", .unit = "1"}}};
  const SimulatedMotion& m = portrait.start;
  const std::vector<std::size_t> kept = kept_samples({m.displacement, m.velocity, m.friction}, m.sticks, kStartBins);
  const std::vector<double> time = picked(m.time, kept, 1);
  const auto add = [&](const char* name, const std::vector<double>& channel, double unit, std::size_t panel) {
    ChartLine line{name, time, picked(channel, kept, unit), stroke_of(0)};
    line.panel = panel;
    line.listed = false;
    chart.lines.push_back(std::move(line));
  };
  add("displacement", m.displacement, kMillimetre, 0);
  add("velocity", m.velocity, kMillimetre, 1);
  add("friction", m.friction, 1, 2);
  chart.marks.push_back({portrait.velocity / kMillimetre, false, Dash::dash_dotted, "speed of the disc", 1});
  chart.stretches = sticks_of(m);
  chart.height = 520;
  return chart;
}

/// The block at one speed, and as it was measured where it was.
Animation animation_of(const StudiedMachine& of, const Portrait& portrait, std::size_t number) {
  Animation out;
  out.id = fmt::format("block-{}", number);
  out.title = "The block on its disc at " + speed_text(portrait);
  out.disc_velocity = portrait.velocity / kMillimetre;
  const BlockMotion measured = is_own(of, portrait) ? measured_motion(of) : BlockMotion{};
  if (measured.size() > 0) {
    out.blocks.push_back(
        animated("measured", measured.time, measured.displacement, measured.friction, measured.sticks));
    out.note = "Measured (three cycles) beside simulated (one settled cycle).";
  }
  const SimulatedMotion& m = portrait.cycle;
  out.blocks.push_back(animated("simulated", m.time, m.displacement, m.friction, m.sticks));
  return out;
}

ReportTable portraits_table(const std::vector<Portrait>& study) {
  std::vector<std::vector<std::string>> first;
  std::vector<const Settled*> settled;
  for (const Portrait& portrait : study) {
    first.push_back({significant(portrait.velocity / kMillimetre, 4), std::string(to_string(portrait.settled.regime))});
    settled.push_back(&portrait.settled);
  }
  ReportTable table = measures_table("Measures of the settled motions", {"speed [mm/s]", "regime"}, first, settled);
  table.numeric.insert(table.numeric.begin(), 0);
  return table;
}

std::string regimes_sentence(const std::vector<Portrait>& study) {
  std::string text;
  for (const Regime regime : {Regime::stick_slip, Regime::vibration, Regime::sliding, Regime::not_settled}) {
    std::vector<double> at;
    for (const Portrait& p : study) {
      if (p.settled.regime == regime) at.push_back(p.velocity / kMillimetre);
    }
    if (at.empty()) continue;
    std::sort(at.begin(), at.end());
    text += (text.empty() ? "" : "; ") + std::string(to_string(regime)) + " at ";
    text += at.size() > 4 ? fmt::format("{} speeds from {} to {} mm/s", at.size(), significant(at.front(), 4),
                                        significant(at.back(), 4))
                          : "";
    for (std::size_t k = 0; k < at.size() && at.size() <= 4; ++k) {
      text += (k == 0 ? "" : k + 1 == at.size() ? " and " : ", ") + significant(at[k], 4);
    }
    if (at.size() <= 4) text += " mm/s";
  }
  if (!text.empty() && text[0] >= 'a') text[0] = static_cast<char>(text[0] - 32);
  return text + ".";
}

}  // namespace

Report report_of(const StudiedMachine& of, const std::vector<Portrait>& study, const ReportOptions& options) {
  Report report = study_report(of, "phase", "Phase portraits", regimes_sentence(study), options);
  for (const Portrait& portrait : study) {
    const std::string seen = seen_sentence(portrait.settled);
    if (!seen.empty()) report.warnings.push_back(speed_text(portrait) + ": " + seen);
  }
  std::vector<const Portrait*> drawn;
  for (const std::size_t i : thinned(study.size(), kDrawn)) drawn.push_back(&study[i]);

  ReportSection portraits{"phase", "Displacement and velocity", {}};
  ReportSection times{"time", "Over time", {}}, moving{"block", "The block in motion", {}};
  if (drawn.size() < study.size()) {
    portraits.items.emplace_back(
        ReportText{fmt::format("{} of {} speeds are drawn; the table has all.", drawn.size(), study.size()),
                   ReportText::Kind::soft});
  }
  if (drawn.size() > 1) portraits.items.emplace_back(all_portraits(drawn));
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    portraits.items.emplace_back(portrait_chart(of, *drawn[k], k + 1));
    times.items.emplace_back(time_chart(*drawn[k], k + 1));
    if (drawn[k]->cycle.size() > 0) moving.items.emplace_back(animation_of(of, *drawn[k], k + 1));
  }
  portraits.items.emplace_back(portraits_table(study));
  report.sections.push_back(std::move(portraits));
  if (!moving.items.empty()) report.sections.push_back(std::move(moving));
  report.sections.push_back(std::move(times));
  add_machine_sections(of, "phase", options, report);
  return report;
}

}  // namespace tribofit
