#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

#include "tribofit/study/map.hpp"

namespace tribofit {
namespace {

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
  MapCell cell;
  std::size_t comma = line.find(',');
  bool named = false;
  for (const Regime r : kRegimes) {
    if (line.substr(0, comma) != to_string(r)) continue;
    cell.regime = r;
    named = true;
  }
  if (!named) return std::nullopt;
  for (const MeasureInfo& measure : measures()) {
    const std::size_t begin = comma + 1;
    comma = line.find(',', begin);
    if (comma == std::string::npos) return std::nullopt;
    double value = std::numeric_limits<double>::quiet_NaN();
    if (comma > begin && std::from_chars(line.data() + begin, line.data() + comma, value).ptr != line.data() + comma) {
      return std::nullopt;
    }
    cell.values.push_back(value * measure.si);
  }
  return cell;
}

}  // namespace

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
