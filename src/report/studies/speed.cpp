#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <utility>

#include "parts.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {
namespace {

/// "[1.2, 1.4]" in `unit`; empty where it is not known.
std::string range_text(const Interval& range, double unit) {
  if (std::isnan(range.lower)) return "";
  return fmt::format("[{}, {}]", significant(range.lower / unit, 4), significant(range.upper / unit, 4));
}

Json range_json(const Interval& range, double unit) {
  return interval_json(range.lower / unit, range.upper / unit);
}

/// Where sliding gains or loses its stability, where stick vanishes and comes back, with their 95 % ranges.
std::vector<std::string> critical_sentences(const StudiedMachine& studied, const SpeedStudy& study) {
  const CriticalSpeed& c = study.critical;
  std::vector<std::string> out;
  const auto add = [&](const char* what, double value, const Interval& range) {
    if (std::isnan(value)) return;
    std::string sentence = fmt::format("{} {}", what, velocity_text(value, studied.machine));
    if (!std::isnan(range.lower)) sentence += ", " + range_text(range, kMillimetre) + " mm/s (95 %)";
    out.push_back(std::move(sentence));
  };
  for (const double v : c.linear) {
    const bool last = v == c.linear.back();
    const char* what =
        c.stable_at_highest ? "steady sliding loses its stability below" : "steady sliding is unstable from";
    add(last ? what : "steady sliding changes its stability at", v,
        last ? study.linear_interval : Interval{std::nan(""), std::nan("")});
  }
  const std::string searched =
      fmt::format("from {} to {} mm/s", significant(1e3 * c.lowest, 3), significant(1e3 * c.highest, 3));
  if (c.linear.empty()) {
    out.push_back(
        fmt::format("steady sliding is {} at all speeds {}", c.stable_at_highest ? "stable" : "unstable", searched));
  }
  add("on the way up stick vanishes at", c.stick_vanishes, study.vanishes_interval);
  add("on the way down it comes back at", c.stick_returns, study.returns_interval);
  if (!std::isnan(c.stick_vanishes) && std::isnan(c.stick_returns)) {
    out.push_back("on the way down it does not come back: sliding goes on");
  }
  if (c.below_range) out.push_back("nothing sticks " + searched);
  if (c.above_range) {
    out.push_back(
        fmt::format("it still sticks at {} mm/s, the highest speed searched", significant(1e3 * c.highest, 3)));
  }
  return out;
}

/// What is between the two speeds where they differ; empty where they do not.
std::string bistable_sentence(const CriticalSpeed& c) {
  if (!c.is_bistable()) return "";
  return fmt::format(
      "Between {} and {} mm/s both motions are stable, and the history decides: stick-slip continues if it has "
      "started, and so does sliding (a subcritical bifurcation).",
      significant(1e3 * c.stick_returns, 4), significant(1e3 * c.stick_vanishes, 4));
}

/// The measures of the machine at its own speed, with their 95 % ranges.
ReportTable own_table(const StudiedMachine& studied, const SpeedStudy& study) {
  ReportTable table(fmt::format("At {}: {}", velocity_text(studied.machine.disc_velocity(), studied.machine),
                                to_string(study.own.regime)));
  table.text({"measure"}).numbers({"value", "95 % interval"}).text({"unit"}).text({"meaning"}, 1);
  for (std::size_t k = 0; k < measures().size(); ++k) {
    const MeasureInfo& measure = measures()[k];
    const std::string range = range_text(study.own_intervals[k], measure.si);
    table.rows.push_back(
        {measure.name, measure_text(study.own, measure), range.empty() ? "-" : range, measure.unit, measure.meaning});
  }
  return table;
}

/// The measures at `most` speeds; a second row where a motion that begins in sliding differs.
ReportTable speed_table(const SpeedStudy& study, std::size_t most) {
  ReportTable table = settled_table("Over speed", {"begun in"});
  const std::vector<std::size_t> shown = thinned(study.velocity.size(), most);
  for (const std::size_t i : shown) {
    const std::string velocity = significant(study.velocity[i] / kMillimetre, 4);
    std::vector<std::string> up = row_of({velocity, "stick"}, study.up[i]);
    std::vector<std::string> down = row_of({velocity, "sliding"}, study.down[i]);
    const bool same = std::equal(up.begin() + 2, up.end(), down.begin() + 2);
    if (same) up[1] = "either";
    table.rows.push_back(std::move(up));
    if (!same) table.rows.push_back(std::move(down));
  }
  if (shown.size() < study.velocity.size()) {
    table.caption += fmt::format(" ({} of {} speeds; --csv writes all)", shown.size(), study.velocity.size());
  }
  return table;
}

/// Marks the critical speeds, with the ranges of those of sliding or of stick over all panels. What happens at one
/// speed shares a mark.
void mark_critical(const SpeedStudy& study, bool of_sliding, Chart& chart) {
  const std::size_t first = chart.marks.size();
  const auto add = [&](double at, Dash dash, const std::string& text, const Interval* range) {
    if (!std::isfinite(at)) return;
    const auto same = [&](const ChartMark& mark) { return is_same_speed(mark.at * kMillimetre, at); };
    auto mark = std::find_if(chart.marks.begin() + static_cast<std::ptrdiff_t>(first), chart.marks.end(), same);
    if (mark == chart.marks.end()) mark = chart.marks.insert(mark, {at / kMillimetre, true, dash});
    mark->text += (mark->text.empty() ? "" : ", ") + text;
    if (range == nullptr || !std::isfinite(range->lower) || !std::isfinite(range->upper)) return;
    mark->text += " " + range_text(*range, kMillimetre);
    chart.stretches.push_back({range->lower / kMillimetre, range->upper / kMillimetre, Shade::range});
  };
  const CriticalSpeed& c = study.critical;
  for (const double& v : c.linear) {
    const bool last = of_sliding && &v == &c.linear.back();
    add(v, Dash::dotted, "stability of sliding", last ? &study.linear_interval : nullptr);
  }
  add(c.stick_vanishes, Dash::dashed, "stick vanishes", of_sliding ? nullptr : &study.vanishes_interval);
  add(c.stick_returns, Dash::dash_dotted, "stick returns", of_sliding ? nullptr : &study.returns_interval);
}

/// One way over speed: its motions, and where stick vanishes or returns on it.
struct Way {
  const char* name;
  const std::vector<Settled>& settled;
  double jump;
  Stroke stroke;
};
std::array<Way, 2> ways_of(const SpeedStudy& study) {
  Stroke up = marked(1), down = marked(2);
  up.dash = Dash::solid;
  down.dash = Dash::dashed;
  up.size = down.size = 5;
  return {{{"begun in stick (way up)", study.up, study.critical.stick_vanishes, up},
           {"begun in sliding (way down)", study.down, study.critical.stick_returns, down}}};
}

/// The points of a way, and the line through them with its jump where stick vanishes or returns: the measure of the
/// sticking motion goes on to that speed as straight as it came.
void add_way(const SpeedStudy& study, const Way& way, const MeasureInfo& measure, std::size_t panel, Chart& chart) {
  ChartLine line{.name = way.name, .stroke = way.stroke, .panel = panel}, points = line;
  line.stroke.symbol = Symbol::none;
  points.stroke.joined = false;
  const auto value = [&](std::size_t i) { return way.settled[i].*measure.value / measure.si; };
  const auto sticks = [&](std::size_t i) { return way.settled[i].regime != Regime::sliding; };
  for (std::size_t i = 0; i < way.settled.size(); ++i) {
    const double v = study.velocity[i], jump = way.jump;
    line.add(v / kMillimetre, value(i));
    points.add(v / kMillimetre, value(i));
    if (i == 0 || i + 1 == way.settled.size() || !(jump > v && jump < study.velocity[i + 1])) continue;
    if (!sticks(i) || sticks(i + 1)) continue;
    const double slope = (value(i) - value(i - 1)) / (v - study.velocity[i - 1]);
    line.add(jump / kMillimetre, value(i) + slope * (jump - v));
    line.add(jump / kMillimetre, value(i + 1));
  }
  chart.lines.push_back(std::move(line));
  chart.lines.push_back(std::move(points));
}

/// Speeds in equal ratios are seen apart on a logarithmic axis.
ChartAxis speed_axis(const SpeedStudy& study) {
  constexpr double kWide = 20;
  const std::vector<double>& v = study.velocity;
  const bool wide = !v.empty() && v.front() > 0 && v.back() > kWide * v.front();
  return {.quantity = "speed of the disc", .unit = "mm/s", .logarithmic = wide};
}

Chart over_speed(const StudiedMachine& studied, const SpeedStudy& study, const char* id, const char* title,
                 std::initializer_list<const char*> names) {
  Chart chart{.id = id, .title = title, .x = speed_axis(study), .panels = {}};
  for (const std::string name : names) {
    const MeasureInfo& measure = measure_named(name);
    const std::size_t panel = chart.panels.size();
    chart.panels.push_back({.quantity = measure.name, .unit = measure.unit, .from_zero = true});
    for (const Way& way : ways_of(study)) add_way(study, way, measure, panel, chart);
    if (const Estimate* measured = measured_value(studied, measure)) {
      ChartLine& line = chart.line("measured", dots(Colour::black, Symbol::cross, 9), panel);
      line.add(studied.machine.disc_velocity() / kMillimetre, measured->value / measure.si,
               kNormalQuantile95 * measured->std_error / measure.si);
    }
    if (name == "frequency") {
      chart.marks.push_back({studied.machine.natural_hertz(), false, Dash::dotted, "natural frequency", panel});
    }
  }
  mark_critical(study, false, chart);
  return chart;
}

Chart growth_chart(const SpeedStudy& study) {
  Chart chart = chart_of(
      "growth-rate", "Growth of a small vibration about steady sliding", speed_axis(study), {"growth rate", "1/s"},
      "Above zero steady sliding is unstable: a vibration grows until it sticks or is held by the law.");
  chart.lines = {{"growth rate", in_unit(study.velocity, kMillimetre), study.growth_rate, stroke_of(0)}};
  chart.marks = {{.dash = Dash::solid}};
  mark_critical(study, true, chart);
  return chart;
}

}  // namespace

