#include "tribofit/study/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit {

namespace {

Machine cell_of(const MapRequest& request, double x, double y) {
  return with_values(request.machine, request.x.variable.name, x, request.y.variable.name, y);
}

void check_axis(const MapRequest& request, const MapAxis& axis) {
  if (axis.values.empty()) {
    throw InputError("the axis '" + axis.variable.name + "' has no values", "give e.g. stiffness=8N/mm..20N/mm:100");
  }
  for (const double value : axis.values) {
    try {
      steady_sliding(with_value(request.machine, axis.variable.name, value));
    } catch (const InputError& error) {
      throw InputError(fmt::format("{} = {:g} {}: {}", axis.variable.name, value / axis.variable.si, axis.variable.unit,
                                   error.what()),
                       "let the axis begin and end where there is a machine");
    }
  }
}

}  // namespace

void check_map(const MapRequest& request) {
  if (request.x.variable.name == request.y.variable.name) {
    throw InputError("both axes of the map are '" + request.x.variable.name + "'", "name two different ones");
  }
  check_axis(request, request.x);
  check_axis(request, request.y);
  cell_of(request, request.x.values.front(), request.y.values.front());  // two that can be set at once
}

void compute_map(const MapRequest& request, const std::vector<bool>& done, int threads,
                 const std::function<bool(std::size_t row, const std::vector<MapCell>& cells)>& on_row) {
  check_map(request);
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < request.y.values.size(); ++row) {
    if (row >= done.size() || !done[row]) rows.push_back(row);
  }
  std::mutex mutex;
  std::atomic<bool> goes_on = true;
  run_tasks(rows.size(), threads, [&](std::size_t i) {
    if (!goes_on) return;
    std::vector<MapCell> cells;
    for (const double x : request.x.values) {
      const Settled settled = settle(cell_of(request, x, request.y.values[rows[i]]), request.settle);
      MapCell& cell = cells.emplace_back();
      cell.regime = settled.regime;
      for (const MeasureInfo& measure : measures()) cell.values.push_back(settled.*measure.value);
    }
    const std::lock_guard lock(mutex);
    if (goes_on && !on_row(rows[i], cells)) goes_on = false;
  });
}

std::vector<std::pair<double, double>> edge_of_stick_slip(const MapRequest& request,
                                                          const std::vector<std::vector<MapCell>>& rows,
                                                          std::size_t every) {
  std::vector<std::pair<double, double>> edge;
  const auto sticks = [](const MapCell& cell) { return cell.regime == Regime::stick_slip; };
  const std::vector<double>&x = request.x.values, &y = request.y.values;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (std::size_t i = 0; i < rows[j].size(); ++i) {
      const bool here = sticks(rows[j][i]);
      if (j % every == 0 && i + 1 < rows[j].size() && here != sticks(rows[j][i + 1])) {
        edge.emplace_back(0.5 * (x[i] + x[i + 1]), y[j]);
      }
      if (i % every == 0 && j + 1 < rows.size() && i < rows[j + 1].size() && here != sticks(rows[j + 1][i])) {
        edge.emplace_back(x[i], 0.5 * (y[j] + y[j + 1]));
      }
    }
  }
  return edge;
}

}  // namespace tribofit
