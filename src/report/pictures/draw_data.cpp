#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/register/linestring.hpp>
#include <boost/geometry/geometries/register/point.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <set>

#include "report/pictures/draw.hpp"

BOOST_GEOMETRY_REGISTER_POINT_2D(tribofit::Point, double, boost::geometry::cs::cartesian, x, y)
BOOST_GEOMETRY_REGISTER_LINESTRING(tribofit::Path)

namespace tribofit {
namespace {

bool finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

/// Runs of points k of [0, count) for which point(k) is finite, without those that are not distinguishable on paper.
template <class PointAt>
std::vector<Path> thinned_runs(std::size_t count, PointAt point) {
  std::vector<Path> runs;
  Path run;
  for (std::size_t k = 0; k <= count; ++k) {
    const Point p = k < count ? point(k) : Point{std::nan(""), 0};
    if (finite(p)) {
      run.push_back(p);
    } else if (!run.empty()) {
      runs.push_back(thinned_line(run, sizes.tolerance));
      run.clear();
    }
  }
  return runs;
}

std::size_t points_with_range(const ChartLine& line) {
  return std::min({line.x.size(), line.low.size(), line.high.size()});
}

void draw_band(const PanelFrame& frame, const ChartLine& line) {
  const auto edge = [&](const std::vector<double>& own, const std::vector<double>& other) {
    return thinned_runs(points_with_range(line), [&](std::size_t k) {
      return std::isfinite(frame.up(other[k])) ? frame.at(line.x[k], own[k]) : Point{std::nan(""), 0};
    });
  };
  std::vector<Path> bands = edge(line.low, line.high);
  const std::vector<Path> highs = edge(line.high, line.low);
  for (std::size_t k = 0; k < bands.size(); ++k) bands[k].insert(bands[k].end(), highs[k].rbegin(), highs[k].rend());
  frame.sheet.fill(bands, pale(line.stroke.colour));
}

/// Points of the line within the panel, one where several are at one place.
Path symbols_of(const PanelFrame& frame, const ChartLine& line) {
  Path points, kept;
  for (std::size_t k = 0; k < std::min(line.x.size(), line.y.size()); ++k) {
    const Point p = frame.at(line.x[k], line.y[k]);
    if (frame.area.holds(p)) points.push_back(p);
  }
  const Path apart = thinned_points(points, sizes.symbol_cell);
  const std::size_t every = line.stroke.joined ? 1 + apart.size() / kMostSymbols : 1;
  for (std::size_t k = 0; k < apart.size(); k += every) kept.push_back(apart[k]);
  return kept;
}

void draw_error_bars(const PanelFrame& frame, const ChartLine& line) {
  std::vector<Path> bars;
  for (std::size_t k = 0; k < points_with_range(line); ++k) {
    const Point low = frame.at(line.x[k], line.low[k]), high = frame.at(line.x[k], line.high[k]);
    if (!finite(low) || !finite(high) || !(high.y > low.y)) continue;
    bars.push_back({low, high});
    for (const Point& end : {low, high})
      bars.push_back({{end.x - sizes.half_cap, end.y}, {end.x + sizes.half_cap, end.y}});
  }
  frame.sheet.stroke(bars, {ink(line.stroke.colour), 0.5});
}

/// Colour of a part of the map's range, 0 to 1, in steps; none where there is no value.
std::string heat_colour(double part, std::span<const std::string_view> scale) {
  if (!std::isfinite(part)) return "";
  const double step = std::min(std::floor(std::clamp(part, 0.0, 1.0) * sizes.colour_steps), sizes.colour_steps - 1.0);
  const double at = (step + 0.5) / sizes.colour_steps * static_cast<double>(scale.size() - 1), below = std::floor(at);
  std::string out = "#";
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = channel_of(scale[static_cast<std::size_t>(below)], k);
    const int to = channel_of(scale[static_cast<std::size_t>(below) + 1], k);
    out += fmt::format("{:02x}", std::lround(from + (at - below) * (to - from)));
  }
  return out;
}

}  // namespace

Path thinned_line(const Path& points, double tolerance) {
  Path out;
  boost::geometry::simplify(points, out, tolerance);
  return out;
}

