#include "tribofit/report/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numbers.hpp"
#include "style.hpp"

namespace tribofit {
namespace {

/// Units in which energies and times of this size are best read stay those of the files: one less thing to mistake.
std::string value_text(const Settled& settled, const MeasureInfo& measure) {
  return significant(settled.*measure.value / measure.si, 4);
}

std::string interval_text(const Range& range, double unit) {
  if (std::isnan(range.lower95)) return "";
  return fmt::format("  [{}, {}]", significant(range.lower95 / unit, 4), significant(range.upper95 / unit, 4));
}

std::string machine_text(const StudiedMachine& of, const Style& style) {
  const Machine& m = of.machine;
  std::string text = fmt::format("{}: {}\n", of.source, m.model.name());
  std::string rig = fmt::format("m = {} kg, k = {} N/mm, c = {} N s/mm (damping ratio {}), natural frequency {} Hz; ",
                                significant(m.rig.mass, 4), significant(1e-3 * m.rig.stiffness, 4),
                                significant(1e-3 * m.rig.damping, 4), significant(m.rig.damping_ratio(), 3),
                                significant(m.rig.natural_frequency() / 6.283185307179586, 4));
  rig += fmt::format("N = {} N, r = {} mm, {} rpm, omega r = {} mm/s", brief(m.load), brief(m.radius / kMillimetre),
                     brief(m.speed / kRpm), significant(m.disc_velocity() / kMillimetre, 4));
  text += "  " + wrapped(rig, style.width, 2) + "\n";
  std::string friction;
  for (std::size_t k = 0; k < m.parameters.size(); ++k) {
    const FrictionModel::Slot& slot = m.model.parameters()[k];
    const Parameter& q = slot.parameter;
    friction += fmt::format("{}{}{} = {}{}", friction.empty() ? "" : ", ", slot.effect.empty() ? "" : slot.effect + ".",
                            q.name, significant(m.parameters[k] / q.si, 4), q.unit == "1" ? "" : " " + q.unit);
  }
  text += "  " + wrapped(friction, style.width, 2) + "\n";
  if (of.sharpness > 0) {
    text += fmt::format("  smoothed by an arctangent of sharpness {} s/mm\n", significant(1e-3 * of.sharpness, 4));
  }
  for (const std::string& note : of.notes) text += "  " + wrapped(note, style.width, 2) + "\n";
  return text;
}

std::vector<std::string> measure_header(std::vector<std::string> header) {
  for (const MeasureInfo& measure : measures()) header.push_back(measure.heading);
  return header;
}

/// At most `most` of `count` rows, evenly, the ends among them.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> rows;
  const std::size_t shown = std::min(count, most);
  for (std::size_t i = 0; i < shown; ++i) rows.push_back(shown < 2 ? 0 : i * (count - 1) / (shown - 1));
  return rows;
}

std::string thinned_note(std::size_t shown, std::size_t all, const char* file) {
  return shown == all ? "" : fmt::format("  {} of {} shown; --csv writes all ({})\n", shown, all, file);
}

std::string velocity_text(double velocity, const Machine& machine) {
  return fmt::format("{} mm/s ({} rpm)", significant(velocity / kMillimetre, 4),
                     significant(velocity / machine.radius / kRpm, 4));
}

std::string critical_text(const StudiedMachine& of, const SpeedStudy& study, const Style& style) {
  const CriticalSpeed& c = study.critical;
  std::string text = style.heading("Critical speed");
  const auto line = [&](const char* what, double value, const Range& range) {
    if (std::isnan(value)) return;
    std::string sentence = fmt::format("{} {}", what, velocity_text(value, of.machine));
    if (!std::isnan(range.lower95)) sentence += "," + interval_text(range, kMillimetre) + " mm/s (95 %)";
    text += "  " + wrapped(sentence, style.width, 4) + "\n";
  };
  for (const double v : c.linear) {
    const bool last = v == c.linear.back();
    const char* what =
        c.stable_at_highest ? "steady sliding loses its stability below" : "steady sliding is unstable from";
    line(last ? what : "steady sliding changes its stability at", v,
         last ? study.linear_range : Range{std::nan(""), std::nan("")});
  }
  if (c.linear.empty()) {
    text += fmt::format("  steady sliding is {} at all speeds from {} to {} mm/s\n",
                        c.stable_at_highest ? "stable" : "unstable", significant(1e3 * c.lowest, 3),
                        significant(1e3 * c.highest, 3));
  }
  line("on the way up stick vanishes at", c.stick_vanishes, study.vanishes_range);
  line("on the way down it comes back at", c.stick_returns, study.returns_range);
  if (!std::isnan(c.stick_vanishes) && std::isnan(c.stick_returns)) {
    text += "  on the way down it does not come back: sliding goes on\n";
  }
  if (c.below_range) {
    text += fmt::format("  nothing sticks from {} to {} mm/s\n", significant(1e3 * c.lowest, 3),
                        significant(1e3 * c.highest, 3));
  }
  if (c.above_range) {
    text += fmt::format("  it still sticks at {} mm/s, the highest speed searched\n", significant(1e3 * c.highest, 3));
  }
  constexpr double kSame = 1.001;
  if (c.stick_vanishes > kSame * c.stick_returns) {
    text +=
        "  " +
        wrapped(fmt::format("Between {} and {} mm/s it depends on the past which of the two is seen: stick-slip goes "
                            "on where it has begun, sliding goes on where it has (a subcritical bifurcation).",
                            significant(1e3 * c.stick_returns, 4), significant(1e3 * c.stick_vanishes, 4)),
                style.width, 2) +
        "\n";
  }
  return text;
}

std::string seen_text(const Settled& settled, const Style& style) {
  if (settled.regime != Regime::not_settled) return "";
  return "  " + wrapped("did not settle: " + settled.seen, style.width, 4) + "\n";
}

std::string next_text(const std::string& purpose, const char* kind, const TerminalOptions& options) {
  std::string command = std::string("identify study ") + kind;
  for (const std::string& argument : options.arguments) command += " " + shell_quoted(argument);
  for (const std::string& input : options.inputs) command += " " + shell_quoted(input);
  return "\nNext, " + purpose + ":\n" + folded_command(command, Style(false, options.width).width) + "\n";
}

}  // namespace

