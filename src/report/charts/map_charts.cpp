#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/numbers.hpp"
#include "study_parts.hpp"
#include "styles.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kMostCells = 120;  // to a side

/// Blocks of an axis: the k-th begins at this value, the last ends at the end.
std::vector<std::size_t> blocks_of(std::size_t count) {
  const std::size_t blocks = std::min(count, kMostCells);
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k <= blocks; ++k) begins.push_back(k * count / blocks);
  return begins;
}

std::vector<double> middles(const MapAxis& axis, const std::vector<std::size_t>& begins) {
  std::vector<double> out;
  for (std::size_t k = 0; k + 1 < begins.size(); ++k) {
    out.push_back(0.5 * (axis.values[begins[k]] + axis.values[begins[k + 1] - 1]) / axis.variable.si);
  }
  return out;
}

using Rows = std::vector<std::vector<MapCell>>;

/// The largest value of a block; NaN where it holds none.
double largest(const Rows& rows, std::size_t measure, std::size_t y_begin, std::size_t y_end, std::size_t x_begin,
               std::size_t x_end) {
  double out = std::nan("");
  for (std::size_t j = y_begin; j < std::min(y_end, rows.size()); ++j) {
    for (std::size_t i = x_begin; i < std::min(x_end, rows[j].size()); ++i) {
      const std::vector<double>& values = rows[j][i].values;
      const double value = measure < values.size() ? values[measure] : std::nan("");
      if (std::isfinite(value) && !(value <= out)) out = value;
    }
  }
  return out;
}

ChartAxis axis_for(const MapAxis& axis) {
  return {.quantity = axis.variable.name,
          .unit = axis.variable.unit,
          .low = axis.values.front() / axis.variable.si,
          .high = axis.values.back() / axis.variable.si};
}

Chart map_chart(const StudiedMachine& of, const MapRequest& request, const Rows& rows, std::size_t measure) {
  const MeasureInfo& info = measures()[measure];
  Chart chart{.id = "map-" + info.name,
              .title = fmt::format("{} over {} and {}", info.name, request.x.variable.name, request.y.variable.name),
              .x = axis_for(request.x),
              .panels = {{axis_for(request.y)}},
              .height = 420,
              .half = true};
  chart.title[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(chart.title[0])));
  const std::vector<std::size_t> across = blocks_of(request.x.values.size()), down = blocks_of(request.y.values.size());
  HeatMap map{middles(request.x, across), middles(request.y, down), {}, info.name, info.unit};
  for (std::size_t j = 0; j + 1 < down.size(); ++j) {
    std::vector<double>& row = map.z.emplace_back();
    for (std::size_t i = 0; i + 1 < across.size(); ++i) {
      row.push_back(largest(rows, measure, down[j], down[j + 1], across[i], across[i + 1]) / info.si);
    }
  }
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

ReportTable regimes_table(const Rows& rows) {
  ReportTable table("Cells");
  table.text({"regime"}).numbers({"cells"});
  for (const Regime regime : {Regime::stick_slip, Regime::vibration, Regime::sliding, Regime::not_settled}) {
    std::size_t count = 0;
    for (const auto& row : rows) {
      count += static_cast<std::size_t>(
          std::count_if(row.begin(), row.end(), [&](const MapCell& c) { return c.regime == regime; }));
    }
    if (count > 0) table.rows.push_back({std::string(to_string(regime)), grouped(count)});
  }
  return table;
}

ReportTable extremes_table(const MapRequest& request, const Rows& rows) {
  const auto heading = [](const Variable& v) { return with_unit(v.name, v.unit); };
  ReportTable table("Least and largest of each measure");
  table.text({"measure", ""}).numbers({"value"}).text({"unit"});
  table.numbers({heading(request.x.variable), heading(request.y.variable)});
  for (std::size_t k = 0; k < measures().size(); ++k) {
    for (const bool most : {false, true}) {
      double best = std::nan("");
      std::size_t at_i = 0, at_j = 0;
      for (std::size_t j = 0; j < rows.size(); ++j) {
        for (std::size_t i = 0; i < rows[j].size(); ++i) {
          const double value = k < rows[j][i].values.size() ? rows[j][i].values[k] : std::nan("");
          if (!std::isfinite(value) || (most ? value <= best : value >= best)) continue;
          best = value, at_i = i, at_j = j;
        }
      }
      if (!std::isfinite(best)) continue;
      table.rows.push_back({most ? "" : measures()[k].name, most ? "largest" : "least",
                            significant(best / measures()[k].si, 4), measures()[k].unit,
                            significant(request.x.values[at_i] / request.x.variable.si, 4),
                            significant(request.y.values[at_j] / request.y.variable.si, 4)});
    }
  }
  return table;
}

}  // namespace

Report report_of(const StudiedMachine& of, const MapRequest& request, const Rows& rows, const ReportOptions& options) {
  const std::size_t nx = request.x.values.size(), ny = request.y.values.size();
  std::string lead = fmt::format("{} and {} over {} x {} cells.", request.x.variable.name, request.y.variable.name,
                                 grouped(nx), grouped(ny));
  lead[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(lead[0])));
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
