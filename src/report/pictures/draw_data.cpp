#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/pictures/draw.hpp"

namespace tribofit {
namespace {

constexpr double kPointsPerPixel = 0.45;  // a column of a journal is about half as wide as the page
constexpr double kTolerance = 0.02;       // [mm]: half a dot at 600 dots per inch
constexpr double kSymbolCell = 0.08;      // [mm]

bool finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

/// Runs of points k of [0, count) for which point(k) is finite, without those that are not distinguishable on paper.
template <class PointAt>
std::vector<Path> thinned_runs(std::size_t count, PointAt point) {
  std::vector<Path> runs;
  Path run;
  const auto end_run = [&] {
    if (!run.empty()) runs.push_back(thinned_line(run, kTolerance));
    run.clear();
  };
  for (std::size_t k = 0; k < count; ++k) {
    const Point p = point(k);
    finite(p) ? run.push_back(p) : end_run();
  }
  end_run();
  return runs;
}

void draw_band(const PanelFrame& frame, const ChartLine& line) {
  const std::size_t count = std::min({line.x.size(), line.low.size(), line.high.size()});
  const auto edge = [&](const std::vector<double>& own, const std::vector<double>& other) {
    return thinned_runs(count, [&](std::size_t k) {
      return std::isfinite(frame.up(other[k])) ? frame.at(line.x[k], own[k]) : Point{std::nan(""), 0};
    });
  };
  std::vector<Path> bands = edge(line.low, line.high);
  const std::vector<Path> highs = edge(line.high, line.low);
  for (std::size_t k = 0; k < bands.size(); ++k) bands[k].insert(bands[k].end(), highs[k].rbegin(), highs[k].rend());
  frame.canvas.fill(bands, pale(line.stroke.colour));
}

/// Points of the line within the panel, one where several are at one place.
Path symbols_of(const PanelFrame& frame, const ChartLine& line) {
  Path points, kept;
  for (std::size_t k = 0; k < std::min(line.x.size(), line.y.size()); ++k) {
    const Point p = frame.at(line.x[k], line.y[k]);
    if (frame.area.holds(p)) points.push_back(p);
  }
  const Path apart = thinned_points(points, kSymbolCell);
  const std::size_t every = line.stroke.joined ? 1 + apart.size() / kMostSymbols : 1;
  for (std::size_t k = 0; k < apart.size(); k += every) kept.push_back(apart[k]);
  return kept;
}

void draw_error_bars(const PanelFrame& frame, const ChartLine& line) {
  constexpr double kHalfCap = 0.4;  // [mm]
  std::vector<Path> bars;
  for (std::size_t k = 0; k < std::min({line.x.size(), line.low.size(), line.high.size()}); ++k) {
    const Point low = frame.at(line.x[k], line.low[k]), high = frame.at(line.x[k], line.high[k]);
    if (!finite(low) || !finite(high) || !(high.y > low.y)) continue;
    bars.push_back({low, high});
    for (const Point& end : {low, high}) bars.push_back({{end.x - kHalfCap, end.y}, {end.x + kHalfCap, end.y}});
  }
  frame.canvas.begin_plot(frame.area);
  frame.canvas.stroke(bars, {ink(line.stroke.colour), 0.5});
  frame.canvas.end_plot();
}

double symbol_radius(const Stroke& stroke) {
  return std::clamp(1.25 * kPointsPerPixel * stroke.size, 2.0, 5.5) / 2 * kMillimetresPerPoint;
}

}  // namespace

Path closed(Path path) {
  path.push_back(path.front());
  return path;
}

Pen pen_of(const Stroke& stroke) {
  Pen pen{ink(stroke.colour), std::clamp(kPointsPerPixel * stroke.width, 0.5, 1.2)};
  for (const double pixels : style_of(stroke.dash, kDashes).lengths) {
    if (pixels > 0) pen.dashes.push_back(kPointsPerPixel * pixels);
  }
  return pen;
}

void draw_symbols(Canvas& canvas, const Path& at, const Stroke& stroke) {
  const SymbolStyle& style = style_of(stroke.symbol, kSymbols);
  const double r = symbol_radius(stroke);
  std::vector<Path> paths;
  for (const Point& p : at) {
    Path path;
    for (std::size_t k = 0; k < style.count; ++k) {
      path.push_back({p.x + r * style.corners[k][0], p.y + r * style.corners[k][1]});
    }
    if (stroke.symbol == Symbol::cross) {
      paths.push_back({path[0], path[1]});
      paths.push_back({path[2], path[3]});
    } else {
      paths.push_back(style.count == 0 ? Path{p} : std::move(path));
    }
  }
  if (style.count == 0) {  // a dot as wide as the symbol
    canvas.stroke(paths, {ink(stroke.colour), 2 * r / kMillimetresPerPoint});
  } else if (stroke.symbol == Symbol::cross) {
    canvas.stroke(paths, {ink(stroke.colour), 0.7});
  } else {
    canvas.fill(paths, ink(stroke.colour));
  }
}

void draw_line(const PanelFrame& frame, const ChartLine& line) {
  frame.canvas.begin_plot(frame.area);
  if (!line.bars && !line.low.empty()) draw_band(frame, line);
  if (!line.y.empty() && line.stroke.joined) {
    const std::size_t count = std::min(line.x.size(), line.y.size());
    frame.canvas.stroke(thinned_runs(count, [&](std::size_t k) { return frame.at(line.x[k], line.y[k]); }),
                        pen_of(line.stroke));
  }
  frame.canvas.end_plot();
  if (line.y.empty()) return;
  if (line.bars) draw_error_bars(frame, line);
  if (line.stroke.symbol != Symbol::none || !line.stroke.joined) {
    draw_symbols(frame.canvas, symbols_of(frame, line), line.stroke);
  }
}

void draw_box(Canvas& canvas, const Area& box, Colour colour, bool hatched) {
  constexpr double kSpacing = 1.1;  // of the hatching, along the abscissa
  canvas.fill_path(box.corners(), hatched ? Paint{"#ffffff"} : ink(colour));
  std::vector<Path> hatching;  // of 45 degrees: x - y is the same all along
  for (double c = box.left - box.height + kSpacing / 2; hatched && c < box.right(); c += kSpacing) {
    const double first = std::max(box.left, c), last = std::min(box.right(), c + box.height);
    if (first < last) hatching.push_back({{first, box.bottom + first - c}, {last, box.bottom + last - c}});
  }
  canvas.stroke(hatching, {ink(colour), 0.9});
  canvas.stroke_path(closed(box.corners()), {});
}

void draw_bars(const PanelFrame& frame, const std::vector<ChartBars>& bars) {
  constexpr double kTogether = 0.76;  // of the distance between names
  const double thickness = kTogether / static_cast<double>(std::max<std::size_t>(bars.size(), 1));
  frame.canvas.begin_plot(frame.area);
  for (std::size_t k = 0; k < bars.size(); ++k) {
    // The first of a group lies above the others.
    const double place = static_cast<double>(frame.y.falling ? k : bars.size() - 1 - k);
    for (std::size_t i = 0; i < bars[k].values.size(); ++i) {
      const double from = static_cast<double>(i) + place * thickness - kTogether / 2;
      const Point a = frame.at(0, from), b = frame.at(bars[k].values[i], from + thickness);
      if (!finite(b)) continue;
      draw_box(frame.canvas, {std::min(a.x, b.x), std::min(a.y, b.y), std::abs(b.x - a.x), std::abs(b.y - a.y)},
               bars[k].colour, bars[k].hatched);
    }
  }
  frame.canvas.end_plot();
}

std::string heat_colour(double part, std::span<const std::string_view> scale) {
  const double at = std::clamp(part, 0.0, 1.0) * static_cast<double>(scale.size() - 1);
  const auto below = std::min(static_cast<std::size_t>(at), scale.size() - 2);
  std::string out = "#";
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = channel_of(scale[below], k), to = channel_of(scale[below + 1], k);
    const double value = from + (at - static_cast<double>(below)) * (to - from);
    out += fmt::format("{:02x}", static_cast<int>(std::lround(value)));
  }
  return out;
}

