#include <fmt/format.h>

#include <cmath>

#include "parts.hpp"

namespace tribofit {
namespace {

/// What matters most for one measure (an index in measures()): "stiffness (-0.512), mass (+0.5)".
std::string ranking_sentence(const std::vector<Sensitivity>& study, std::size_t measure) {
  std::vector<std::string> list;
  for (const std::size_t i : ranked(study, measure)) {
    const double e = study[i].elasticities[measure];
    if (!std::isnan(e)) list.push_back(fmt::format("{} ({})", study[i].variable.name, with_sign(e, 3)));
  }
  return list.empty() ? "nothing can be said here" : fmt::format("{}", fmt::join(list, ", "));
}

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

constexpr std::size_t kShown = 6;  // sweeps that are not switched off at first

/// A measure over each variable, those that matter most first.
Chart sweep_chart(const std::vector<Sensitivity>& study, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart = half_chart("sweep-" + info.name, "The " + info.name + " over each number of the machine",
                           {.quantity = "value over that of the machine", .unit = "1", .logarithmic = true},
                           {info.name, info.unit});
  chart.marks = {{1, true, Dash::dotted, "the machine", 0}};
  chart.height = 380;
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

Chart bar_chart(const std::vector<Sensitivity>& study, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart = half_chart("elasticity-" + info.name, "What moves the " + info.name,
                           {"change of the " + info.name + " for 1 % of the number", "%"}, {});
  ChartAxis& names = chart.panels[0].axis;
  names.falling = true;  // the largest stands on top
  ChartBars bars{info.name, {}};
  for (const std::size_t i : ranked(study, measure)) {
    const double e = study[i].elasticities[measure];
    if (!std::isfinite(e)) continue;
    names.names.push_back(study[i].variable.name);
    bars.values.push_back(e);
  }
  chart.bars.push_back(std::move(bars));
  chart.height = 110 + 26 * static_cast<int>(names.names.size());
  return chart;
}

}  // namespace

std::string study_json(const StudiedMachine& studied, const std::vector<Sensitivity>& study,
                       const JsonOptions& options) {
  const auto variable = [](const Sensitivity& one) {
    Json elasticities = Json::object(), sweep = Json::array();
    for (std::size_t k = 0; k < one.elasticities.size(); ++k) {
      elasticities[measures()[k].name] = number(one.elasticities[k]);
    }
    for (std::size_t i = 0; i < one.values.size(); ++i) {
      Json point = object("value", one.values[i] / one.variable.si);
      point.update(explained_json(one.settled[i]));
      sweep.push_back(point);
    }
    return object("name", one.variable.name, "unit", one.variable.unit, "value", one.base / one.variable.si,
                  "elasticities", elasticities, "sweep", sweep);
  };
  Json order = Json::object();
  for (std::size_t k = 0; k < measures().size(); ++k) {
    order[measures()[k].name] = list_of(ranked(study, k), [&](std::size_t i) { return Json(study[i].variable.name); });
  }
  return study_text(studied, "sensitivity", object("variables", list_of(study, variable), "ranked", order), options);
}

void write_study(const std::string& folder, const std::vector<Sensitivity>& study) {
  WholeFolder files(folder);
  struct Row {
    const Sensitivity& sweep;
    std::size_t i;
  };
  const CsvColumn<Row> name = {"variable", [](const Row&r) { return r.sweep.variable.name; }},
                       unit = {"unit", [](const Row&r) { return r.sweep.variable.unit; }};
  std::vector<CsvColumn<Row>> swept_columns = {
      name,
      unit,
      {"value", [](const Row& r) { return r.sweep.values[r.i] / r.sweep.variable.si; }},
      {"relative_value", [](const Row& r) { return r.sweep.values[r.i] / r.sweep.base; }},
      {"regime" + measure_columns(), [](const Row& r) { return settled_json(r.sweep.settled[r.i]); }},
  };
  std::vector<CsvColumn<Row>> ranked_columns = {
      name, unit, {"value", [](const Row& r) { return r.sweep.base / r.sweep.variable.si; }}};
  for (std::size_t k = 0; k < measures().size(); ++k) {
    ranked_columns.emplace_back(measures()[k].name, [k](const Row& r) { return r.sweep.elasticities[k]; });
  }
  CsvTable sweeps(files, "sensitivity.csv", std::move(swept_columns)),
      table(files, "elasticities.csv", std::move(ranked_columns));
  for (const Sensitivity& one : study) {
    for (std::size_t i = 0; i < one.values.size(); ++i) sweeps.row({one, i});
    table.row({one, 0});
  }
  files.commit();
}

Report report_of(const StudiedMachine& studied, const std::vector<Sensitivity>& study, const ReportOptions& options) {
  std::vector<std::string> lead;
  ReportSection bars{"elasticities", "Ranked elasticities", {}}, sweeps{"sweeps", "Each measure over each number", {}};
  for (std::size_t k = 0; k < measures().size(); ++k) {
    bars.add(bar_chart(study, k));
    sweeps.add(sweep_chart(study, k));
    const std::vector<std::size_t> order = ranked(study, k);
    if (order.empty() || !std::isfinite(study[order.front()].elasticities[k])) continue;
    lead.push_back(fmt::format("{} answers most to {} ({} % for 1 %)", measures()[k].name,
                               study[order.front()].variable.name, with_sign(study[order.front()].elasticities[k], 3)));
  }
  bars.add(elasticity_table(study));
  bars.heading("What matters most");
  for (std::size_t k = 0; k < measures().size(); ++k) {
    bars.item(measures()[k].name + ": " + ranking_sentence(study, k));
  }
  if (!options.csv_written) bars.plain("--csv FOLDER writes the sweeps behind these (sensitivity.csv)");
  return study_report(studied, "sensitivity", "Which number matters",
                      lead.empty() ? "At this machine no measure has an elasticity."
                                   : capitalised(fmt::format("{}.", fmt::join(lead, "; "))),
                      {std::move(bars), std::move(sweeps)},
                      {"to vary two numbers at once", "map", {"--x", "stiffness", "--y", "mass", "--csv", "map/"}},
                      options);
}

}  // namespace tribofit
