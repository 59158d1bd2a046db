#include "report/charts/gnuplot_style.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace tribofit {
namespace {

constexpr double kPointsPerPixel = 0.45;  // a column of a journal is about half as wide as the page

/// gnuplot's unit of line widths, of one point.
double unit_of_width(PictureFormat format) {
  switch (format) {
    case PictureFormat::svg:
      return 1 / 0.75;
    case PictureFormat::pdf:
      return 2;
    case PictureFormat::png:
      return kPicturePixelsPerInch / 72.0;
  }
  return 1;
}

/// Length of one unit of a dash [pt] in a line this wide [pt], as the terminals of gnuplot 5 and 6 have it.
double unit_of_dash(PictureFormat format, double points) {
  switch (format) {
    case PictureFormat::svg:
      return 0.5 * points;
    case PictureFormat::pdf:
      return 0.275 * std::max(points, 1.0);
    case PictureFormat::png:
      return 0.25 * points;
  }
  return 1;
}

/// Lengths of strokes and gaps [pt].
std::vector<double> lengths(Dash dash) {
  switch (dash) {
    case Dash::solid:
      return {};
    case Dash::dashed:
      return {3.6, 1.8};
    case Dash::dotted:
      return {0.9, 1.3};
    case Dash::dash_dotted:
      return {4, 1.4, 0.9, 1.4};
    case Dash::long_dashed:
      return {7, 2};
  }
  return {};
}

int point_type(Symbol symbol) {
  switch (symbol) {
    case Symbol::none:
    case Symbol::circle:
      return 7;
    case Symbol::square:
      return 5;
    case Symbol::diamond:
      return 13;
    case Symbol::triangle_up:
      return 9;
    case Symbol::triangle_down:
      return 11;
    case Symbol::cross:
      return 2;
  }
  return 7;
}

}  // namespace

std::string ink(Colour colour) {
  switch (colour) {
    case Colour::black:
      return "#000000";
    case Colour::blue:
      return "#0072b2";
    case Colour::red:
      return "#d55e00";
    case Colour::green:
      return "#009e73";
    case Colour::purple:
      return "#a0508a";
    case Colour::grey:
      return "#6b6b6b";
  }
  return "#000000";
}

std::string pale(Colour colour) {
  return "#" + std::string(colour == Colour::black ? "db" : "c8") + ink(colour).substr(1);
}

std::string fill(Shade shade) {
  switch (shade) {
    case Shade::stick:
      return "#ededed";
    case Shade::slip:
      return "#fbefd6";
    case Shade::beyond:
      return "#e0e0e0";
    case Shade::left_out:
      return "#e8d6e4";
  }
  return "#ffffff";
}

std::string line_style(PictureFormat format, const std::string& colour, double points, Dash dash) {
  std::string pattern = "1";
  if (dash != Dash::solid) {
    pattern.clear();
    const double unit = unit_of_dash(format, points);
    for (const double length : lengths(dash))
      pattern += fmt::format("{}{:.3g}", pattern.empty() ? "(" : ",", length / unit);
    pattern += ")";
  }
  return fmt::format("lw {:.4g} dt {} lc rgb '{}'", points * unit_of_width(format), pattern, colour);
}

std::string symbol_style(PictureFormat format, const Stroke& stroke) {
  const bool unseen = stroke.symbol == Symbol::none && stroke.joined;
  const double size = unseen ? 0 : symbol_size(stroke) / 6;  // ps 1 is 6 pt wide
  return fmt::format("pt {} ps {:.3g} {}", point_type(stroke.symbol), size,
                     line_style(format, ink(stroke.colour), 0.5));
}

double line_width(const Stroke& stroke) {
  return std::clamp(kPointsPerPixel * stroke.width, 0.5, 1.2);
}

double symbol_size(const Stroke& stroke) {
  return std::clamp(1.25 * kPointsPerPixel * stroke.size, 2.0, 5.5);
}

}  // namespace tribofit