/// Cells of one row that have the same colour are one box. A box reaches a little under its neighbours to the right and
/// above, which are drawn after it, or viewers show seams.
void draw_map(const PanelFrame& frame, const HeatMap& map, const Scale& colours) {
  constexpr double kUnder = 0.4;  // [mm]: more than a dot of a screen
  constexpr int kColourSteps = 64;
  const std::vector<double> x = cell_edges(map.x, frame.x.logarithmic), y = cell_edges(map.y, frame.y.logarithmic);
  const auto step = [&](double z) {
    return std::isfinite(z)
               ? std::min(kColourSteps - 1, static_cast<int>(std::clamp(colours.part(z), 0.0, 1.0) * kColourSteps))
               : -1;
  };
  frame.canvas.begin_plot(frame.area);
  for (std::size_t r = 0; r + 1 < y.size() && r < map.z.size(); ++r) {
    const std::vector<double>& z = map.z[r];
    const std::size_t count = std::min(z.size(), map.x.size());
    for (std::size_t c = 0, end = 0; c < count; c = end) {
      const int colour = step(z[c]);
      for (end = c + 1; end < count && step(z[end]) == colour;) ++end;
      if (colour < 0) continue;
      const Point low = frame.at(x[c], y[r]), high = frame.at(x[end], y[r + 1]);
      const bool beside = end < count && step(z[end]) >= 0;
      bool above = r + 2 < y.size() && r + 1 < map.z.size() && map.z[r + 1].size() >= end;
      for (std::size_t k = c; above && k < end; ++k) above = step(map.z[r + 1][k]) >= 0;
      const Area box{low.x, low.y, high.x - low.x + (beside ? kUnder : 0), high.y - low.y + (above ? kUnder : 0)};
      frame.canvas.fill_path(box.corners(), {heat_colour((colour + 0.5) / kColourSteps, colours_of(map))});
    }
  }
  frame.canvas.end_plot();
}

}  // namespace tribofit
