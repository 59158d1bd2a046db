#include <fmt/format.h>

#include <algorithm>

#include "parts.hpp"
#include "report/charts/motion_charts.hpp"
#include "tribofit/study/block_motion.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kDrawn = 8;  // portraits

std::string speed_text(const Portrait& portrait) {
  return significant(portrait.velocity / kMillimetre, 4) + " mm/s";
}

Chart all_portraits(const std::vector<Portrait>& study, const std::vector<std::size_t>& drawn) {
  std::vector<DrawnMotion> motions;
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    const Portrait& portrait = study[drawn[k]];
    if (portrait.cycle.size() == 0) continue;
    motions.push_back({drawn_motion(speed_text(portrait), portrait.cycle), stroke_of(k), true});
  }
  return portrait_chart("phase-all", "Settled cycles at all speeds", 0, motions);
}

/// A motion as a portrait, over time, and alive, with what was measured at that speed.
void add_motion(const StudiedMachine& studied, const Portrait& portrait, std::size_t number, ReportSection& portraits,
                ReportSection& times, ReportSection& moving) {
  const std::string at = speed_text(portrait);
  const Animation::Block start = drawn_motion("from the start", portrait.start);
  std::vector<DrawnMotion> motions = {{start, {.colour = Colour::grey, .dash = Dash::dotted, .width = 1}}};
  Animation alive{.id = fmt::format("block-{}", number),
                  .title = "The block on its disc at " + at,
                  .disc_velocity = portrait.velocity / kMillimetre};
  const BlockMotion measured = measured_motion(studied, portrait.velocity);
  if (measured.size() > 0) {
    alive.blocks = {drawn_motion(fmt::format("measured, {} cycles", measured.cycles), measured)};
    motions.push_back({alive.blocks[0], {.colour = Colour::red, .dash = Dash::dashed, .width = 1.2}});
  }
  if (portrait.cycle.size() > 0) {
    alive.blocks.push_back(drawn_motion("settled cycle", portrait.cycle));
    motions.push_back({alive.blocks.back(), {.colour = Colour::black, .width = 2}, true});
    moving.add(std::move(alive));
  }
  Chart chart = portrait_chart(fmt::format("phase-{}", number),
                               fmt::format("Portrait at {}: {}", at, to_string(portrait.settled.regime)),
                               portrait.velocity, motions);
  chart.half = true;
  portraits.add(std::move(chart));
  times.add(motion_chart(fmt::format("motion-{}", number), "Motion at " + at + " over time, from the start",
                         portrait.velocity, {"friction", "1"}, {{start, stroke_of(0)}}));
}

/// "Stick-slip at 2, 6 and 10 mm/s; sliding at 500 mm/s."
std::string regimes_sentence(const std::vector<Portrait>& study) {
  std::vector<std::string> texts;
  for (const Regime regime : kRegimes) {
    std::vector<double> at;
    for (const Portrait& p : study) {
      if (p.settled.regime == regime) at.push_back(p.velocity / kMillimetre);
    }
    if (at.empty()) continue;
    std::sort(at.begin(), at.end());
    std::vector<std::string> speeds;
    for (const double speed : at) speeds.push_back(significant(speed, 4));
    texts.push_back(fmt::format("{} at {} mm/s", to_string(regime),
                                at.size() > 4
                                    ? fmt::format("{} speeds from {} to {}", at.size(), speeds.front(), speeds.back())
                                    : enumerated(speeds)));
  }
  return capitalised(fmt::format("{}.", fmt::join(texts, "; ")));
}

Json motion_json(const SimulatedMotion& motion) {
  const auto millimetres = [](double value) { return Json(1e3 * value); };
  return object("time_s", motion.time, "displacement_mm", list_of(motion.displacement, millimetres),
                "block_velocity_mm_s", list_of(motion.velocity, millimetres));
}

void write_motion(WholeFolder& files, const std::string& name, const SimulatedMotion& motion) {
  constexpr int kDigits = 9;
  const auto row = [&](std::size_t i) {
    return object("time_s", motion.time[i], "displacement_mm", 1e3 * motion.displacement[i], "block_velocity_mm_s",
                  1e3 * motion.velocity[i], "relative_velocity_mm_s", 1e3 * motion.relative_velocity[i], "friction",
                  motion.friction[i], "phase", motion.sticks[i] != 0 ? "stick" : "slip");
  };
  write_rows(files, name, motion.size(), row, kDigits);
}

}  // namespace

std::string study_json(const StudiedMachine& studied, const std::vector<Portrait>& study, const JsonOptions& options) {
  const auto portrait = [](const Portrait& p) {
    return object("velocity_mm_s", p.velocity / kMillimetre, "settled", explained_json(p.settled), "start",
                  motion_json(p.start), "cycle", p.cycle.size() > 0 ? motion_json(p.cycle) : Json());
  };
  return study_text(studied, "phase", object("portraits", list_of(study, portrait)), options);
}

void write_study(const std::string& folder, const std::vector<Portrait>& study) {
  WholeFolder files(folder);
  write_rows(files, "portraits.csv", study.size(), [&](std::size_t k) {
    Json row = object("portrait", k + 1, "velocity_mm_s", 1e3 * study[k].velocity);
    row.update(settled_json(study[k].settled));
    return row;
  });
  for (std::size_t k = 0; k < study.size(); ++k) {
    write_motion(files, fmt::format("phase_{}.csv", k + 1), study[k].start);
    if (study[k].cycle.size() > 0) write_motion(files, fmt::format("cycle_{}.csv", k + 1), study[k].cycle);
  }
  files.commit();
}

Report report_of(const StudiedMachine& studied, const std::vector<Portrait>& study, const ReportOptions& options) {
  ReportSection portraits{"phase", "Displacement and velocity", {}};
  ReportSection times{"time", "Over time", {}}, moving{"block", "The block in motion", {}};
  const std::vector<std::size_t> drawn = thinned(study.size(), kDrawn);
  if (drawn.size() < study.size()) {
    portraits.plain(fmt::format("{} of {} speeds are drawn; the table has all.", drawn.size(), study.size()),
                    Medium::page);
  }
  if (drawn.size() > 1) portraits.add(all_portraits(study, drawn));
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    add_motion(studied, study[drawn[k]], k + 1, portraits, times, moving);
  }
  ReportTable table = settled_table("Measures of the settled motions");
  std::vector<std::string> unsettled;
  for (const Portrait& portrait : study) {
    table.rows.push_back(row_of({significant(portrait.velocity / kMillimetre, 4)}, portrait.settled));
    const std::string seen = seen_sentence(portrait.settled);
    if (!seen.empty()) unsettled.push_back(speed_text(portrait) + ": " + seen);
  }
  portraits.add(std::move(table));
  for (const std::string& sentence : unsettled) portraits.text(ReportText::Kind::item, sentence, Medium::terminal);
  if (!options.csv_written) {
    portraits.plain(
        "--csv FOLDER writes displacement and velocity: phase_N.csv from the start, cycle_N.csv one settled cycle");
  }
  return study_report(studied, "phase", regimes_sentence(study),
                      {std::move(portraits), std::move(moving), std::move(times)}, options, unsettled);
}

}  // namespace tribofit
