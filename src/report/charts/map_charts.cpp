#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "study_parts.hpp"
#include "styles.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kMostCells = 120;  // to a side

/// Values in the unit of a variable.
std::vector<double> shown(const std::vector<double>& values, const Variable& variable) {
  return in_unit(values, variable.si);
}

ChartAxis axis_for(const MapAxis& axis) {
  return {.quantity = axis.variable.name,
          .unit = axis.variable.unit,
          .low = axis.values.front() / axis.variable.si,
          .high = axis.values.back() / axis.variable.si};
}

Chart map_chart(const StudiedMachine& of, const MapRequest& request, const MapRows& rows, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart{.id = "map-" + info.name,
              .title = capitalised(
                  fmt::format("{} over {} and {}", info.name, request.x.variable.name, request.y.variable.name)),
              .x = axis_for(request.x),
              .panels = {{axis_for(request.y)}},
              .height = 420,
              .half = true};
  const CoarseMap coarse = coarse_map(request, rows, measure, kMostCells);
  HeatMap map{shown(coarse.x, request.x.variable), shown(coarse.y, request.y.variable), {}, info.name, info.unit};
  for (const std::vector<double>& row : coarse.z) map.z.push_back(in_unit(row, info.si));
  const bool any_gap = std::any_of(map.z.begin(), map.z.end(), [](const std::vector<double>& row) {
    return std::any_of(row.begin(), row.end(), [](double z) { return !std::isfinite(z); });
  });
  if (any_gap) chart.note = "White: nothing there, the block slides or its motion did not settle.";
  chart.map = std::move(map);
  ChartLine edge{.name = "edge of stick-slip", .stroke = dots(Colour::black, Symbol::circle, 3)};
  const std::size_t every = 1 + std::max(request.x.values.size(), request.y.values.size()) / kMostCells;
  for (const auto& [at_x, at_y] : edge_of_stick_slip(request, rows, every)) {
    edge.add(at_x / request.x.variable.si, at_y / request.y.variable.si);
  }
  if (!edge.x.empty()) chart.lines.push_back(std::move(edge));
  const double x = value_of(of.machine, request.x.variable.name) / request.x.variable.si;
  const double y = value_of(of.machine, request.y.variable.name) / request.y.variable.si;
  if (x >= chart.x.low && x <= chart.x.high && y >= chart.panels[0].axis.low && y <= chart.panels[0].axis.high) {
    chart.lines.push_back({"the machine", {x}, {y}, dots(Colour::red, Symbol::cross, 11)});
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

ReportTable extremes_table(const MapRequest& request, const MapRows& rows) {
  const auto heading = [](const Variable& v) { return with_unit(v.name, v.unit); };
  ReportTable table("Least and largest of each measure");
  table.text({"measure", ""}).numbers({"value"}).text({"unit"});
  table.numbers({heading(request.x.variable), heading(request.y.variable)});
  for (std::size_t k = 0; k < measures().size(); ++k) {
    for (const bool most : {false, true}) {
      const auto best = extreme_of(request, rows, k, most);
      if (!best) continue;
      table.rows.push_back({most ? "" : measures()[k].name, most ? "largest" : "least",
                            significant(best->value / measures()[k].si, 4), measures()[k].unit,
                            significant(best->x / request.x.variable.si, 4),
                            significant(best->y / request.y.variable.si, 4)});
    }
  }
  return table;
}

}  // namespace

Report report_of(const StudiedMachine& of, const MapRequest& request, const MapRows& rows,
                 const ReportOptions& options) {
  const std::size_t nx = request.x.values.size(), ny = request.y.values.size();
  std::string lead = capitalised(fmt::format("{} and {} over {} x {} cells.", request.x.variable.name,
                                             request.y.variable.name, grouped(nx), grouped(ny)));
  if (nx > kMostCells || ny > kMostCells) {
    lead += " Where a colour stands for several cells, it is that of the largest value among them; --csv writes all.";
  }
  Report report = study_report(of, "map", "Map of the motion", std::move(lead), options);
  ReportSection& section = report.sections.emplace_back(ReportSection{"maps", "Maps", {}});
  for (std::size_t k = 0; k < measures().size(); ++k) section.items.emplace_back(map_chart(of, request, rows, k));
  section.items.emplace_back(extremes_table(request, rows));
  section.items.emplace_back(regimes_table(rows));
  add_machine_sections(of, "map", options, report);
  return report;
}

}  // namespace tribofit
