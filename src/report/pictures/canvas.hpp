#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "report/charts/styles.hpp"
#include "report/pictures/text.hpp"
#include "tribofit/report/pictures.hpp"

namespace tribofit {

/// What a picture is drawn on. Places are in mm from the lower left corner; widths of lines and sizes of text in
/// points.

struct Point {
  double x = 0, y = 0;
};
using Path = std::vector<Point>;

struct Area {
  double left = 0, bottom = 0, width = 0, height = 0;

  double right() const { return left + width; }
  double top() const { return bottom + height; }
  bool holds(const Point& p) const {
    constexpr double kRound = 1e-6;
    return p.x >= left - kRound && p.x <= right() + kRound && p.y >= bottom - kRound && p.y <= top() + kRound;
  }
  Path corners() const { return {{left, bottom}, {right(), bottom}, {right(), top()}, {left, top()}}; }
};

struct Pen {
  Paint paint = {};
  double width = 0.5;
  std::vector<double> dashes = {};  ///< [pt]
};

inline constexpr double kHalo = 2;  ///< width of the pen behind letters that have one [pt]

enum class Anchor { left, centre, right };

struct Words {
  std::string text;
  Point at;  ///< half-way up the letters
  Anchor anchor = Anchor::left;
  double points = kTextPoints;
  bool upright = false;  ///< read from below
  bool markup = true;    ///< "v_{r}" has a subscript
  bool halo = false;     ///< white around the letters, over what is drawn there

  std::vector<TextPiece> pieces() const {
    const std::string line = one_line(text);
    return markup ? pieces_of(line) : std::vector<TextPiece>{{line, 0}};
  }
};

class Canvas {
 public:
  /// Of a sheet of this height [mm].
  explicit Canvas(double height) : height_(height) {}
  virtual ~Canvas() = default;
  /// Lines with round ends where a path is one point: a dot as wide as the pen.
  virtual void stroke(std::span<const Path> paths, const Pen& pen) = 0;
  virtual void fill(std::span<const Path> polygons, const Paint& paint) = 0;
  virtual void write(const Words& words) = 0;
  /// What is drawn until end_plot() is seen within `area` only.
  virtual void begin_plot(const Area& area) = 0;
  virtual void end_plot() = 0;
  /// The file. Throws InputError.
  virtual std::string finish() = 0;

  void stroke_path(const Path& path, const Pen& pen) { stroke({&path, 1}, pen); }
  void fill_path(const Path& path, const Paint& paint) { fill({&path, 1}, paint); }

 protected:
  /// In points, from the upper left corner.
  static double across(double mm) { return mm / kMillimetresPerPoint; }
  double down(double y) const { return across(height_ - y); }

 private:
  double height_;
};

/// A sheet of this size [mm].
std::unique_ptr<Canvas> make_svg(double width, double height, const std::string& title);
/// PDF or PNG; throws InputError in a build without Cairo.
std::unique_ptr<Canvas> make_cairo(PictureFormat format, double width, double height, const std::string& title);
bool has_cairo();

}  // namespace tribofit
