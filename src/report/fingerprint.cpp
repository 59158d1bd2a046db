#include "tribofit/study/fingerprint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "numbers.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kRows = 13, kMargin = 11;

struct PlotRange {
  double low = 0, high = 0;
  /// Cell 0 .. count-1.
  std::size_t cell(double x, std::size_t count) const {
    return static_cast<std::size_t>(std::lround((x - low) / (high - low) * static_cast<double>(count - 1)));
  }
};

PlotRange range_of(const Fingerprint& print, std::vector<double> FingerprintCloud::*values, double si) {
  std::vector<double> all;
  for (const FingerprintCloud& cloud : print.clouds) {
    all.insert(all.end(), (cloud.*values).begin(), (cloud.*values).end());
  }
  const Extremes ends = all.empty() ? Extremes{} : extremes(all);
  const PlotRange range{ends.low / si, ends.high / si};
  if (range.high - range.low > 1e-9 * std::max(1.0, std::abs(range.high))) return range;
  const double half = std::max(0.01, 0.01 * std::abs(range.low));  // flat, or nothing at all
  return {range.low - half, range.low + half};
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
  const auto sign = [&](const char* full, const char* plain) { return options.unicode ? full : plain; };
  const auto mark_of = [&](std::size_t cloud) { return cloud == 0 ? sign("\u2022", "*") : sign("\u25e6", "o"); };
  const auto row_of = [](double value, const PlotRange& range) { return kRows - 1 - range.cell(value, kRows); };
  std::vector<std::vector<std::string>> cells(kRows, std::vector<std::string>(columns, " "));
  if (y.low < 0 && y.high > 0) cells[row_of(0, y)].assign(columns, sign("\u2508", "."));
  for (std::size_t k = print.clouds.size(); k-- > 0;) {  // the first lies on top
    const FingerprintCloud& cloud = print.clouds[k];
    for (std::size_t i = 0; i < cloud.x.size(); ++i) {
      cells[row_of(cloud.y[i] / print.y.si, y)][x.cell(cloud.x[i] / print.x.si, columns)] = mark_of(k);
    }
  }
  std::string text = "  " + with_unit(print.y.label, print.y.unit);
  for (std::size_t k = 0; k < print.clouds.size(); ++k) {
    if (!print.clouds[k].name.empty()) text += fmt::format("   {} {}", mark_of(k), print.clouds[k].name);
  }
  for (std::size_t row = 0; row < kRows; ++row) {
    const std::string end = row == 0 ? end_of(y.high, y) : row + 1 == kRows ? end_of(y.low, y) : "";
    while (!cells[row].empty() && cells[row].back() == " ") cells[row].pop_back();
    text += fmt::format("\n{:>{}} {}{}", end, kMargin - 2, sign("\u2502", "|"), fmt::join(cells[row], ""));
  }
  text += fmt::format("\n{:{}}{}", "", kMargin - 1, sign("\u2514", "+"));
  for (std::size_t i = 0; i < columns; ++i) text += sign("\u2500", "-");
  const std::string left = end_of(x.low, x), label = with_unit(print.x.label, print.x.unit), right = end_of(x.high, x);
  const std::size_t used = left.size() + label.size() + right.size(), gap = columns > used ? columns - used : 2;
  return text +
         fmt::format("\n{:{}}{}{:{}}{}{:{}}{}\n", "", kMargin, left, "", gap / 2, label, "", gap - gap / 2, right);
}

}  // namespace tribofit
