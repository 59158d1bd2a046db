#include "report/charts/gnuplot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <vector>

#include "report/charts/gnuplot_data.hpp"
#include "report/charts/gnuplot_style.hpp"
#include "report/charts/gnuplot_text.hpp"

namespace tribofit {
namespace {

constexpr double kMillimetresPerInch = 25.4;
constexpr double kPointsPerPixel = 0.75;  // of CSS

/// Cividis (Nunez, Anderton & Renslow 2018), made for people who do not see colours alike: lightness rises evenly.
constexpr std::string_view kPalette =
    "set palette defined (0 '#00204c', 1 '#00336f', 2 '#39486b', 3 '#575c6d', 4 '#707173', 5 '#8a8779', 6 '#a69d75', "
    "7 '#c4b56c', 8 '#e4cf5b', 9 '#ffe945')\n";

/// What is said at a tic, for a label.
std::string text_of(const Scale& scale, const Scale::Tic& tic) {
  return scale.named ? tribofit::quoted(tic.text) : quoted_markup(tic.text);
}

/// Everything about one picture.
class Script {
 public:
  Script(const Chart& chart, PictureFormat format, const PictureLayout& layout)
      : chart_(chart), format_(format), layout_(layout) {}

  std::string text(const std::string& output);

 private:
  template <class... Parts>
  void say(fmt::format_string<Parts...> pattern, Parts&&... parts) {
    out_ += fmt::format(pattern, std::forward<Parts>(parts)...) + "\n";
  }
  std::string at(double x, double y) const {
    return fmt::format("screen {:.6f},{:.6f}", x / kPictureWidth, y / layout_.height);
  }
  std::string style(double points, Dash dash = Dash::solid, const char* colour = "#000000") const {
    return line_style(format_, colour, points, dash);
  }

  std::string small_font() const {
    return fmt::format("',{:.4g}'", kSmallTextPoints / (format_ == PictureFormat::svg ? kPointsPerPixel : 1));
  }

  void add_terminal(const std::string& output);
  void add_panel(std::size_t panel);
  void add_axis(char letter, const Scale& scale);
  void add_numbers();
  void add_titles();
  void add_stretches();
  void add_marks(std::size_t panel);
  void add_labels(std::size_t panel);
  void add_keys();
  void add_sample(const Key& key);
  void add_colour_box();

