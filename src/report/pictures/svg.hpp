#pragma once

#include <fmt/format.h>

#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "report/charts/styles.hpp"
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
  Svg(double width, double height, const std::string& title) : height_(height) {
    say(R"(<?xml version="1.0" encoding="utf-8"?>)");
    say(R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="{}mm" )"
        R"(height="{:.2f}mm" viewBox="0 0 {} {}" font-family="Arial, 'Liberation Sans', Helvetica, sans-serif" )"
        R"(xml:space="preserve"><title>{}</title>)",
        width, height, across(width), across(height), escaped(title));
    say(R"(<rect width="100%" height="100%" fill="#ffffff"/>)");
  }

  void stroke(std::span<const Path> paths, const Pen& pen) {
    const std::string data = data_of(paths);
    if (data.empty()) return;
    std::string dashes;
    for (const double length : pen.dashes) dashes += (dashes.empty() ? " stroke-dasharray=\"" : " ") + number(length);
    if (!dashes.empty()) dashes += '"';
    say(R"(<path fill="none" stroke="{}"{} stroke-width="{}" stroke-linejoin="round"{} d="{}"/>)", pen.paint.colour,
        opacity("stroke", pen.paint), number(pen.width), dashes, data);
  }
  void stroke(const Path& path, const Pen& pen) { stroke({&path, 1}, pen); }

  void fill(std::span<const Path> polygons, const Paint& paint) {
    const std::string data = data_of(polygons);
    if (!data.empty()) say(R"(<path fill="{}"{} d="{}"/>)", paint.colour, opacity("fill", paint), data);
  }
  void fill(const Area& area, const Paint& paint) {
    const Path outline = area.outline();
    fill({&outline, 1}, paint);
  }

  /// A box whose neighbours of the same kind leave no seam.
  void tile(const Area& area, const std::string& colour) {
    say(R"(<path fill="{0}" stroke="{0}" d="M{1},{2}h{3}v-{4}h-{3}z"/>)", colour, across(area.left), down(area.bottom),
        across(area.width), across(area.height));
  }

  /// A symbol of this radius [mm] at each place.
  void symbols(const Path& at, Symbol symbol, double radius, Colour colour) {
    const std::string_view rgb = ink(colour).colour;
    const double points = radius / kMillimetresPerPoint;
    say(R"x(<defs><path id="p{}" transform="scale({})" d="{}"/></defs>)x", ++named_, number(points),
        style_of(symbol, kSymbols).path);
    const std::string lines =
        symbol == Symbol::cross ? fmt::format(R"( stroke="{}" stroke-width="{}")", rgb, number(0.7 / points)) : "";
    say(R"(<g fill="{}"{}>)", rgb, lines);
    for (const Point& p : at) say(R"(<use xlink:href="#p{}" x="{}" y="{}"/>)", named_, across(p.x), down(p.y));
    say("</g>");
  }

  void write(const Words& words) {
    constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
    const double lower = sizes.half_capital * words.points * kMillimetresPerPoint;
    const std::string place =
        words.upright
            ? fmt::format("transform=\"translate({},{}) rotate(-90)\"", across(words.at.x + lower), down(words.at.y))
            : fmt::format("x=\"{}\" y=\"{}\"", across(words.at.x), down(words.at.y - lower));
    const std::string text = spans_of(words), size = number(words.points);
    const std::string_view anchor = style_of(words.anchor, kAnchors);
    if (words.halo) {
      say(R"(<text {} font-size="{}" text-anchor="{}" fill="#fff" stroke="#fff" stroke-width="{}" )"
          R"(stroke-linejoin="round" aria-hidden="true">{}</text>)",
          place, size, anchor, sizes.halo, text);
    }
    say(R"(<text {} font-size="{}" text-anchor="{}">{}</text>)", place, size, anchor, text);
  }

  /// What is drawn until end_plot() is seen within `area` only.
  void begin_plot(const Area& area) {
    say(R"(<clipPath id="p{}"><rect x="{}" y="{}" width="{}" height="{}"/></clipPath>)", ++named_, across(area.left),
        down(area.top()), across(area.width), across(area.height));
    say(R"x(<g class="plot" stroke-width="0.4" clip-path="url(#p{})">)x", named_);
  }
  void end_plot() { say("</g>"); }
  std::string finish() { return std::move(out_) + "</svg>\n"; }

 private:
  template <class... Parts>
  void say(fmt::format_string<Parts...> pattern, Parts&&... parts) {
    fmt::format_to(std::back_inserter(out_), pattern, std::forward<Parts>(parts)...);
    out_ += '\n';
  }

  /// A number to a hundredth of a point, without zeros that say nothing.
  static std::string number(double value) {
    std::string text = fmt::format("{:.2f}", value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.ends_with('.')) text.pop_back();
    return text == "-0" ? "0" : text;
  }
  static std::string across(double mm) { return number(mm / kMillimetresPerPoint); }
  std::string down(double y) const { return across(height_ - y); }

  static std::string opacity(std::string_view what, const Paint& paint) {
    return paint.opacity < 1 ? fmt::format(" {}-opacity=\"{:.3g}\"", what, paint.opacity) : "";
  }

  std::string data_of(std::span<const Path> paths) const {
    std::string data;
    for (const Path& path : paths) {
      for (const Point& p : path) data += (&p == &path.front() ? "M" : "L") + across(p.x) + "," + down(p.y);
    }
    return data;
  }

  /// What is set low and high in a size of its own, off the line.
  static std::string spans_of(const Words& words) {
    const std::string line = one_line(words.text);
    if (!words.markup) return escaped(line);
    std::string text;
    int level = 0;
    for (const TextPiece& piece : pieces_of(line)) {
      const double rise = (level - piece.level) * sizes.script_rise * words.points;
      std::string style = rise != 0 ? fmt::format(" dy=\"{}\"", number(rise)) : "";
      if (piece.level != 0) style += fmt::format(" font-size=\"{}\"", number(sizes.script * words.points));
      text += style.empty() ? escaped(piece.text) : fmt::format("<tspan{}>{}</tspan>", style, escaped(piece.text));
      level = piece.level;
    }
    return text;
  }

  double height_;
  int named_ = 0;
  std::string out_;
};

}  // namespace tribofit
