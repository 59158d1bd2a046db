#include <fmt/format.h>

#include <iterator>
#include <string_view>

#include "report/pictures/canvas.hpp"

namespace tribofit {
namespace {

/// A number to a hundredth of a point, without zeros that say nothing.
std::string number(double value) {
  std::string text = fmt::format("{:.2f}", value);
  while (text.ends_with('0')) text.pop_back();
  if (text.ends_with('.')) text.pop_back();
  return text == "-0" ? "0" : text;
}

/// SVG, in points; text stays text.
class SvgCanvas : public Canvas {
 public:
  SvgCanvas(double width, double height, const std::string& title) : Canvas(height) {
    out_ = fmt::format(
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}mm\" "
        "height=\"{:.2f}mm\" viewBox=\"0 0 {} {}\" font-family=\"Arial, 'Liberation Sans', Helvetica, sans-serif\" "
        "xml:space=\"preserve\"><title>{}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
        width, height, number(across(width)), number(across(height)), escaped(title));
  }

  void stroke(std::span<const Path> paths, const Pen& pen) override {
    const std::string data = data_of(paths, "h0");
    if (data.empty()) return;
    std::string dashes;
    for (const double length : pen.dashes) dashes += (dashes.empty() ? "" : " ") + number(length);
    say("<path fill=\"none\" stroke=\"{}\"{} stroke-width=\"{}\" {}stroke-linejoin=\"round\"{} d=\"{}\"/>",
        pen.paint.colour, opacity("stroke", pen.paint), number(pen.width), dots_ ? "stroke-linecap=\"round\" " : "",
        dashes.empty() ? "" : " stroke-dasharray=\"" + dashes + "\"", data);
  }
  void fill(std::span<const Path> polygons, const Paint& paint) override {
    const std::string data = data_of(polygons, "");
    if (!data.empty()) say("<path fill=\"{}\"{} d=\"{}\"/>", paint.colour, opacity("fill", paint), data);
  }
  void write(const Words& words) override;
  void begin_plot(const Area& area) override {
    say("<clipPath id=\"plot{}\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/></clipPath>", ++plots_,
        number(across(area.left)), number(down(area.top())), number(across(area.width)), number(across(area.height)));
    say("<g class=\"plot\" clip-path=\"url(#plot{})\">", plots_);
  }
  void end_plot() override { say("</g>"); }
  std::string finish() override { return std::move(out_) + "</svg>\n"; }

 private:
  template <class... Parts>
  void say(fmt::format_string<Parts...> pattern, Parts&&... parts) {
    fmt::format_to(std::back_inserter(out_), pattern, std::forward<Parts>(parts)...);
    out_ += '\n';
  }
  static std::string opacity(std::string_view what, const Paint& paint) {
    return paint.opacity < 1 ? fmt::format(" {}-opacity=\"{:.3g}\"", what, paint.opacity) : "";
  }
  /// lone: what stands after a path of one point.
  std::string data_of(std::span<const Path> paths, std::string_view lone) {
    std::string data;
    dots_ = false;
    for (const Path& path : paths) {
      for (std::size_t k = 0; k < path.size(); ++k) {
        fmt::format_to(std::back_inserter(data), "{}{},{}", k == 0 ? 'M' : 'L', number(across(path[k].x)),
                       number(down(path[k].y)));
      }
      if (path.size() != 1) continue;
      data += lone;
      dots_ = true;
    }
    return data;
  }

  int plots_ = 0;
  bool dots_ = false;
  std::string out_;
};

void SvgCanvas::write(const Words& words) {
  const double x = across(words.at.x), y = down(words.at.y), lower = kHalfOfCapital * words.points;
  std::string text;
  int level = 0;
  for (const TextPiece& piece : words.pieces()) {
    const std::string shift =
        piece.level == level ? ""
                             : fmt::format(" dy=\"{}\"", number((level - piece.level) * kScriptRise * words.points));
    const std::string size =
        piece.level == 0 ? "" : fmt::format(" font-size=\"{}\"", number(kScriptSize * words.points));
    text += shift.empty() && size.empty() ? escaped(piece.text)
                                          : fmt::format("<tspan{}{}>{}</tspan>", shift, size, escaped(piece.text));
    level = piece.level;
  }
  constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
  const std::string place =
      words.upright ? fmt::format("transform=\"translate({},{}) rotate(-90)\"", number(x + lower), number(y))
                    : fmt::format("x=\"{}\" y=\"{}\"", number(x), number(y + lower));
  const auto say_text = [&](const std::string& style) {
    say("<text {} font-size=\"{}\" text-anchor=\"{}\"{}>{}</text>", place, number(words.points),
        kAnchors[static_cast<int>(words.anchor)], style, text);
  };
  if (words.halo) {
    say_text(fmt::format(R"( fill="#fff" stroke="#fff" stroke-width="{}" stroke-linejoin="round" aria-hidden="true")",
                         kHalo));
  }
  say_text("");
}

}  // namespace

std::unique_ptr<Canvas> make_svg(double width, double height, const std::string& title) {
  return std::make_unique<SvgCanvas>(width, height, title);
}

}  // namespace tribofit