  const Chart& chart_;
  PictureFormat format_;
  const PictureLayout& layout_;
  std::string out_;
};

std::string Script::text(const std::string& output) {
  add_terminal(output);
  say("set multiplot");
  for (std::size_t k = 0; k < layout_.panels.size(); ++k) add_panel(k);
  say("unset multiplot");
  say("unset output");
  return std::move(out_);
}

void Script::add_terminal(const std::string& output) {
  say("reset");
  say("undefine $*");
  say("set encoding utf8");
  const int width = terminal_width(format_), height = terminal_height(layout_, format_);
  switch (format_) {
    case PictureFormat::svg:
      say("set terminal svg size {},{} font 'Arial,{:.4g}' background '#ffffff'", width, height,
          kTextPoints / kPointsPerPixel);
      break;
    case PictureFormat::pdf:  // the tenth keeps the size from being rounded down
      say("set terminal pdfcairo size {:.5f}in,{:.5f}in font 'Arial,{}' fontscale 0.75", (width + 0.1) / 72,
          (height + 0.1) / 72, kTextPoints);
      break;
    case PictureFormat::png:
      say("set terminal pngcairo size {},{} font 'Arial,{}' fontscale {:.5g} pointscale {:.5g}", width, height,
          kTextPoints, 0.75 * kPicturePixelsPerInch / 72.0, kPicturePixelsPerInch / 72.0);
      break;
  }
  say("set output {}", tribofit::quoted(output));
  say("unset key");
  say("set errorbars 0.6");
  out_ += kPalette;
}

void Script::add_panel(std::size_t panel) {
  const Area& area = layout_.panels[panel];
  say("unset object; unset arrow; unset label; unset colorbox");
  say("set lmargin at screen {:.6f}; set rmargin at screen {:.6f}", area.left / kPictureWidth,
      (area.left + area.width) / kPictureWidth);
  say("set bmargin at screen {:.6f}; set tmargin at screen {:.6f}", area.bottom / layout_.height,
      (area.bottom + area.height) / layout_.height);
  add_axis('x', layout_.x);
  add_axis('y', layout_.y[panel]);
  say("set border 3 {}", style(0.5));
  say("set grid back {}", style(0.35, Dash::solid, "#e2e2e2"));
  if (panel == 0) {
    add_numbers();
    add_titles();
    add_keys();
    if (chart_.map) add_colour_box();
  }
  add_stretches();
  add_marks(panel);
  add_labels(panel);
  PlotList plots(layout_.x, layout_.y[panel], area, format_);
  if (panel == 0 && chart_.map) plots.add_map(*chart_.map, layout_.colours);
  if (panel == 0 && !chart_.bars.empty()) plots.add_bars(chart_.bars);
  for (const ChartLine& line : chart_.lines) {
    if (line.shown && line.panel == panel) plots.add_line(line);
  }
  out_ += plots.text();
}

/// Range and tics without their numbers, which add_numbers() writes: terminals differ in where they would put them.
void Script::add_axis(char letter, const Scale& scale) {
  say("{}set logscale {}", scale.logarithmic ? "" : "un", letter);
  say("set {}range [{:.10g}:{:.10g}]", letter, scale.falling ? scale.high : scale.low,
      scale.falling ? scale.low : scale.high);
  std::string tics;
  for (const Scale::Tic& tic : scale.tics) tics += fmt::format("{}'' {:.10g}", tics.empty() ? "" : ", ", tic.at);
  say("unset {}tics", letter);
  if (!tics.empty()) say("set {}tics out nomirror scale {} ({})", letter, scale.named ? 0 : 0.4, tics);
}

/// Numbers and names at the axes.
void Script::add_numbers() {
  const Area& lowest = layout_.panels.back();
  for (const Scale::Tic& tic : layout_.x.tics) {
    const double x = lowest.left + layout_.x.part(tic.at) * lowest.width;
    if (layout_.upright_names) {
      say("set label {} at {} right rotate by 90 noenhanced", tribofit::quoted(tic.text), at(x, lowest.bottom - kTicGap));
    } else {
      say("set label {} at {} center {}", text_of(layout_.x, tic), at(x, lowest.bottom - kTicGap - kTextLine / 2),
          layout_.x.named ? "noenhanced" : "enhanced");
    }
  }
  for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
    const Area& area = layout_.panels[k];
    for (const Scale::Tic& tic : layout_.y[k].tics) {
      say("set label {} at {} right {}", text_of(layout_.y[k], tic),
          at(area.left - kTicGap, area.bottom + layout_.y[k].part(tic.at) * area.height),
          layout_.y[k].named ? "noenhanced" : "enhanced");
    }
  }
}

void Script::add_titles() {
  const Area &low = layout_.panels.back(), &high = layout_.panels.front();
  if (!layout_.x.title.empty()) {
    const double half = std::min(kPictureWidth, width_of(layout_.x.title)) / 2;
    const double middle = std::clamp(low.left + low.width / 2, half, kPictureWidth - half);
    say("set label {} at {} center enhanced", quoted_markup(layout_.x.title), at(middle, layout_.x_title_y));
  }
  for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
    const Area& area = layout_.panels[k];
    double x = layout_.title_x;
    for (const std::string& line : layout_.titles[k]) {
      say("set label {} at {} center rotate by 90 enhanced", quoted_markup(line), at(x, area.bottom + area.height / 2));
      x += kTextLine;
    }
  }
  if (chart_.map && !layout_.colours.title.empty()) {
    say("set label {} at {} center rotate by 90 enhanced", quoted_markup(layout_.colours.title),
        at(layout_.colour_title_x, (low.bottom + high.bottom + high.height) / 2));
  }
}

