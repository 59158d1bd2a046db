#include "tribofit/oscillator/fingerprint.hpp"
#include <fmt/format.h>
#include "tribofit/report/terminal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace tribofit {
namespace {

constexpr std::size_t kRows = 13, kMargin = 11;

struct PlotRange {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  /// Cell 0 .. count-1.
  std::size_t cell(double x, std::size_t count) const {
    return static_cast<std::size_t>(std::lround((x - low) / (high - low) * static_cast<double>(count - 1)));
  }
};

PlotRange range_of(const Fingerprint& print, std::vector<double> FingerprintCloud::*values, double si) {
  PlotRange range;
  for (const FingerprintCloud& cloud : print.clouds) {
    for (const double x : cloud.*values) range.take(x / si);
  }
  if (!(range.high - range.low > 1e-9 * std::max(1.0, std::abs(range.high)))) {  // flat, or nothing at all
    const double middle = std::isfinite(range.low) ? range.low : 0;
    range = {middle - std::max(0.01, 0.01 * std::abs(middle)), middle + std::max(0.01, 0.01 * std::abs(middle))};
  }
  return range;
}

std::string with_unit(const FingerprintAxis& axis) {
  return axis.unit.empty() ? axis.label : axis.label + " [" + axis.unit + "]";
}

/// Ends of an axis to three digits, of one that hardly moves to as many as distinguish them.
std::string end_of(double value, const PlotRange& range) {
  const double size = std::max(std::abs(range.low), std::abs(range.high));
  if (std::abs(value) < 1e-3 * (range.high - range.low)) return "0";
  const int digits = 3 + static_cast<int>(std::max(0.0, std::floor(std::log10(size / (range.high - range.low)))));
  return fmt::format("{:.{}g}", value, std::min(digits, 6));
}

}  // namespace

std::string render_fingerprint(const Fingerprint& print, const TerminalOptions& options) {
  const std::size_t columns = std::clamp<std::size_t>(options.width, 40, 80) - kMargin - 1;
  const PlotRange x = range_of(print, &FingerprintCloud::x, print.x.si);
  const PlotRange y = range_of(print, &FingerprintCloud::y, print.y.si);
  const std::vector<std::string> marks =
      options.unicode ? std::vector<std::string>{"\u2022", "\u25e6"} : std::vector<std::string>{"*", "o"};
  const std::string wall = options.unicode ? "\u2502" : "|", corner = options.unicode ? "\u2514" : "+",
                    floor = options.unicode ? "\u2500" : "-", zero = options.unicode ? "\u2508" : ".";
  std::vector<std::vector<std::string>> cells(kRows, std::vector<std::string>(columns, " "));
  if (y.low < 0 && y.high > 0) cells[kRows - 1 - y.cell(0, kRows)].assign(columns, zero);
  for (std::size_t k = print.clouds.size(); k-- > 0;) {  // the first lies on top
    const FingerprintCloud& cloud = print.clouds[k];
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      cells[kRows - 1 - y.cell(cloud.y[i] / print.y.si, kRows)][x.cell(cloud.x[i] / print.x.si, columns)] =
          marks[std::min(k, marks.size() - 1)];
    }
  }
  std::string text = "  " + with_unit(print.y);
  for (std::size_t k = 0; k < print.clouds.size(); ++k) {
    if (!print.clouds[k].name.empty())
      text += "   " + marks[std::min(k, marks.size() - 1)] + " " + print.clouds[k].name;
  }
  text += "\n";
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::string end = row == 0 ? end_of(y.high, y) : row + 1 == kRows ? end_of(y.low, y) : "";
    std::string line = fmt::format("{:>{}} ", end, kMargin - 2) + wall;
    std::size_t last = columns;
    while (last > 0 && cells[row][last - 1] == " ") --last;
    for (std::size_t i = 0; i < last; ++i) line += cells[row][i];
    text += line + "\n";
  }
  text += std::string(kMargin - 1, ' ') + corner;
  for (std::size_t i = 0; i < columns; ++i) text += floor;
  const std::string left = end_of(x.low, x), right = end_of(x.high, x);
  const std::string label = with_unit(print.x);
  const std::size_t used = left.size() + label.size() + right.size();
  const std::size_t gap = columns > used ? columns - used : 2;
  text += "\n" + std::string(kMargin, ' ') + left + std::string(gap / 2, ' ') + label +
          std::string(gap - gap / 2, ' ') + right + "\n";
  return text;
}

}  // namespace tribofit
