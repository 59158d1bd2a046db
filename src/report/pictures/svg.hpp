#pragma once

#include <fmt/format.h>

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/charts/styles.hpp"
#include "report/pictures/sizes.hpp"
#include "report/pictures/text.hpp"

namespace tribofit {

struct Point {
  double x = 0, y = 0;
};
using Path = std::vector<Point>;

struct Area {
  double left = 0, bottom = 0, width = 0, height = 0;

  double right() const { return left + width; }
  double top() const { return bottom + height; }
  bool holds(const Point& p) const {
    constexpr double kRounding = 1e-6;
    return p.x >= left - kRounding && p.x <= right() + kRounding && p.y >= bottom - kRounding &&
           p.y <= top() + kRounding;
  }
  /// All around, back to where it begins.
  Path outline() const { return {{left, bottom}, {right(), bottom}, {right(), top()}, {left, top()}, {left, bottom}}; }
};

struct Pen {
  Paint paint = {};
  double width = 0.5;
  std::vector<double> dashes = {};
};

enum class Anchor { left, centre, right };

struct Words {
  std::string text;
  Point at;  ///< half-way up the letters
  Anchor anchor = Anchor::left;
  double points = sizes.text;
  bool upright = false;  ///< read from below
  bool markup = true;    ///< "v_{r}" has a subscript
  bool halo = false;     ///< white around the letters, over what is drawn there
};

/// A picture as SVG. Places are in mm from the lower left corner; widths of lines and sizes of text in points. Text
/// stays text.
class Svg {
 public:
  Svg(double width, double height, const std::string& title);
  void stroke(std::span<const Path> paths, const Pen& pen);
  void stroke(const Path& path, const Pen& pen) { stroke({&path, 1}, pen); }
  void fill(std::span<const Path> polygons, const Paint& paint);
  void fill(const Area& area, const Paint& paint) {
    const Path outline = area.outline();
    fill({&outline, 1}, paint);
  }
  /// A box whose neighbours of the same kind leave no seam.
  void tile(const Area& area, const std::string& colour);
  /// A symbol of this radius [mm] at each place.
  void symbols(const Path& at, Symbol symbol, double radius, Colour colour);
  /// Colours from the lower end of an area to its upper one.
  void shade(const Area& area, std::span<const std::string_view> colours);
  void write(const Words& words);
  /// What is drawn until end_plot() is seen within `area` only.
  void begin_plot(const Area& area);
  void end_plot() { out_ += "</g>\n"; }
  std::string finish() { return std::move(out_) + "</svg>\n"; }

 private:
  template <class... Parts>
  void say(fmt::format_string<Parts...> pattern, Parts&&... parts);
  std::string down(double y) const;
  std::string data_of(std::span<const Path> paths) const;
  std::string box_of(const Area& area) const;

  double height_;
  int named_ = 0;
  std::string out_;
};

}  // namespace tribofit
