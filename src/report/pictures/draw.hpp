#pragma once

#include <string>
#include <vector>

#include "report/pictures/layout.hpp"
#include "report/pictures/svg.hpp"
#include "tribofit/report/chart.hpp"
#include "tribofit/report/pictures.hpp"

namespace tribofit {

/// A chart as SVG.
std::string drawn(const Chart& chart);

/// An SVG as PDF or PNG, drawn by librsvg; throws InputError where it cannot be drawn, and in a build without it.
std::string converted(const std::string& svg, PictureFormat format, const std::string& title);
bool can_convert();

/// A panel as the parts of drawn() see it.
struct PanelFrame {
  const Scale &x, &y;
  Area area;
  Svg& sheet;

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
void draw_symbols(Svg& sheet, const Path& at, const Stroke& stroke);
void draw_box(Svg& sheet, const Area& box, Colour colour, bool hatched);

/// The points to draw of a line without gaps, so that it stays within `tolerance` [mm] of all of them (Douglas and
/// Peucker 1973): what is not distinguishable on paper is left out, and no peak is lost. Cost: n log n.
Path thinned_line(const Path& points, double tolerance);

/// The same of points that are not joined: the first of those within a square of side `cell` [mm].
Path thinned_points(const Path& points, double cell);

}  // namespace tribofit
