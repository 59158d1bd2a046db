#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "motion_charts.hpp"
#include "report/numbers.hpp"
#include "report/study_sentences.hpp"
#include "report/study_tables.hpp"
#include "study_parts.hpp"
#include "tribofit/fit/identification.hpp"

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

/// What was measured at this speed, if anything.
BlockMotion measured_at(const StudiedMachine& of, const Portrait& portrait) {
  return is_own(of, portrait) ? measured_motion(of) : BlockMotion{};
}

Chart portrait_chart(const StudiedMachine& of, const Portrait& portrait, std::size_t number) {
  Chart chart = portrait_plane(
      fmt::format("phase-{}", number),
      fmt::format("Portrait at {}: {}", speed_text(portrait), to_string(portrait.settled.regime)), portrait.velocity);
  add_loop({"from the start", portrait.start}, kStartBins, {.colour = Colour::grey, .dash = Dash::dotted, .width = 1},
           chart);
  if (portrait.cycle.size() > 0) {
    add_loop({"settled cycle", portrait.cycle}, kCycleBins, {.colour = Colour::black, .width = 2}, chart, true);
  }
  const BlockMotion measured = measured_at(of, portrait);
  if (measured.size() > 0) {
    add_loop({fmt::format("measured, {} cycles", measured.cycles), measured}, kCycleBins,
             {.colour = Colour::red, .dash = Dash::dashed, .width = 1.2}, chart);
  }
  chart.height = 380;
  chart.half = true;
  return chart;
}

Chart all_portraits(const std::vector<const Portrait*>& drawn) {
  Chart chart = portrait_plane("phase-all", "Settled cycles at all speeds", 0);
  chart.marks.clear();
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const Portrait& portrait = *drawn[k];
    if (portrait.cycle.size() == 0) continue;
    add_loop({speed_text(portrait), portrait.cycle}, kCycleBins, stroke_of(k), chart, true);
  }
  return chart;
}

Chart time_chart(const Portrait& portrait, std::size_t number) {
  Chart chart{.id = fmt::format("motion-{}", number),
              .title = "Motion at " + speed_text(portrait) + " over time, from the start",
              .x = {.quantity = "time", .unit = "s", .digits = 7},
              .marks = {disc_mark(portrait.velocity, 1)},
              .height = 520};
  const DrawnMotion motion("motion", portrait.start);
  add_over_time(motion,
                {{{.quantity = "displacement", .unit = "mm"}, &DrawnMotion::displacement, kMillimetre},
                 {{.quantity = "velocity v_{b}", .unit = "mm/s"}, &DrawnMotion::velocity, kMillimetre},
                 {{.quantity = "friction", .unit = "1"}, &DrawnMotion::friction, 1}},
                kStartBins, stroke_of(0), chart);
  shade_sticks(motion, chart);
  return chart;
}

/// The block at one speed, and as it was measured where it was.
Animation animation_of(const StudiedMachine& of, const Portrait& portrait, std::size_t number) {
  Animation out{.id = fmt::format("block-{}", number),
                .title = "The block on its disc at " + speed_text(portrait),
                .disc_velocity = portrait.velocity / kMillimetre};
  const BlockMotion measured = measured_at(of, portrait);
  if (measured.size() > 0) {
    out.blocks.push_back(animated({"measured", measured}));
    out.note = "Measured (three cycles) beside simulated (one settled cycle).";
  }
  out.blocks.push_back(animated({"simulated", portrait.cycle}));
  return out;
}

std::string regimes_sentence(const std::vector<Portrait>& study) {
  std::string text;
  for (const Regime regime : kRegimes) {
    std::vector<double> at;
    for (const Portrait& p : study) {
      if (p.settled.regime == regime) at.push_back(p.velocity / kMillimetre);
    }
    if (at.empty()) continue;
    std::sort(at.begin(), at.end());
    text += (text.empty() ? "" : "; ") + std::string(to_string(regime)) + " at ";
    if (at.size() > 4) {
      text += fmt::format("{} speeds from {} to ", at.size(), significant(at.front(), 4));
      at = {at.back()};
    }
    for (std::size_t k = 0; k < at.size(); ++k) {
      text += (k == 0 ? "" : k + 1 == at.size() ? " and " : ", ") + significant(at[k], 4);
    }
    text += " mm/s";
  }
  return capitalised(text) + ".";
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
