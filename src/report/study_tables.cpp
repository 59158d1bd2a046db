#include "study_tables.hpp"

#include <fmt/format.h>

#include "numbers.hpp"
#include "study_sentences.hpp"

namespace tribofit {
namespace {

/// The regime and the measures of a motion, behind what `row` holds.
std::vector<std::string> row_of(std::vector<std::string> row, const Settled& settled) {
  row.emplace_back(to_string(settled.regime));
  for (const MeasureInfo& measure : measures()) row.push_back(measure_text(settled, measure));
  return row;
}

}  // namespace

void add_measure_columns(ReportTable& table) {
  for (const MeasureInfo& measure : measures()) {
    table.columns.push_back({with_unit(measure.name, measure.unit), true, 0, measure.heading});
  }
}

ReportTable own_table(const StudiedMachine& of, const SpeedStudy& study) {
  ReportTable table(
      fmt::format("At {}: {}", velocity_text(of.machine.disc_velocity(), of.machine), to_string(study.own.regime)));
  table.text({"measure"}).numbers({"value", "95 % interval"}).text({"unit"}).text({"meaning"}, 1);
  for (std::size_t k = 0; k < measures().size(); ++k) {
    const MeasureInfo& measure = measures()[k];
    const std::string range = range_text(study.own_ranges[k], measure.si);
    table.rows.push_back(
        {measure.name, measure_text(study.own, measure), range.empty() ? "-" : range, measure.unit, measure.meaning});
  }
  return table;
}

ReportTable speed_table(const SpeedStudy& study, std::size_t most) {
  ReportTable table("Over speed");
  table.columns.push_back({"speed [mm/s]", true, 0, "mm/s"});
  table.text({"begun in", "regime"});
  add_measure_columns(table);
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

ReportTable harmonics_table(const Response& study) {
  ReportTable table("Spectra of settled motion");
  table.numbers({"harmonic", "frequency [Hz]", "friction [N]", "displacement [mm]", "velocity [mm/s]"});
  for (std::size_t n = 0; n < study.harmonics.size(); ++n) {
    const ResponseLine& h = study.harmonics[n];
    table.rows.push_back({fmt::format("{}", n + 1), significant(h.frequency, 4), significant(h.force, 4),
                          significant(h.displacement / kMillimetre, 4), significant(h.velocity / kMillimetre, 4)});
  }
  table.folded = table.rows.size() > 30;
  return table;
}

ReportTable elasticity_table(const std::vector<Sensitivity>& study) {
  ReportTable table("Elasticities: per cent of a measure for one per cent of a number");
  table.text({"number"}).numbers({"value"}).text({"unit"});
  for (const MeasureInfo& measure : measures()) table.numbers({measure.name});
  for (const Sensitivity& one : study) {
    std::vector<std::string> row = {one.variable.name, significant(one.base / one.variable.si, 4),
                                    one.variable.unit == "1" ? "" : one.variable.unit};
    for (const double e : one.elasticities) row.push_back(elasticity_text(e));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace tribofit
