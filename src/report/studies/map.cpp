#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "parts.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kMostCells = 120;  // to a side

ChartAxis axis_for(const MapAxis& axis) {
  return {.quantity = axis.variable.name,
          .unit = axis.variable.unit,
          .low = axis.values.front() / axis.variable.si,
          .high = axis.values.back() / axis.variable.si};
}

Chart map_chart(const StudiedMachine& studied, const MapRequest& request, const MapRows& rows, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  const Variable &across = request.x.variable, &up = request.y.variable;
  Chart chart =
      half_chart("map-" + info.name, capitalised(fmt::format("{} over {} and {}", info.name, across.name, up.name)),
                 axis_for(request.x), axis_for(request.y));
  chart.panels[0].part = chart_detail.square;
  const CoarseMap coarse = coarse_map(request, rows, measure, kMostCells);
  HeatMap map{in_unit(coarse.x, across.si), in_unit(coarse.y, up.si), {}, info.name, info.unit};
  for (const std::vector<double>& row : coarse.z) map.z.push_back(in_unit(row, info.si));
  const bool any_gap = std::any_of(map.z.begin(), map.z.end(), [](const std::vector<double>& row) {
    return std::any_of(row.begin(), row.end(), [](double z) { return !std::isfinite(z); });
  });
  if (any_gap) chart.note = "White: nothing there, the block slides or its motion did not settle.";
  chart.map = std::move(map);
  ChartLine& edge = chart.line("edge of stick-slip", dots(Colour::black, Symbol::circle, 3));
  const std::size_t every = 1 + std::max(request.x.values.size(), request.y.values.size()) / kMostCells;
  for (const auto& [at_x, at_y] : edge_of_stick_slip(request, rows, every)) {
    edge.add(at_x / across.si, at_y / up.si);
  }
  const double x = value_of(studied.machine, across.name) / across.si, y = value_of(studied.machine, up.name) / up.si;
  if (x >= chart.x.low && x <= chart.x.high && y >= chart.panels[0].low && y <= chart.panels[0].high) {
    chart.lines.push_back({"the machine as it is", {x}, {y}, dots(Colour::red, Symbol::cross, 11)});
  }
  return chart;
}

ReportTable regimes_table(const MapRows& rows) {
  ReportTable table("Cells");
  table.text({"regime"}).numbers({"cells"});
  for (const Regime regime : kRegimes) {
    const std::size_t count = count_of(rows, regime);
    if (count > 0) table.rows.push_back({std::string(to_string(regime)), grouped(count)});
  }
  return table;
}

/// How much of the map sticks.
std::string headline(const MapRequest& request, const MapRows& rows) {
  const std::size_t all = request.x.values.size() * rows.size(), sticking = count_of(rows, Regime::stick_slip);
  const std::string cells = grouped(request.x.values.size()) + " x " + grouped(rows.size()) + " cells";
  const std::string what = sticking == 0     ? "No stick-slip anywhere in " + cells
                           : sticking == all ? "Stick-slip everywhere in " + cells
                                             : "Stick-slip in " + grouped(sticking) + " of " + grouped(all) + " cells";
  return fmt::format("{} over {} and {}.", what, request.x.variable.name, request.y.variable.name);
}

ReportTable extremes_table(const MapRequest& request, const MapRows& rows) {
  const Variable &x = request.x.variable, &y = request.y.variable;
  ReportTable table("Least and largest of each measure");
  table.text({"measure", ""}).numbers({"value"}).text({"unit"});
  table.numbers({with_unit(x.name, x.unit), with_unit(y.name, y.unit)});
  for (std::size_t k = 0; k < measures().size(); ++k) {
    for (const bool most : {false, true}) {
      const auto best = extreme_of(request, rows, k, most);
      if (!best) continue;
      table.rows.push_back({most ? "" : measures()[k].name, most ? "largest" : "least",
                            significant(best->value / measures()[k].si, 4), measures()[k].unit,
                            significant(best->x / x.si, 4), significant(best->y / y.si, 4)});
    }
  }
  return table;
}

/// A measure as rows of values, thinned to what a terminal shows.
ReportTable values_table(const MapRequest& request, const MapRows& rows, const MeasureInfo& measure) {
  constexpr std::size_t kColumns = 8, kRows = 12;
  const auto& all = measures();
  const auto k = static_cast<std::size_t>(std::ranges::find(all, measure.name, &MeasureInfo::name) - all.begin());
  const Variable &x = request.x.variable, &y = request.y.variable;
  ReportTable table(fmt::format("{} over {} (across) and {} (down)", with_unit(measure.name, measure.unit),
                                with_unit(x.name, x.unit), with_unit(y.name, y.unit)));
  table.text({""});
  const std::vector<std::size_t> columns = thinned(request.x.values.size(), kColumns);
  for (const std::size_t i : columns) table.numbers({significant(request.x.values[i] / x.si, 3)});
  for (const std::size_t j : thinned(rows.size(), kRows)) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row.push_back(significant(request.y.values[j] / y.si, 3));
    for (const std::size_t i : columns) {
      const MapCell& cell = rows[j][i];
      row.push_back(cell.regime == Regime::sliding ? "slides" : significant(cell.values[k] / measure.si, 3));
    }
  }
  return table;
}

}  // namespace

std::string map_json(const StudiedMachine& studied, const MapRequest& request, const MapRows& rows,
                     const JsonOptions& options) {
  const auto axis = [](const MapAxis& a) {
    return object("name", a.variable.name, "unit", a.variable.unit, "values",
                  list_of(a.values, [&](double v) { return number(v / a.variable.si); }));
  };
  const auto grid = [&](auto&& value) {
    return list_of(rows, [&](const std::vector<MapCell>& row) { return list_of(row, value); });
  };
  Json by_measure = Json::object();
  for (std::size_t k = 0; k < measures().size(); ++k) {
    by_measure[measures()[k].column] =
        grid([&](const MapCell& cell) { return number(cell.values[k] / measures()[k].si); });
  }
  const Json regimes = grid([](const MapCell& cell) { return Json(to_string(cell.regime)); });
  return study_text(studied, "map",
                    object("x", axis(request.x), "y", axis(request.y), "regimes", regimes, "measures", by_measure),
                    options);
}

Report report_of(const StudiedMachine& studied, const MapRequest& request, const MapRows& rows,
                 const MeasureInfo& measure, const ReportOptions& options) {
  const std::size_t nx = request.x.values.size(), ny = request.y.values.size();
  std::string lead = headline(request, rows);
  if (nx > kMostCells || ny > kMostCells) {
    lead += " Where a colour stands for several cells, it is that of the largest value among them; --csv writes all.";
  }
  ReportSection section{"maps", "Maps", {}};
  for (std::size_t k = 0; k < measures().size(); ++k) {
    section.add(map_chart(studied, request, rows, k));
  }
  section.add(values_table(request, rows, measure), Medium::terminal);
  section.plain(headline(request, rows), Medium::terminal);
  section.add(extremes_table(request, rows));
  section.add(regimes_table(rows));
  return study_report(studied, "map", std::move(lead), {std::move(section)}, options);
}

}  // namespace tribofit
