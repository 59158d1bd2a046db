#include "tribofit/report/study.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "numbers.hpp"
#include "study_sentences.hpp"
#include "style.hpp"

namespace tribofit {
namespace {

std::string interval_text(const Range& range, double unit) {
  const std::string text = range_text(range, unit);
  return text.empty() ? "" : "  " + text;
}

std::string machine_text(const StudiedMachine& of, const Style& style) {
  std::string text = fmt::format("{}: {}\n", of.source, of.machine.model.name());
  for (const std::string& sentence : machine_sentences(of)) text += "  " + wrapped(sentence, style.width, 2) + "\n";
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

std::string thinned_note(std::size_t shown, std::size_t all, const char* file) {
  return shown == all ? "" : fmt::format("  {} of {} shown; --csv writes all ({})\n", shown, all, file);
}

std::string critical_text(const StudiedMachine& of, const SpeedStudy& study, const Style& style) {
  std::string text = style.heading("Critical speed");
  for (const std::string& sentence : critical_sentences(of, study)) {
    text += "  " + wrapped(sentence, style.width, 4) + "\n";
  }
  const std::string between = bistable_sentence(study.critical);
  return between.empty() ? text : text + "  " + wrapped(between, style.width, 2) + "\n";
}

std::string seen_text(const Settled& settled, const Style& style) {
  const std::string seen = seen_sentence(settled);
  return seen.empty() ? seen : "  " + wrapped(seen, style.width, 4) + "\n";
}

std::string next_text(const std::string& purpose, const char* kind, const TerminalOptions& options) {
  return "\nNext, " + purpose + ":\n" +
         folded_command(study_command(kind, options.arguments, options.inputs), Style(false, options.width).width) +
         "\n";
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
        {measure.name, measure_text(study.own, measure), interval_text(study.own_ranges[k], measure.si), measure.unit});
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
    for (const MeasureInfo& measure : measures()) row.push_back(measure_text(study.up[i], measure));
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
    for (const MeasureInfo& measure : measures()) row.push_back(measure_text(portrait.settled, measure));
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
  text += "  " + wrapped(response_sentence(of, study) + " (--csv: response.csv)", style.width, 2) + "\n";
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
  for (const Sensitivity& one : study) {
    std::vector<std::string> row = {one.variable.name, significant(one.base / one.variable.si, 4),
                                    one.variable.unit == "1" ? "" : one.variable.unit};
    for (const double e : one.elasticities) row.push_back(elasticity_text(e));
    table.add(std::move(row));
  }
  text += table.text(2, style.dim, style.off);
  text += style.heading("What matters most");
  for (std::size_t k = 0; k < measures().size(); ++k) {
    text += "  " + wrapped(measures()[k].name + ": " + ranking_sentence(study, k), style.width, 4) + "\n";
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
