#include <fmt/format.h>

#include <cmath>

#include "parts.hpp"

namespace tribofit {
namespace {

ReportTable elasticity_table(const std::vector<Sensitivity>& study) {
  ReportTable table("Elasticities: per cent of a measure for one per cent of a number");
  table.text({"number"}).numbers({"value"}).text({"unit"});
  for (const MeasureInfo& measure : measures()) {
    table.numbers({measure.name});
    if (measure.name == "peak-to-peak") table.columns.back().brief = "p-to-p";  // or it is wider than a terminal
  }
  for (const Sensitivity& one : study) {
    std::vector<std::string> row = {one.variable.name, significant(one.base / one.variable.si, 4),
                                    one.variable.unit == "1" ? "" : one.variable.unit};
    for (const double e : one.elasticities) row.push_back(with_sign(e, 3));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// A value of each measure under its name.
Json by_measure(const std::vector<double>& values) {
  Json json = Json::object();
  for (std::size_t k = 0; k < values.size(); ++k) json[measures()[k].name] = number(values[k]);
  return json;
}

/// A measure over each variable, those that matter most first.
Chart sweep_chart(const std::vector<Sensitivity>& study, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart = half_chart("sweep-" + info.name, "The " + info.name + " over each number of the machine",
                           {.quantity = "value over that of the machine", .unit = "1", .logarithmic = true},
                           {info.name, info.unit});
  chart.marks = {{1, true, Dash::dotted, "the machine", 0}};
  constexpr std::size_t kShown = 6;  // that are not switched off at first
  std::size_t k = 0;
  for (const std::size_t i : ranked(study, measure)) {
    const Sensitivity& one = study[i];
    if (!(one.base != 0)) continue;
    ChartLine& line = chart.line(one.variable.name, stroke_of(k));
    line.x = in_unit(one.values, one.base);
    for (const Settled& s : one.settled) line.y.push_back(s.*info.value / info.si);
    line.shown = k++ < kShown;
  }
  return chart;
}

Chart elasticity_chart(const std::vector<Sensitivity>& study, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart = half_chart("elasticity-" + info.name, "What moves the " + info.name,
                           {.quantity = "change of the " + info.name + " for 1 % of the number", .unit = "%"}, {});
  std::vector<std::string>& names = chart.panels[0].names;
  ChartLine& line = chart.line(info.name, dots(Colour::blue, Symbol::circle, 8));
  const std::vector<std::size_t> order = ranked(study, measure);
  for (auto i = order.rbegin(); i != order.rend(); ++i) {  // the largest on top
    const double e = study[*i].elasticities[measure];
    if (!std::isfinite(e)) continue;
    line.add(e, static_cast<double>(names.size()));
    names.push_back(study[*i].variable.name);
  }
  chart.marks = {{0, true, Dash::solid}};
  chart.x.from_zero = true;
  return chart;
}

}  // namespace

std::string study_json(const StudiedMachine& studied, const std::vector<Sensitivity>& study,
                       const JsonOptions& options) {
  const auto variable = [](const Sensitivity& one) {
    Json sweep = Json::array();
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      sweep.push_back(object("value", one.values[i] / one.variable.si));
      sweep.back().update(explained_json(one.settled[i]));
    }
    return object("name", one.variable.name, "unit", one.variable.unit, "value", one.base / one.variable.si,
                  "elasticities", by_measure(one.elasticities), "sweep", std::move(sweep));
  };
  Json order = Json::object();
  for (std::size_t k = 0; k < measures().size(); ++k) {
    order[measures()[k].name] = list_of(ranked(study, k), [&](std::size_t i) { return Json(study[i].variable.name); });
  }
  return study_text(studied, "sensitivity", object("variables", list_of(study, variable), "ranked", order), options);
}

void write_study(const std::string& folder, const std::vector<Sensitivity>& study) {
  WholeFolder files(folder);
  const auto row_of = [](const Sensitivity& one, double value) {
    return object("variable", one.variable.name, "unit", one.variable.unit, "value", value / one.variable.si);
  };
  std::vector<Json> swept;
  for (const Sensitivity& one : study) {
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      Json& row = swept.emplace_back(row_of(one, one.values[i]));
      row["relative_value"] = number(one.values[i] / one.base);
      row.update(settled_json(one.settled[i]));
    }
  }
  write_rows(files, "sensitivity.csv", swept.size(), [&](std::size_t k) { return swept[k]; });
  write_rows(files, "elasticities.csv", study.size(), [&](std::size_t k) {
    Json row = row_of(study[k], study[k].base);
    row.update(by_measure(study[k].elasticities));
    return row;
  });
  files.commit();
}

Report report_of(const StudiedMachine& studied, const std::vector<Sensitivity>& study, const ReportOptions& options) {
  std::vector<std::string> lead;
  ReportSection ranking{"elasticities", "Ranked elasticities", {}},
      sweeps{"sweeps", "Each measure over each number", {}};
  for (std::size_t k = 0; k < measures().size(); ++k) {
    ranking.add(elasticity_chart(study, k));
    sweeps.add(sweep_chart(study, k));
    const std::vector<std::size_t> order = ranked(study, k);
    if (order.empty() || !std::isfinite(study[order.front()].elasticities[k])) continue;
    const Sensitivity& first = study[order.front()];
    lead.push_back(fmt::format("{} answers most to {} ({} % for 1 %)", measures()[k].name, first.variable.name,
                               with_sign(first.elasticities[k], 3)));
  }
  ranking.add(elasticity_table(study));
  const std::string said = lead.empty() ? "At this machine no measure has an elasticity."
                                        : capitalised(fmt::format("{}.", fmt::join(lead, "; ")));
  ranking.plain(said, Medium::terminal);
  if (!options.csv_written) ranking.plain("--csv FOLDER writes the sweeps behind these (sensitivity.csv)");
  return study_report(studied, "sensitivity", said, {std::move(ranking), std::move(sweeps)}, options);
}

}  // namespace tribofit