void Script::add_stretches() {
  for (const Stretch& stretch : chart_.stretches) {
    const double from = std::clamp(layout_.x.part(stretch.from), 0.0, 1.0);
    const double to = std::clamp(layout_.x.part(stretch.to), 0.0, 1.0);
    if (!(std::abs(to - from) > 0)) continue;  // elsewhere, or nowhere on a logarithmic axis
    say("set object rectangle from graph {:.6f}, graph 0 to graph {:.6f}, graph 1 behind fs solid 1 noborder fc rgb "
        "'{}'",
        from, to, fill(stretch.shade));
  }
}

/// Words at upright marks stand in rows at the top, so that none lies upon another.
void Script::add_marks(std::size_t panel) {
  constexpr double kLine = 3;
  std::vector<double> taken;  // right ends of the words in each row
  std::vector<const ChartMark*> upright;
  for (const ChartMark& mark : chart_.marks) {
    const Scale& scale = mark.upright ? layout_.x : layout_.y[panel];
    const double part = scale.part(mark.at);
    if (!(part >= 0 && part <= 1) || (!mark.upright && mark.panel != panel)) continue;
    const std::string line = style(0.6, mark.dash, "#444444");
    if (mark.upright) {
      say("set arrow from graph {0:.6f},0 to graph {0:.6f},1 nohead front {1}", part, line);
      if (panel == 0 && !mark.text.empty()) upright.push_back(&mark);
      continue;
    }
    say("set arrow from graph 0,{0:.6f} to graph 1,{0:.6f} nohead front {1}", part, line);
    if (mark.text.empty()) continue;
    const Area& area = layout_.panels[panel];
    const bool below = (1 - part) * area.height < kLine;
    say("set label {} at {} left front enhanced font {}", quoted_markup(mark.text),
        at(area.left + 0.8, area.bottom + part * area.height + (below ? -1.6 : 1.6)), small_font());
  }
  std::sort(upright.begin(), upright.end(),
            [&](const ChartMark* a, const ChartMark* b) { return layout_.x.part(a->at) < layout_.x.part(b->at); });
  const Area& area = layout_.panels[panel];
  const auto place = [&](std::size_t k) { return layout_.x.part(upright[k]->at) * area.width; };
  for (std::size_t k = 0; k < upright.size(); ++k) {
    const ChartMark* mark = upright[k];
    const double width = width_of(mark->text, kSmallTextPoints), x = place(k);
    // To the right where no other line stands in the way, else to the left where that is free.
    const double next = k + 1 < upright.size() ? place(k + 1) : area.width, before = k > 0 ? place(k - 1) : 0;
    const bool leftwards = x + 0.8 + width > area.width || (x + 0.8 + width > next && x - 0.8 - width >= before);
    const double from = leftwards ? x - 0.8 - width : x + 0.8;
    std::size_t row = 0;
    while (row < taken.size() && taken[row] > from) ++row;
    if (row == taken.size()) taken.push_back(0);
    taken[row] = from + width + 1;
    say("set label {} at {} left front enhanced font {}", quoted_markup(mark->text),
        at(area.left + from, area.bottom + area.height - 1.6 - kLine * static_cast<double>(row)), small_font());
  }
}

/// Above their points, within the panel.
void Script::add_labels(std::size_t panel) {
  constexpr double kAbove = 2.6;
  const Area& area = layout_.panels[panel];
  for (const ChartLabel& label : chart_.labels) {
    if (label.panel != panel) continue;
    const double x = layout_.x.part(label.x), y = layout_.y[panel].part(label.y);
    if (!(x >= 0 && x <= 1 && y >= 0 && y <= 1)) continue;
    const double half = std::min(width_of(label.text, kSmallTextPoints), area.width) / 2;
    const double middle = std::clamp(x * area.width, half, area.width - half);
    const bool below = (1 - y) * area.height < kAbove + 1.5;
    say("set label {} at {} center front enhanced font {}", quoted_markup(label.text),
        at(area.left + middle, area.bottom + y * area.height + (below ? -kAbove : kAbove)), small_font());
  }
}

