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

Chart portrait_chart(const StudiedMachine& studied, const Portrait& portrait, std::size_t number) {
  Chart chart = portrait_plane(
      fmt::format("phase-{}", number),
      fmt::format("Portrait at {}: {}", speed_text(portrait), to_string(portrait.settled.regime)), portrait.velocity);
  add_loop({"from the start", portrait.start}, {.colour = Colour::grey, .dash = Dash::dotted, .width = 1}, chart);
  if (portrait.cycle.size() > 0) {
    add_loop({"settled cycle", portrait.cycle}, {.colour = Colour::black, .width = 2}, chart, true);
  }
  const BlockMotion measured = measured_motion(studied, portrait.velocity);
  if (measured.size() > 0) {
    add_loop({fmt::format("measured, {} cycles", measured.cycles), measured},
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
    add_loop({speed_text(portrait), portrait.cycle}, stroke_of(k), chart, true);
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
                stroke_of(0), chart);
  shade_sticks(motion, chart);
  return chart;
}

/// The block at one speed, and as it was measured where it was.
Animation animation_of(const StudiedMachine& studied, const Portrait& portrait, std::size_t number) {
  Animation out{.id = fmt::format("block-{}", number),
                .title = "The block on its disc at " + speed_text(portrait),
                .disc_velocity = portrait.velocity / kMillimetre};
  const BlockMotion measured = measured_motion(studied, portrait.velocity);
  if (measured.size() > 0) {
    out.blocks.push_back(animated({"measured", measured}));
    out.note = "Measured (three cycles) beside simulated (one settled cycle).";
  }
  out.blocks.push_back(animated({"simulated", portrait.cycle}));
  return out;
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
    const std::string all = at.size() > 4
                                ? fmt::format("{} speeds from {} to {}", at.size(), speeds.front(), speeds.back())
                                : enumerated(speeds);
    texts.push_back(fmt::format("{} at {} mm/s", to_string(regime), all));
  }
  return capitalised(fmt::format("{}.", fmt::join(texts, "; ")));
}

ReportTable portraits_table(const std::vector<Portrait>& study) {
  ReportTable table("Measures of the settled motions");
  table.columns.push_back({"speed [mm/s]", true, 0, "mm/s"});
  table.text({"regime"});
  add_measure_columns(table);
  for (const Portrait& portrait : study) {
    table.rows.push_back(row_of({significant(portrait.velocity / kMillimetre, 4)}, portrait.settled));
  }
  return table;
}

Json motion_json(const SimulatedMotion& motion) {
  const auto millimetres = [](double value) { return Json(1e3 * value); };
  return object("time_s", motion.time, "displacement_mm", list_of(motion.displacement, millimetres),
                "block_velocity_mm_s", list_of(motion.velocity, millimetres));
}

void write_motion(WholeFolder& files, const std::string& name, const SimulatedMotion& motion) {
  constexpr int kDigits = 9;
  std::vector<CsvColumn<std::size_t>> columns = {
      {"time_s", [&](std::size_t i) { return motion.time[i]; }},
      {"displacement_mm", [&](std::size_t i) { return 1e3 * motion.displacement[i]; }},
      {"block_velocity_mm_s", [&](std::size_t i) { return 1e3 * motion.velocity[i]; }},
      {"relative_velocity_mm_s", [&](std::size_t i) { return 1e3 * motion.relative_velocity[i]; }},
      {"friction", [&](std::size_t i) { return motion.friction[i]; }},
      {"phase", [&](std::size_t i) { return motion.sticks[i] != 0 ? "stick" : "slip"; }},
  };
  CsvTable table(files, name, std::move(columns), kDigits);
  for (std::size_t i = 0; i < motion.size(); ++i) table.row(i);
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
  const auto number_of = [&](const Portrait& p) { return std::to_string(&p - study.data() + 1); };
  std::vector<CsvColumn<Portrait>> columns = {
      {"portrait", number_of},
      {"velocity_mm_s", [](const Portrait& p) { return 1e3 * p.velocity; }},
      {"regime" + measure_columns(), [](const Portrait& p) { return settled_json(p.settled); }},
  };
  CsvTable list(files, "portraits.csv", std::move(columns));
  for (const Portrait& portrait : study) {
    const std::string name = number_of(portrait);
    list.row(portrait);
    write_motion(files, "phase_" + name + ".csv", portrait.start);
    if (portrait.cycle.size() > 0) write_motion(files, "cycle_" + name + ".csv", portrait.cycle);
  }
  files.commit();
}

Report report_of(const StudiedMachine& studied, const std::vector<Portrait>& study, const ReportOptions& options) {
  std::vector<const Portrait*> drawn;
  for (const std::size_t i : thinned(study.size(), kDrawn)) drawn.push_back(&study[i]);
  ReportSection portraits{"phase", "Displacement and velocity", {}};
  ReportSection times{"time", "Over time", {}}, moving{"block", "The block in motion", {}};
  if (drawn.size() < study.size()) {
    portraits.plain(fmt::format("{} of {} speeds are drawn; the table has all.", drawn.size(), study.size()),
                    Medium::page);
  }
  if (drawn.size() > 1) portraits.add(all_portraits(drawn));
  for (std::size_t k = 0; k < drawn.size(); ++k) {
    portraits.add(portrait_chart(studied, *drawn[k], k + 1));
    times.add(time_chart(*drawn[k], k + 1));
    if (drawn[k]->cycle.size() > 0) moving.add(animation_of(studied, *drawn[k], k + 1));
  }
  portraits.add(portraits_table(study));
  std::vector<std::string> unsettled;
  for (const Portrait& portrait : study) {
    const std::string seen = seen_sentence(portrait.settled);
    if (!seen.empty()) unsettled.push_back(speed_text(portrait) + ": " + seen);
  }
  for (const std::string& sentence : unsettled) portraits.text(ReportText::Kind::item, sentence, Medium::terminal);
  if (!options.csv_written) {
    portraits.plain(
        "--csv FOLDER writes displacement and velocity: phase_N.csv from the start, cycle_N.csv one settled cycle");
  }
  Report report = study_report(studied, "phase", "Phase portraits", regimes_sentence(study),
                               {std::move(portraits), std::move(moving), std::move(times)},
                               {"to see the speed at which stick vanishes", "speed"}, options);
  report.warnings.insert(report.warnings.end(), unsettled.begin(), unsettled.end());
  return report;
}

}  // namespace tribofit
