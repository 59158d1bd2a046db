#include "tribofit/report/study.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "numbers.hpp"
#include "study_sentences.hpp"
#include "study_tables.hpp"
#include "terminal_text.hpp"

namespace tribofit {
namespace {

void add_machine(const StudiedMachine& of, TerminalText& text) {
  for (const std::string& warning : of.warnings) text.warning(warning);
  text.raw(fmt::format("{}: {}\n", of.source, of.machine.model.name()));
  text.lines(machine_sentences(of));
  if (of.sharpness > 0) text.line(sharpness_text(of));
  text.lines(of.notes);
}

void add_seen(const Settled& settled, TerminalText& text) {
  const std::string seen = seen_sentence(settled);
  if (!seen.empty()) text.line(seen, 2, 4);
}

void add_table(const ReportTable& table, TerminalText& text) {
  text.heading(table.caption);
  text.table(table);
}

Suggestion next(const std::string& purpose, const char* kind, const TerminalOptions& options,
                const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = {"study", kind};
  words.insert(words.end(), more.begin(), more.end());
  return {purpose, command_line(words_of(std::move(words), options.arguments), options.inputs)};
}

}  // namespace

std::string render_study(const StudiedMachine& of, const SpeedStudy& study, const TerminalOptions& options) {
  constexpr std::size_t kSpeeds = 20;
  TerminalText text(options);
  add_machine(of, text);
  add_table(own_table(of, study), text);
  add_seen(study.own, text);
  text.heading("Critical speed");
  text.lines(critical_sentences(of, study), 2, 4);
  const std::string between = bistable_sentence(study.critical);
  if (!between.empty()) text.line(between);
  add_table(speed_table(study, kSpeeds), text);
  text.next(next("to see which number matters", "sensitivity", options));
  return text.take();
}

std::string render_study(const StudiedMachine& of, const std::vector<Portrait>& study, const TerminalOptions& options) {
  TerminalText text(options);
  add_machine(of, text);
  add_table(portraits_table(study), text);
  for (const Portrait& portrait : study) add_seen(portrait.settled, text);
  if (!options.csv_written) {
    text.line(
        "--csv FOLDER writes displacement and velocity: phase_N.csv from the start, cycle_N.csv one settled cycle");
  }
  text.next(next("to see the speed at which stick vanishes", "speed", options));
  return text.take();
}

std::string render_study(const StudiedMachine& of, const Response& study, const TerminalOptions& options) {
  constexpr std::size_t kHarmonics = 8;
  TerminalText text(options);
  add_machine(of, text);
  text.heading("Response to a force");
  text.line(fmt::format("natural frequency {} Hz, damped {} Hz; response frequency {} Hz",
                        significant(study.natural_frequency, 5), significant(study.damped_natural_frequency, 5),
                        significant(study.settled.frequency, 5)));
  text.line(response_sentence(of, study) + " (--csv: response.csv)");
  add_seen(study.settled, text);
  if (study.harmonics.empty()) {
    text.line(fmt::format("no settled vibration, so no spectra ({})", to_string(study.settled.regime)));
  } else {
    const ReportTable table = harmonics_table(study);
    text.heading(table.caption);
    text.table(table, kHarmonics);
    if (table.rows.size() > kHarmonics) {
      text.line(fmt::format("{} of {} shown; --csv writes all (harmonics.csv)", kHarmonics, table.rows.size()));
    }
  }
  text.next(next("to see portraits of the motion", "phase", options));
  return text.take();
}

std::string render_study(const StudiedMachine& of, const std::vector<Sensitivity>& study,
                         const TerminalOptions& options) {
  TerminalText text(options);
  add_machine(of, text);
  add_table(elasticity_table(study), text);
  text.heading("What matters most");
  for (std::size_t k = 0; k < measures().size(); ++k) {
    text.line(measures()[k].name + ": " + ranking_sentence(study, k), 2, 4);
  }
  if (!options.csv_written) text.line("--csv FOLDER writes the sweeps behind these (sensitivity.csv)");
  text.next(next("to vary two numbers at once", "map", options, {"--x", "stiffness", "--y", "mass", "--csv", "map/"}));
  return text.take();
}

std::string render_map(const StudiedMachine& of, const MapRequest& request, const MapRows& rows,
                       const MeasureInfo& measure, const TerminalOptions& options) {
  const auto& all = measures();
  const auto k = static_cast<std::size_t>(
      std::find_if(all.begin(), all.end(), [&](const MeasureInfo& m) { return m.name == measure.name; }) - all.begin());
  const Variable &x = request.x.variable, &y = request.y.variable;
  ReportTable table(fmt::format("{} over {} (across) and {} (down)", with_unit(measure.name, measure.unit),
                                with_unit(x.name, x.unit), with_unit(y.name, y.unit)));
  table.text({""});
  const std::vector<std::size_t> columns = thinned(request.x.values.size(), 8);
  for (const std::size_t i : columns) table.numbers({significant(request.x.values[i] / x.si, 3)});
  for (const std::size_t j : thinned(rows.size(), 12)) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(significant(request.y.values[j] / y.si, 3));
    for (const std::size_t i : columns) {
      const MapCell& cell = rows[j][i];
      row.push_back(cell.regime == Regime::sliding ? "slides" : significant(cell.values[k] / measure.si, 3));
    }
  }
  const std::size_t unsettled = count_of(rows, Regime::not_settled);
  std::size_t cells = 0;
  for (const auto& row : rows) cells += row.size();
  TerminalText text(options);
  add_machine(of, text);
  add_table(table, text);
  text.line(fmt::format("{} cells", cells) +
            (unsettled > 0 ? fmt::format(", {} of which did not settle (their regime says so)", unsettled) : ""));
  text.next(next("to see the speeds at which stick vanishes", "speed", options));
  return text.take();
}

}  // namespace tribofit