Path thinned_points(const Path& points, double cell) {
  std::set<std::pair<double, double>> taken;
  Path out;
  for (const Point& p : points) {
    if (taken.emplace(std::floor(p.x / cell), std::floor(p.y / cell)).second) out.push_back(p);
  }
  return out;
}

Pen pen_of(const Stroke& stroke) {
  Pen pen{ink(stroke.colour), std::clamp(sizes.pixel_points * stroke.width, 0.5, 1.2)};
  for (const double pixels : style_of(stroke.dash, kDashes).lengths) {
    if (pixels > 0) pen.dashes.push_back(sizes.pixel_points * pixels);
  }
  return pen;
}

void draw_symbols(Svg& sheet, const Path& at, const Stroke& stroke) {
  const double points = std::clamp(1.25 * sizes.pixel_points * stroke.size, 2.0, 5.5);
  sheet.symbols(at, stroke.symbol, points / 2 * kMillimetresPerPoint, stroke.colour);
}

void draw_line(const PanelFrame& frame, const ChartLine& line) {
  frame.sheet.begin_plot(frame.area);
  if (!line.bars && !line.low.empty()) draw_band(frame, line);
  if (!line.y.empty() && line.stroke.joined) {
    const std::size_t count = std::min(line.x.size(), line.y.size());
    frame.sheet.stroke(thinned_runs(count, [&](std::size_t k) { return frame.at(line.x[k], line.y[k]); }),
                       pen_of(line.stroke));
  }
  if (!line.y.empty() && line.bars) draw_error_bars(frame, line);
  frame.sheet.end_plot();
  if (!line.y.empty() && (line.stroke.symbol != Symbol::none || !line.stroke.joined))
    draw_symbols(frame.sheet, symbols_of(frame, line), line.stroke);
}

void draw_box(Svg& sheet, const Area& box, Colour colour, bool hatched) {
  sheet.fill(box, hatched ? Paint{"#ffffff"} : ink(colour));
  std::vector<Path> hatching;  // of 45 degrees: x - y is the same all along
  for (double c = box.left - box.height + sizes.hatching / 2; hatched && c < box.right(); c += sizes.hatching) {
    const double first = std::max(box.left, c), last = std::min(box.right(), c + box.height);
    if (first < last) hatching.push_back({{first, box.bottom + first - c}, {last, box.bottom + last - c}});
  }
  sheet.stroke(hatching, {ink(colour), 0.9});
  sheet.stroke(box.outline(), {});
}

void draw_bars(const PanelFrame& frame, const std::vector<ChartBars>& bars) {
  const double thickness = sizes.bars_together / static_cast<double>(bars.size());
  frame.sheet.begin_plot(frame.area);
  for (std::size_t k = 0; k < bars.size(); ++k) {
    // The first of a group lies above the others.
    const double place = static_cast<double>(frame.y.falling ? k : bars.size() - 1 - k);
    for (std::size_t i = 0; i < bars[k].values.size(); ++i) {
      const double from = static_cast<double>(i) + place * thickness - sizes.bars_together / 2;
      const Point a = frame.at(0, from), b = frame.at(bars[k].values[i], from + thickness);
      if (!finite(b)) continue;
      draw_box(frame.sheet, {std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y)},
               bars[k].colour, bars[k].hatched);
    }
  }
  frame.sheet.end_plot();
}

/// Cells of one row that have the same colour are one box.
void draw_map(const PanelFrame& frame, const HeatMap& map, const Scale& colours) {
  const std::vector<double> x = cell_edges(map.x, frame.x.logarithmic), y = cell_edges(map.y, frame.y.logarithmic);
  frame.sheet.begin_plot(frame.area);
  for (std::size_t r = 0; r + 1 < y.size() && r < map.z.size(); ++r) {
    std::vector<std::string> row;
    for (std::size_t c = 0; c < std::min(map.z[r].size(), map.x.size()); ++c)
      row.push_back(heat_colour(colours.part(map.z[r][c]), colours_of(map)));
    for (std::size_t c = 0, end = 0; c < row.size(); c = end) {
      while (end < row.size() && row[end] == row[c]) ++end;
      const Point low = frame.at(x[c], y[r]), high = frame.at(x[end], y[r + 1]);
      if (!row[c].empty()) frame.sheet.tile({low.x, low.y, high.x - low.x, high.y - low.y}, row[c]);
    }
  }
  frame.sheet.end_plot();
}

}  // namespace tribofit