std::string study_json(const StudiedMachine& studied, const SpeedStudy& study, const JsonOptions& options) {
  Json points = Json::array();
  for (std::size_t i = 0; i < study.velocity.size(); ++i) {
    points.push_back(object("velocity_mm_s", study.velocity[i] / kMillimetre, "growth_rate_1_s", study.growth_rate[i],
                            "up", explained_json(study.up[i]), "down", explained_json(study.down[i])));
  }
  Json own = explained_json(study.own);
  for (std::size_t k = 0; k < study.own_intervals.size(); ++k) {
    own["ci95"][measures()[k].column] = range_json(study.own_intervals[k], measures()[k].si);
  }
  const CriticalSpeed& c = study.critical;
  const Json critical =
      object("linear_mm_s", list_of(c.linear, [](double v) { return number(v / kMillimetre); }), "linear_ci95_mm_s",
             range_json(study.linear_interval, kMillimetre), "stick_vanishes_mm_s", c.stick_vanishes / kMillimetre,
             "stick_vanishes_ci95_mm_s", range_json(study.vanishes_interval, kMillimetre), "stick_returns_mm_s",
             c.stick_returns / kMillimetre, "stick_returns_ci95_mm_s", range_json(study.returns_interval, kMillimetre),
             "searched_mm_s", interval_json(c.lowest / kMillimetre, c.highest / kMillimetre), "nothing_sticks",
             c.below_range, "always_sticks", c.above_range);
  return study_text(studied, "speed", object("own", own, "critical_speed", critical, "points", points), options);
}

