#pragma once

#include <vector>

#include "report/pictures/canvas.hpp"
#include "report/pictures/layout.hpp"
#include "tribofit/report/chart.hpp"

namespace tribofit {

/// Draws a chart as layout_of() has laid it out.
void draw_chart(const Chart& chart, const PictureLayout& layout, Canvas& canvas);

/// A panel as the parts of draw_chart() see it.
struct PanelFrame {
  const Scale &x, &y;
  Area area;
  Canvas& canvas;

  double across(double value) const { return area.left + x.part(value) * area.width; }
  double up(double value) const { return area.bottom + y.part(value) * area.height; }
  Point at(double x_value, double y_value) const { return {across(x_value), up(y_value)}; }
};

/// A line with its band, symbols and bars of errors.
void draw_line(const PanelFrame& frame, const ChartLine& line);
/// All bars that lie beside the names of the vertical axis.
void draw_bars(const PanelFrame& frame, const std::vector<ChartBars>& bars);
void draw_map(const PanelFrame& frame, const HeatMap& map, const Scale& colours);

/// The same for the legend: a pen as wide as on paper, symbols at these places, a box that is filled or hatched.
Pen pen_of(const Stroke& stroke);
void draw_symbols(Canvas& canvas, const Path& at, const Stroke& stroke);
void draw_box(Canvas& canvas, const Area& box, Colour colour, bool hatched);
/// A path that ends where it begins.
Path closed(Path path);
/// The points to draw of a line without gaps, so that it stays within `tolerance` [mm] of all of them (Douglas and
/// Peucker 1973): what is not distinguishable on paper is left out, and no peak is lost. Cost: n log n.
Path thinned_line(const Path& points, double tolerance);

/// The same of points that are not joined: the first of those within a square of side `cell` [mm].
Path thinned_points(const Path& points, double cell);

/// Colour of a part of the heat map's range, 0 to 1.
std::string heat_colour(double part, std::span<const std::string_view> scale);

}  // namespace tribofit
