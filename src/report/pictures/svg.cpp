#include "report/pictures/svg.hpp"

#include <fmt/format.h>

#include <iterator>
#include <string_view>

namespace tribofit {
namespace {

/// A number to a hundredth of a point, without zeros that say nothing.
std::string number(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string across(double mm) {
  return number(mm / kMillimetresPerPoint);
}

std::string opacity(std::string_view what, const Paint& paint) {
  return paint.opacity < 1 ? fmt::format(" {}-opacity=\"{:.3g}\"", what, paint.opacity) : "";
}

/// What is set low and high in a size of its own, off the line.
std::string spans_of(const Words& words) {
  const std::string line = one_line(words.text);
  if (!words.markup) return escaped(line);
  std::string text;
  int level = 0;
  for (const TextPiece& piece : pieces_of(line)) {
    std::string style;
    if (piece.level != level)
      style += fmt::format(" dy=\"{}\"", number((level - piece.level) * sizes.script_rise * words.points));
    if (piece.level != 0) style += fmt::format(" font-size=\"{}\"", number(sizes.script * words.points));
    text += style.empty() ? escaped(piece.text) : fmt::format("<tspan{}>{}</tspan>", style, escaped(piece.text));
    level = piece.level;
  }
  return text;
}

}  // namespace

template <class... Parts>
void Svg::say(fmt::format_string<Parts...> pattern, Parts&&... parts) {
  fmt::format_to(std::back_inserter(out_), pattern, std::forward<Parts>(parts)...);
  out_ += '\n';
}

Svg::Svg(double width, double height, const std::string& title) : height_(height) {
  say(R"(<?xml version="1.0" encoding="utf-8"?>)");
  say(R"(<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="{}mm" )"
      R"(height="{:.2f}mm" viewBox="0 0 {} {}" font-family="Arial, 'Liberation Sans', Helvetica, sans-serif" )"
      R"(xml:space="preserve"><title>{}</title>)",
      width, height, across(width), across(height), escaped(title));
  say(R"(<rect width="100%" height="100%" fill="#ffffff"/>)");
}

std::string Svg::down(double y) const {
  return across(height_ - y);
}

std::string Svg::data_of(std::span<const Path> paths) const {
  std::string data;
  for (const Path& path : paths) {
    for (const Point& p : path) data += (&p == &path.front() ? "M" : "L") + across(p.x) + "," + down(p.y);
  }
  return data;
}

std::string Svg::box_of(const Area& area) const {
  return fmt::format(R"(<rect x="{}" y="{}" width="{}" height="{}")", across(area.left), down(area.top()),
                     across(area.width), across(area.height));
}

void Svg::stroke(std::span<const Path> paths, const Pen& pen) {
  const std::string data = data_of(paths);
  if (data.empty()) return;
  std::string dashes;
  for (const double length : pen.dashes) dashes += (dashes.empty() ? "" : " ") + number(length);
  if (!dashes.empty()) dashes = " stroke-dasharray=\"" + dashes + "\"";
  say(R"(<path fill="none" stroke="{}"{} stroke-width="{}" stroke-linejoin="round"{} d="{}"/>)", pen.paint.colour,
      opacity("stroke", pen.paint), number(pen.width), dashes, data);
}

void Svg::fill(std::span<const Path> polygons, const Paint& paint) {
  const std::string data = data_of(polygons);
  if (!data.empty()) say(R"(<path fill="{}"{} d="{}"/>)", paint.colour, opacity("fill", paint), data);
}

void Svg::tile(const Area& area, const std::string& colour) {
  const std::string width = across(area.width), height = across(area.height);
  say(R"(<path fill="{0}" stroke="{0}" d="M{1},{2}h{3}v-{4}h-{3}z"/>)", colour, across(area.left), down(area.bottom),
      width, height);
}

void Svg::shade(const Area& area, std::span<const std::string_view> colours) {
  say(R"(<linearGradient id="p{}" x1="0" y1="1" x2="0" y2="0">)", ++named_);
  for (std::size_t k = 0; k < colours.size(); ++k) {
    const double offset = static_cast<double>(k) / static_cast<double>(colours.size() - 1);
    say(R"(<stop offset="{:.4g}" stop-color="{}"/>)", offset, colours[k]);
  }
  say(R"x(</linearGradient>{} fill="url(#p{})"/>)x", box_of(area), named_);
}

void Svg::symbols(const Path& at, Symbol symbol, double radius, Colour colour) {
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

void Svg::write(const Words& words) {
  constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
  const double lower = sizes.half_capital * words.points * kMillimetresPerPoint;
  const std::string place =
      words.upright
          ? fmt::format("transform=\"translate({},{}) rotate(-90)\"", across(words.at.x + lower), down(words.at.y))
          : fmt::format("x=\"{}\" y=\"{}\"", across(words.at.x), down(words.at.y - lower));
  const std::string text = spans_of(words), size = number(words.points);
  const std::string_view anchor = kAnchors[static_cast<int>(words.anchor)];
  if (words.halo) {
    say(R"(<text {} font-size="{}" text-anchor="{}" fill="#fff" stroke="#fff" stroke-width="{}" )"
        R"(stroke-linejoin="round" aria-hidden="true">{}</text>)",
        place, size, anchor, sizes.halo, text);
  }
  say(R"(<text {} font-size="{}" text-anchor="{}">{}</text>)", place, size, anchor, text);
}

void Svg::begin_plot(const Area& area) {
  say(R"(<clipPath id="p{}">{}/></clipPath>)", ++named_, box_of(area));
  say(R"x(<g class="plot" stroke-width="0.4" clip-path="url(#p{})">)x", named_);
}

}  // namespace tribofit
