#include "report/charts/gnuplot_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>

#include "report/charts/gnuplot_style.hpp"
#include "report/charts/thin.hpp"

namespace tribofit {
namespace {

constexpr double kTolerance = 0.02;       // [mm]: half a dot at 600 dots per inch
constexpr double kSymbolCell = 0.08;      // [mm]
constexpr std::size_t kMostSymbols = 40;  // of a joined line; more would hide it
constexpr int kColourSteps = 64;

}  // namespace

void PlotList::begin() {
  data_ += fmt::format("$d{} << EOD\n", ++blocks_);
}

void PlotList::row(std::initializer_list<double> values) {
  const char* separator = "";
  for (const double value : values) {
    fmt::format_to(std::back_inserter(data_), "{}{:.10g}", separator, value);
    separator = " ";
  }
  data_ += '\n';
}

void PlotList::gap() {
  data_ += '\n';
}

void PlotList::element(const std::string& how) {
  data_ += "EOD\n";
  elements_ += fmt::format("{}$d{} {} notitle", elements_.empty() ? "plot " : ", \\\n  ", blocks_, how);
}

std::string PlotList::text() const {
  return data_ + (elements_.empty() ? "plot NaN notitle" : elements_) + "\n";
}

/// Stretches of points that can be drawn.
template <class Drawable>
std::vector<PlotList::Run> PlotList::runs(std::size_t count, Drawable drawable) const {
  std::vector<Run> found;
  for (std::size_t k = 0; k < count; ++k) {
    if (!drawable(k)) continue;
    if (found.empty() || found.back().end != k) found.push_back({k, k});
    found.back().end = k + 1;
  }
  return found;
}

void PlotList::add_line(const ChartLine& line) {
  if (!line.bars && !line.low.empty()) add_band(line);
  if (line.y.empty()) return;
  if (line.stroke.joined) add_joined(line);
  if (line.bars) {
    add_error_bars(line);
  } else if (line.stroke.symbol != Symbol::none || !line.stroke.joined) {
    add_symbols(line);
  }
}

void PlotList::add_band(const ChartLine& line) {
  const std::size_t count = std::min({line.x.size(), line.low.size(), line.high.size()});
  const auto drawable = [&](std::size_t k) {
    return std::isfinite(across(line.x[k])) && std::isfinite(upwards(line.low[k])) &&
           std::isfinite(upwards(line.high[k]));
  };
  begin();
  for (const Run& run : runs(count, drawable)) {
    std::vector<PicturePoint> low, high;
    for (std::size_t k = run.begin; k < run.end; ++k) {
      low.push_back({across(line.x[k]), upwards(line.low[k])});
      high.push_back({across(line.x[k]), upwards(line.high[k])});
    }
    std::vector<std::size_t> kept = thinned_line(low, kTolerance);
    const std::vector<std::size_t> more = thinned_line(high, kTolerance);
    kept.insert(kept.end(), more.begin(), more.end());
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    for (const std::size_t k : kept) row({line.x[run.begin + k], line.low[run.begin + k], line.high[run.begin + k]});
    gap();
  }
  element("using 1:2:3 with filledcurves fc rgb '" + pale(line.stroke.colour) + "'");
}

void PlotList::add_joined(const ChartLine& line) {
  const std::size_t count = std::min(line.x.size(), line.y.size());
  const auto drawable = [&](std::size_t k) {
    return std::isfinite(across(line.x[k])) && std::isfinite(upwards(line.y[k]));
  };
  begin();
  for (const Run& run : runs(count, drawable)) {
    std::vector<PicturePoint> points;
    for (std::size_t k = run.begin; k < run.end; ++k) points.push_back({across(line.x[k]), upwards(line.y[k])});
    for (const std::size_t k : thinned_line(points, kTolerance)) row({line.x[run.begin + k], line.y[run.begin + k]});
    gap();
  }
  element("using 1:2 with lines " +
          line_style(format_, ink(line.stroke.colour), line_width(line.stroke), line.stroke.dash));
}

void PlotList::add_symbols(const ChartLine& line) {
  std::vector<PicturePoint> points;
  std::vector<std::size_t> at;
  for (std::size_t k = 0; k < std::min(line.x.size(), line.y.size()); ++k) {
    const PicturePoint point{across(line.x[k]), upwards(line.y[k])};
    if (!std::isfinite(point.x) || !std::isfinite(point.y)) continue;
    points.push_back(point);
    at.push_back(k);
  }
  const std::vector<std::size_t> kept = thinned_points(points, kSymbolCell);
  const std::size_t every = line.stroke.joined ? 1 + kept.size() / kMostSymbols : 1;
  begin();
  for (std::size_t k = 0; k < kept.size(); k += every) row({line.x[at[kept[k]]], line.y[at[kept[k]]]});
  element("using 1:2 with points " + symbol_style(format_, line.stroke));
}

void PlotList::add_error_bars(const ChartLine& line) {
  begin();
  for (std::size_t k = 0; k < std::min(line.x.size(), line.y.size()); ++k) {
    const bool bars = k < line.low.size() && k < line.high.size() && std::isfinite(upwards(line.low[k])) &&
                      std::isfinite(upwards(line.high[k]));
    if (!std::isfinite(across(line.x[k])) || !std::isfinite(upwards(line.y[k]))) continue;
    row({line.x[k], line.y[k], bars ? line.low[k] : line.y[k], bars ? line.high[k] : line.y[k]});
  }
  element("using 1:2:3:4 with yerrorbars " + symbol_style(format_, line.stroke));
}

void PlotList::add_bars(const std::vector<ChartBars>& bars) {
  constexpr double kTogether = 0.76;  // of the distance between names
  const double thickness = kTogether / static_cast<double>(std::max<std::size_t>(bars.size(), 1));
  for (std::size_t k = 0; k < bars.size(); ++k) {
    // The first of a group lies above the others.
    const double place = static_cast<double>(y_.falling ? k : bars.size() - 1 - k);
    add_bar_set(bars[k], place * thickness - kTogether / 2, thickness);
  }
}

void PlotList::add_bar_set(const ChartBars& bars, double from, double thickness) {
  const std::string edge = line_style(format_, "#000000", 0.5);
  const auto drawable = [&](std::size_t k) { return std::isfinite(across(bars.values[k])); };
  const auto low = [&](std::size_t k) { return static_cast<double>(k) + from; };
  begin();
  for (std::size_t k = 0; k < bars.values.size(); ++k) {
    if (!drawable(k)) continue;
    row({bars.values[k], low(k), std::min(0.0, bars.values[k]), std::max(0.0, bars.values[k]), low(k),
         low(k) + thickness});
  }
  const std::string colour = bars.hatched ? "#ffffff" : ink(bars.colour);
  element("using 1:2:3:4:5:6 with boxxyerror fs solid 1 noborder fc rgb '" + colour + "'");
  if (bars.hatched) {
    begin();
    for (std::size_t k = 0; k < bars.values.size(); ++k) {
      if (drawable(k)) add_hatching(0, bars.values[k], low(k), low(k) + thickness);
    }
    element("using 1:2 with lines " + line_style(format_, ink(bars.colour), 0.9));
  }
  begin();
  for (std::size_t k = 0; k < bars.values.size(); ++k) {
    if (!drawable(k)) continue;
    for (const auto& [x, y] : {std::pair{0.0, low(k)},
                               {bars.values[k], low(k)},
                               {bars.values[k], low(k) + thickness},
                               {0.0, low(k) + thickness},
                               {0.0, low(k)}}) {
      row({x, y});
    }
    gap();
  }
  element("using 1:2 with lines " + edge);
}

/// Lines of 45 degrees on paper within a box.
void PlotList::add_hatching(double from, double to, double low, double high) {
  constexpr double kSpacing = 1.1;  // [mm], along the axis
  const double left = std::min(across(from), across(to)), right = std::max(across(from), across(to));
  const double bottom = std::min(upwards(low), upwards(high)), top = std::max(upwards(low), upwards(high));
  const auto x_at = [&](double mm) {
    return x_.low + (x_.falling ? area_.width - mm : mm) / area_.width * (x_.high - x_.low);
  };
  const auto y_at = [&](double mm) {
    return y_.low + (y_.falling ? area_.height - mm : mm) / area_.height * (y_.high - y_.low);
  };
  for (double c = left - (top - bottom) + kSpacing / 2; c < right; c += kSpacing) {  // x - (y - bottom) = c
    const double first = std::max(left, c), last = std::min(right, c + top - bottom);
    if (!(first < last)) continue;
    row({x_at(first), y_at(bottom + first - c)});
    row({x_at(last), y_at(bottom + last - c)});
    gap();
  }
}

/// Cells of one row that have the same colour are one box. A box reaches a little under its neighbours to the right and
/// above, which are drawn after it, or viewers show seams.
void PlotList::add_map(const HeatMap& map, const Scale& colours) {
  constexpr double kUnder = 0.04;
  std::vector<double> x = cell_edges(map.x, x_.logarithmic), y = cell_edges(map.y, y_.logarithmic);
  for (double& edge : x) edge = std::clamp(edge, x_.low, x_.high);
  for (double& edge : y) edge = std::clamp(edge, y_.low, y_.high);
  const auto step = [&](double z) -> std::optional<int> {
    if (!std::isfinite(z)) return std::nullopt;
    const double part = std::clamp((z - colours.low) / (colours.high - colours.low), 0.0, 1.0);
    return std::min(kColourSteps - 1, static_cast<int>(part * kColourSteps));
  };
  begin();
  for (std::size_t r = 0; r + 1 < y.size() && r < map.z.size(); ++r) {
    const std::vector<double>& z = map.z[r];
    const std::size_t count = std::min(z.size(), map.x.size());
    const double top = r + 2 < y.size() ? y[r + 1] + kUnder * (y[r + 2] - y[r + 1]) : y[r + 1];
    for (std::size_t c = 0, end = 0; c < count; c = end) {
      const std::optional<int> colour = step(z[c]);
      for (end = c + 1; end < count && step(z[end]) == colour;) ++end;
      if (!colour) continue;
      const double right = end < count ? x[end] + kUnder * (x[end + 1] - x[end]) : x[end];
      const double value = colours.low + (*colour + 0.5) / kColourSteps * (colours.high - colours.low);
      row({x[c], y[r], x[c], right, y[r], top, value});
    }
  }
  element("using 1:2:3:4:5:6:7 with boxxyerror fs solid 1 noborder fc palette");
}

}  // namespace tribofit
