#include "tribofit/study/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <mutex>
#include <string>

#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/output/digits.hpp"

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
      const std::string unit = axis.variable.unit == "1" ? "" : " " + std::string(axis.variable.unit);
      throw InputError(axis.variable.name + " = " + general(value / axis.variable.si) + unit + ": " + error.what(),
                       "let the axis begin and end where there is a machine");
    }
  }
}

std::string number(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

/// The abscissa and the ordinate of a cell: how its line begins.
std::string place_of(const MapRequest& request, std::size_t column, std::size_t row) {
  return number(request.x.values[column] / request.x.variable.si) + "," +
         number(request.y.values[row] / request.y.variable.si) + ",";
}

/// "stiffness_N_per_mm", as columns are called.
std::string column_of(const Variable& variable) {
  const std::string text = variable.name + (variable.unit == "1" ? "" : "_" + variable.unit);
  std::string out;
  for (const char c : text) {
    if (c == '/') {
      out += variable.unit.find('/') == 0 ? "1_per_" : "_per_";
    } else {
      out += c == ' ' || c == '-' ? '_' : c;
    }
  }
  return out;
}

/// A cell of a map from the rest of its line; nothing where that is not one.
std::optional<MapCell> map_cell_from(const std::string& line) {
  std::size_t comma = line.find(',');
  const auto regime =
      std::find_if(kRegimes.begin(), kRegimes.end(), [&](Regime r) { return line.substr(0, comma) == to_string(r); });
  if (regime == kRegimes.end()) return std::nullopt;
  MapCell cell{*regime, {}};
  for (const MeasureInfo& measure : measures()) {
    const std::size_t begin = comma + 1;
    comma = line.find(',', begin);
    if (comma == std::string::npos) return std::nullopt;
    double value = std::nan("");
    if (comma > begin && std::from_chars(line.data() + begin, line.data() + comma, value).ptr != line.data() + comma) {
      return std::nullopt;
    }
    cell.values.push_back(value * measure.si);
  }
  return cell;
}

/// At most so many blocks of an axis: the k-th goes from begins[k] to begins[k + 1].
struct AxisBlocks {
  AxisBlocks(const std::vector<double>& values, std::size_t most) {
    const std::size_t count = std::min(values.size(), most);
    for (std::size_t k = 0; k <= count; ++k) begins.push_back(k * values.size() / count);
    for (std::size_t k = 0; k < count; ++k) middles.push_back(0.5 * (values[begins[k]] + values[begins[k + 1] - 1]));
  }
  std::vector<std::size_t> begins;
  std::vector<double> middles;
};

double value_in(const MapCell& cell, std::size_t measure) {
  return measure < cell.values.size() ? cell.values[measure] : std::nan("");
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

std::vector<std::pair<double, double>> edge_of_stick_slip(const MapRequest& request, const MapRows& rows,
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

CoarseMap coarse_map(const MapRequest& request, const MapRows& rows, std::size_t measure, std::size_t most) {
  const AxisBlocks across(request.x.values, most), down(request.y.values, most);
  CoarseMap map{across.middles, down.middles, {}};
  map.z.assign(map.y.size(), std::vector<double>(map.x.size(), std::nan("")));
  for (std::size_t b = 0; b < map.y.size(); ++b) {
    for (std::size_t j = down.begins[b]; j < std::min(down.begins[b + 1], rows.size()); ++j) {
      for (std::size_t a = 0; a < map.x.size(); ++a) {
        double& largest = map.z[b][a];
        for (std::size_t i = across.begins[a]; i < std::min(across.begins[a + 1], rows[j].size()); ++i) {
          const double value = value_in(rows[j][i], measure);
          if (std::isfinite(value) && !(value <= largest)) largest = value;
        }
      }
    }
  }
  return map;
}

std::optional<MapExtreme> extreme_of(const MapRequest& request, const MapRows& rows, std::size_t measure,
                                     bool largest) {
  std::optional<MapExtreme> best;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    for (std::size_t i = 0; i < rows[j].size(); ++i) {
      const double value = value_in(rows[j][i], measure);
      if (!std::isfinite(value) || (best && (largest ? value <= best->value : value >= best->value))) continue;
      best = {value, request.x.values[i], request.y.values[j]};
    }
  }
  return best;
}

std::size_t count_of(const MapRows& rows, Regime regime) {
  std::size_t count = 0;
  for (const std::vector<MapCell>& row : rows) {
    count += static_cast<std::size_t>(
        std::count_if(row.begin(), row.end(), [&](const MapCell& c) { return c.regime == regime; }));
  }
  return count;
}

std::string map_csv_header(const MapRequest& request) {
  std::string text = column_of(request.x.variable) + "," + column_of(request.y.variable) + ",regime";
  for (const MeasureInfo& measure : measures()) text += "," + measure.column;
  return text + "\n";
}

std::string map_csv_row(const MapRequest& request, std::size_t row, const std::vector<MapCell>& cells) {
  std::string text;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    text += place_of(request, i, row) + std::string(to_string(cells[i].regime));
    for (std::size_t k = 0; k < cells[i].values.size(); ++k) {
      text += "," + number(cells[i].values[k] / measures()[k].si);
    }
    text += "\n";
  }
  return text;
}

std::vector<MapCell> map_row_from_csv(const MapRequest& request, std::size_t row, const std::string& text) {
  std::vector<MapCell> all;
  std::size_t at = 0;
  for (std::size_t i = 0; i < request.x.values.size(); ++i) {
    const std::string front = place_of(request, i, row);
    const std::size_t end = text.find('\n', at);
    if (text.compare(at, front.size(), front) != 0 || end == std::string::npos) return {};
    const auto known = map_cell_from(text.substr(at + front.size(), end - at - front.size()) + ",");
    if (!known) return {};
    all.push_back(*known);
    at = end + 1;
  }
  return at == text.size() ? all : std::vector<MapCell>{};
}

}  // namespace tribofit