std::string render_study(const StudiedMachine& of, const SpeedStudy& study, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = machine_text(of, style);
  text += style.heading(
      fmt::format("At {}: {}", velocity_text(of.machine.disc_velocity(), of.machine), to_string(study.own.regime)));
  Table own({"measure", "value", "95 % interval", "unit"}, {true, false, false, true});
  for (std::size_t k = 0; k < measures().size(); ++k) {
    const MeasureInfo& measure = measures()[k];
    own.add(
        {measure.name, value_text(study.own, measure), interval_text(study.own_ranges[k], measure.si), measure.unit});
  }
  text += own.text(2, style.dim, style.off) + seen_text(study.own, style);
  text += critical_text(of, study, style);
  text += style.heading("Over speed (begun in stick; what differs when begun in sliding stands behind)");
  Table table(measure_header({"mm/s", "regime"}), {false, true, false, false, false, false, false, true});
  const std::vector<std::size_t> rows = thinned(study.velocity.size(), 20);
  for (const std::size_t i : rows) {
    const bool same = study.up[i].regime == study.down[i].regime;
    std::vector<std::string> row = {significant(1e3 * study.velocity[i], 4),
                                    std::string(to_string(study.up[i].regime)) +
                                        (same ? "" : " (" + std::string(to_string(study.down[i].regime)) + ")")};
    for (const MeasureInfo& measure : measures()) row.push_back(value_text(study.up[i], measure));
    table.add(std::move(row));
  }
  text += table.text(2, style.dim, style.off) + thinned_note(rows.size(), study.velocity.size(), "speed.csv");
  return text + next_text("which number matters", "sensitivity", options);
}

std::string render_study(const StudiedMachine& of, const std::vector<Portrait>& study, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = machine_text(of, style) + style.heading("Phase portraits");
  Table table(measure_header({"mm/s", "regime"}), {false, true, false, false, false, false, false});
  std::string seen;
  for (const Portrait& portrait : study) {
    std::vector<std::string> row = {significant(1e3 * portrait.velocity, 4),
                                    std::string(to_string(portrait.settled.regime))};
    for (const MeasureInfo& measure : measures()) row.push_back(value_text(portrait.settled, measure));
    table.add(std::move(row));
    seen += seen_text(portrait.settled, style);
  }
  text += table.text(2, style.dim, style.off) + seen;
  if (!options.csv_written) {
    text += "  " +
            wrapped(
                "--csv FOLDER writes displacement and velocity: phase_N.csv from the start, cycle_N.csv one "
                "settled cycle",
                style.width, 2) +
            "\n";
  }
  return text + next_text("the speed at which stick vanishes", "speed", options);
}