void write_study(const std::string& folder, const SpeedStudy& study) {
  WholeFolder files(folder);
  write_rows(files, "speed.csv", study.velocity.size(), [&](std::size_t i) {
    Json row = object("velocity_mm_s", 1e3 * study.velocity[i], "growth_rate_1_s", study.growth_rate[i]);
    row.update(settled_json(study.up[i], "up"));
    row.update(settled_json(study.down[i], "down"));
    return row;
  });
  files.commit();
}

Report report_of(const StudiedMachine& studied, const SpeedStudy& study, const ReportOptions& options) {
  constexpr std::size_t kRowsOfATerminal = 20, kRowsOfAPage = 200;
  const std::string seen = seen_sentence(study.own), between = bistable_sentence(study.critical);
  std::string lead;
  ReportSection section{"speed", "Over the speed of the disc", {}};
  Chart motion = over_speed(studied, study, "speed-motion", "Frequency, stick and amplitude over speed",
                            {"frequency", "stick-time", "peak-to-peak"});
  motion.note = "Where the two ways differ, both motions go on where they have begun.";
  section.add(std::move(motion));
  section.add(over_speed(studied, study, "speed-energy", "Energy before break-away and fastest slip over speed",
                         {"energy", "peak-speed"}));
  section.add(growth_chart(study));
  section.add(own_table(studied, study));
  section.text(ReportText::Kind::item, seen, Medium::terminal);
  section.heading("Critical speed");
  for (const std::string& sentence : critical_sentences(studied, study)) {
    section.item(sentence);
    lead += (lead.empty() ? "" : " ") + capitalised(sentence) + ".";
  }
  section.plain(between);
  if (!between.empty()) lead += " " + between;
  section.add(speed_table(study, kRowsOfATerminal), Medium::terminal);
  ReportTable all = speed_table(study, kRowsOfAPage);
  all.folded = true;
  section.add(std::move(all));
  return study_report(studied, "speed", std::move(lead), {std::move(section)}, options, {seen});
}

}  // namespace tribofit