void Script::add_keys() {
  for (const Key& key : layout_.keys) {
    add_sample(key);
    say("set label {} at {} left noenhanced", tribofit::quoted(key.name), at(key.x + kKeySample + kKeyGap, key.y));
  }
}

void Script::add_sample(const Key& key) {
  const double right = key.x + kKeySample, half = 1.1;
  const auto box = [&](const std::string& colour, const std::string& border) {
    say("set object rectangle from {} to {} front fs solid 1 {} fc rgb '{}'", at(key.x, key.y - half),
        at(right, key.y + half), border, colour);
  };
  const auto line = [&](double x0, double y0, double x1, double y1, const std::string& how) {
    say("set arrow from {} to {} nohead front {}", at(x0, y0), at(x1, y1), how);
  };
  if (key.stretch != nullptr) box(fill(key.stretch->shade), "border lc rgb '#bbbbbb'");
  if (key.bars != nullptr) {
    box(key.bars->hatched ? "#ffffff" : ink(key.bars->colour), "border lc rgb '#000000'");
    for (double x = key.x + 0.4; key.bars->hatched && x + 2 * half < right; x += 1.1) {
      line(x, key.y - half, x + 2 * half, key.y + half, line_style(format_, ink(key.bars->colour), 0.9));
    }
  }
  if (key.band != nullptr) box(pale(key.band->stroke.colour), "noborder");
  if (key.line == nullptr) return;
  const Stroke& stroke = key.line->stroke;
  if (stroke.joined) {
    line(key.x, key.y, right, key.y, line_style(format_, ink(stroke.colour), line_width(stroke), stroke.dash));
  }
  if (stroke.symbol != Symbol::none || !stroke.joined) {
    say("set label '' at {} point {} front", at(key.x + kKeySample / 2, key.y), symbol_style(format_, stroke));
  }
}

void Script::add_colour_box() {
  const Area& box = layout_.colour_box;
  say("set cbrange [{:.10g}:{:.10g}]", layout_.colours.low, layout_.colours.high);
  say("set colorbox vertical user origin {} size {} noborder", at(box.left, box.bottom), at(box.width, box.height));
  say("unset cbtics");
  for (const Scale::Tic& tic : layout_.colours.tics) {
    const double y = box.bottom + layout_.colours.part(tic.at) * box.height, right = box.left + box.width;
    say("set arrow from {} to {} nohead front {}", at(right, y), at(right + 0.6, y), style(0.5));
    say("set label {} at {} left enhanced", quoted_markup(tic.text), at(right + kTicGap, y));
  }
}

}  // namespace

int terminal_width(PictureFormat format) {
  switch (format) {
    case PictureFormat::svg:
      return static_cast<int>(std::lround(kPictureWidth / kMillimetresPerInch * 96));
    case PictureFormat::pdf:
      return static_cast<int>(std::lround(kPictureWidth / kMillimetresPerInch * 72));
    case PictureFormat::png:
      return static_cast<int>(std::lround(kPictureWidth / kMillimetresPerInch * kPicturePixelsPerInch));
  }
  return 0;
}

int terminal_height(const PictureLayout& layout, PictureFormat format) {
  return static_cast<int>(std::lround(terminal_width(format) * layout.height / kPictureWidth));
}

std::string gnuplot_script(const Chart& chart, PictureFormat format, const std::string& output) {
  const PictureLayout layout = layout_of(chart);
  return Script(chart, format, layout).text(output);
}

}  // namespace tribofit