std::string render_study(const StudiedMachine& of, const Response& study, const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = machine_text(of, style) + style.heading("Response to a force");
  text += fmt::format("  natural frequency {} Hz, damped {} Hz; response frequency {} Hz\n",
                      significant(study.natural_frequency, 5), significant(study.damped_natural_frequency, 5),
                      significant(study.settled.frequency, 5));
  const Rig& rig = of.machine.rig;
  text += "  " +
          wrapped(fmt::format("A(omega) of a force of {} N ({}): {} mm at rest, {} mm at the natural frequency "
                              "(--csv: response.csv)",
                              significant(study.force, 4),
                              study.harmonics.empty() ? "half the drop of friction" : "the fundamental of friction",
                              significant(1e3 * study.force / rig.stiffness, 4),
                              significant(1e3 * study.force / (rig.damping * rig.natural_frequency()), 4)),
                  style.width, 2) +
          "\n";
  text += seen_text(study.settled, style);
  if (!study.harmonics.empty()) {
    text += style.heading("Spectra of settled motion");
    Table table({"harmonic", "frequency Hz", "friction N", "displacement mm", "velocity mm/s"});
    for (const std::size_t n : thinned(std::min<std::size_t>(study.harmonics.size(), 8), 8)) {
      const ResponseLine& h = study.harmonics[n];
      table.add({fmt::format("{}", n + 1), significant(h.frequency, 4), significant(h.force, 4),
                 significant(1e3 * h.displacement, 4), significant(1e3 * h.velocity, 4)});
    }
    text += table.text(2, style.dim, style.off) +
            thinned_note(std::min<std::size_t>(study.harmonics.size(), 8), study.harmonics.size(), "harmonics.csv");
  } else {
    text += fmt::format("  no settled vibration, so no spectra ({})\n", to_string(study.settled.regime));
  }
  return text + next_text("portraits of the motion", "phase", options);
}

std::string render_study(const StudiedMachine& of, const std::vector<Sensitivity>& study,
                         const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  std::string text = machine_text(of, style);
  text += style.heading("Elasticities: per cent of a measure for one per cent of a number");
  std::vector<std::string> header = {"number", "value", "unit"};
  for (const MeasureInfo& measure : measures()) header.push_back(measure.name);
  Table table(header, {true, false, true});
  const auto signed_text = [](double e) { return std::isnan(e) ? std::string("-") : fmt::format("{:+.3f}", e); };
  for (const Sensitivity& one : study) {
    std::vector<std::string> row = {one.variable.name, significant(one.base / one.variable.si, 4),
                                    one.variable.unit == "1" ? "" : one.variable.unit};
    for (const double e : one.elasticities) row.push_back(signed_text(e));
    table.add(std::move(row));
  }
  text += table.text(2, style.dim, style.off);
  text += style.heading("What matters most");
  for (std::size_t k = 0; k < measures().size(); ++k) {
    std::string list;
    for (const std::size_t i : ranked(study, k)) {
      const double e = study[i].elasticities[k];
      if (!std::isnan(e))
        list += (list.empty() ? "" : ", ") + fmt::format("{} ({})", study[i].variable.name, signed_text(e));
    }
    text += "  " +
            wrapped(measures()[k].name + ": " + (list.empty() ? "nothing can be said here" : list), style.width, 4) +
            "\n";
  }
  if (!options.csv_written) text += "  --csv FOLDER writes the sweeps behind these (sensitivity.csv)\n";
  return text + next_text("two numbers at once", "map --x stiffness --y mass --csv map/", options);
}

std::string render_map(const StudiedMachine& of, const MapRequest& request,
                       const std::vector<std::vector<MapCell>>& rows, const MeasureInfo& measure,
                       const TerminalOptions& options) {
  const Style style(options.colour, options.width);
  const auto& all = measures();
  const auto k = static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(), [&](const MeasureInfo& m) { return m.name == measure.name; }) - all.begin());
  const Variable &x = request.x.variable, &y = request.y.variable;
  std::string text = machine_text(of, style);
  text += style.heading(fmt::format("{} [{}] over {} [{}] (across) and {} [{}] (down)", measure.name, measure.unit,
                                    x.name, x.unit, y.name, y.unit));
  const std::vector<std::size_t> columns = thinned(request.x.values.size(), 8), lines = thinned(rows.size(), 12);
  std::vector<std::string> header = {""};
  for (const std::size_t i : columns) header.push_back(significant(request.x.values[i] / x.si, 3));
  Table table(header, {false});
  std::size_t unsettled = 0, cells = 0;
  for (const auto& row : rows) {
    cells += row.size();
    unsettled += static_cast<std::size_t>(
        std::count_if(row.begin(), row.end(), [](const MapCell& c) { return c.regime == Regime::not_settled; }));
  }
  for (const std::size_t j : lines) {
    std::vector<std::string> row = {significant(request.y.values[j] / y.si, 3)};
    for (const std::size_t i : columns) {
      const MapCell& cell = rows[j][i];
      row.push_back(cell.regime == Regime::sliding ? "slides" : significant(cell.values[k] / measure.si, 3));
    }
    table.add(std::move(row));
  }
  text += table.text(2, style.dim, style.off);
  text += fmt::format("  {} cells", cells);
  if (unsettled > 0) text += fmt::format(", {} of which did not settle (their regime says so)", unsettled);
  return text + "\n" + next_text("the speeds at which stick vanishes", "speed", options);
}

}  // namespace tribofit
