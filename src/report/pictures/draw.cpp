#include "report/pictures/draw.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit {
namespace {

constexpr Paint kGrid = {kGridColour}, kMark = {kAxisColour};

/// Everything about one picture but the data.
class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart), layout_(layout_of(chart)), sheet_(sizes.width, layout_.height, one_line(chart.title)) {}

  std::string drawn() {
    for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
      const PanelFrame f = frame(k);
      draw_ground(f);
      if (k == 0 && chart_.map) draw_map(f, *chart_.map, layout_.colours);
      if (k == 0 && !chart_.bars.empty()) draw_bars(f, chart_.bars);
      for (const ChartLine& one : chart_.lines) {
        if (one.shown && one.panel == k) draw_line(f, one);
      }
      draw_axes(f, k);
      draw_marks(f, k);
      if (k == 0) draw_upright_words(f);
      draw_labels(f, k);
    }
    draw_title_of_abscissa();
    for (const Key& key : layout_.keys) draw_key(key);
    if (chart_.map) draw_colour_box();
    return sheet_.finish();
  }

 private:
  PanelFrame frame(std::size_t panel) { return {layout_.x, layout_.y[panel], layout_.panels[panel], sheet_}; }

  /// Shaded stretches and the grid.
  void draw_ground(const PanelFrame& f) {
    const double bottom = f.area.bottom, top = f.area.top(), right = f.area.right();
    for (const Stretch& stretch : chart_.stretches) {
      const double from = std::clamp(f.across(stretch.from), f.area.left, right);
      const double to = std::clamp(f.across(stretch.to), f.area.left, right);
      if (!(std::abs(to - from) > 0)) continue;  // elsewhere, or nowhere on a logarithmic axis
      sheet_.fill(Area{from, bottom, to - from, f.area.height}, style_of(stretch.shade, kShades).paint);
    }
    std::vector<Path> grid;
    for (const Scale::Tic& tic : f.x.tics) grid.push_back({{f.across(tic.at), bottom}, {f.across(tic.at), top}});
    for (const Scale::Tic& tic : f.y.tics) grid.push_back({{f.area.left, f.up(tic.at)}, {right, f.up(tic.at)}});
    sheet_.stroke(grid, {kGrid, 0.35});
  }

  /// With their numbers or names, and the title of the ordinate.
  void draw_axes(const PanelFrame& f, std::size_t panel) {
    const double left = f.area.left, bottom = f.area.bottom;
    std::vector<Path> lines = {{{left, f.area.top()}, {left, bottom}, {f.area.right(), bottom}}};
    const bool lowest = panel + 1 == layout_.panels.size(), upright = layout_.upright_names;
    for (const Scale::Tic& tic : f.x.tics) {
      const double x = f.across(tic.at), y = bottom - sizes.tic_gap - (upright ? 0 : sizes.text_line / 2);
      if (!f.x.named) lines.push_back({{x, bottom}, {x, bottom - sizes.tic}});
      if (!lowest) continue;
      sheet_.write({.text = tic.text,
                    .at = {x, y},
                    .anchor = upright ? Anchor::right : Anchor::centre,
                    .upright = upright,
                    .markup = !f.x.named});
    }
    for (const Scale::Tic& tic : f.y.tics) {
      const double y = f.up(tic.at);
      if (!f.y.named) lines.push_back({{left, y}, {left - sizes.tic, y}});
      sheet_.write({.text = tic.text, .at = {left - sizes.tic_gap, y}, .anchor = Anchor::right, .markup = !f.y.named});
    }
    sheet_.stroke(lines, {});
    double x = layout_.title_x;
    for (const std::string& title : layout_.titles[panel]) {
      write_upright(title, {x, bottom + f.area.height / 2});
      x += sizes.text_line;
    }
  }

  void write_upright(const std::string& title, const Point& at) {
    sheet_.write({.text = title, .at = at, .anchor = Anchor::centre, .upright = true});
  }

  void write_beside(const std::string& text, const Point& at, Anchor anchor = Anchor::left) {
    sheet_.write({.text = text, .at = at, .anchor = anchor, .points = sizes.small_text, .halo = true});
  }

  /// Points of the lines of a panel within an area.
  std::size_t points_in(const Area& area, const PanelFrame& f, std::size_t panel) const {
    std::size_t count = 0;
    for (const ChartLine& one : chart_.lines) {
      if (!one.shown || one.panel != panel) continue;
      for (std::size_t k = 0; k < std::min(one.x.size(), one.y.size()); ++k) {
        if (area.holds(f.at(one.x[k], one.y[k]))) ++count;
      }
    }
    return count;
  }

  /// The words of level marks stand above them, at the end where they hide less.
  void draw_marks(const PanelFrame& f, std::size_t panel) {
    constexpr double kHalf = 1.6, kReach = 1;  // half a line of text, half a large symbol
    const double left = f.area.left, right = f.area.right(), bottom = f.area.bottom, top = f.area.top();
    for (const ChartMark& mark : chart_.marks) {
      const Pen pen{kMark, 0.6, pen_of({.dash = mark.dash}).dashes};
      const double part = mark.upright ? f.x.part(mark.at) : f.y.part(mark.at);
      if (!(part >= 0 && part <= 1) || (!mark.upright && mark.panel != panel)) continue;
      if (mark.upright) {
        sheet_.stroke({{f.across(mark.at), bottom}, {f.across(mark.at), top}}, pen);
        continue;
      }
      const double y = f.up(mark.at);
      sheet_.stroke({{left, y}, {right, y}}, pen);
      if (mark.text.empty()) continue;
      const double width = width_of(mark.text, sizes.small_text);
      const double low = top - y < sizes.mark_line ? y - 2 * kHalf : y;
      const double first = left + sizes.beside_mark, last = right - sizes.beside_mark - width;
      const auto hidden = [&](double from) {
        return points_in({from - kReach, low - kReach, width + 2 * kReach, 2 * (kHalf + kReach)}, f, panel);
      };
      write_beside(mark.text, {hidden(first) > hidden(last) ? last : first, low + kHalf});
    }
  }

  void draw_upright_words(const PanelFrame& f) {
    for (const UprightWords& words : layout_.upright_words) {
      const double y = f.area.top() - sizes.mark_line * (static_cast<double>(words.row) + 0.5);
      write_beside(words.mark->text, {f.area.left + words.from, y});
    }
  }

  /// Above their points, within the panel.
  void draw_labels(const PanelFrame& f, std::size_t panel) {
    for (const ChartLabel& label : chart_.labels) {
      const Point at = f.at(label.x, label.y);
      if (label.panel != panel || !f.area.holds(at)) continue;
      const double half = std::min(width_of(label.text, sizes.small_text), f.area.width) / 2;
      const double middle = std::clamp(at.x, f.area.left + half, f.area.right() - half);
      const bool below = f.area.top() - at.y < sizes.above_label + 1.5;
      write_beside(label.text, {middle, at.y + (below ? -sizes.above_label : sizes.above_label)}, Anchor::centre);
    }
  }

  void draw_title_of_abscissa() {
    const Area& area = layout_.panels.back();
    const double half = std::min(sizes.width, width_of(layout_.x.title)) / 2;
    const double middle = std::clamp(area.left + area.width / 2, half, sizes.width - half);
    sheet_.write({.text = layout_.x.title, .at = {middle, layout_.x_title_y}, .anchor = Anchor::centre});
  }

  void draw_key(const Key& key) {
    const Area box{key.x, key.y - sizes.key_half, sizes.key_sample, 2 * sizes.key_half};
    if (key.stretch != nullptr) {
      sheet_.fill(box, style_of(key.stretch->shade, kShades).paint);
      sheet_.stroke(box.outline(), {{kKeyColour}, 0.5});
    }
    if (key.bars != nullptr) draw_box(sheet_, box, key.bars->colour, key.bars->hatched);
    if (key.band != nullptr) sheet_.fill(box, pale(key.band->stroke.colour));
    if (key.line != nullptr) {
      const Stroke& stroke = key.line->stroke;
      if (stroke.joined) sheet_.stroke({{box.left, key.y}, {box.right(), key.y}}, pen_of(stroke));
      if (stroke.symbol != Symbol::none || !stroke.joined)
        draw_symbols(sheet_, {{box.left + box.width / 2, key.y}}, stroke);
    }
    sheet_.write({.text = key.name, .at = {box.right() + sizes.key_gap, key.y}, .markup = false});
  }

  void draw_colour_box() {
    const Area& box = layout_.colour_box;
    const double right = box.right();
    sheet_.shade(box, colours_of(*chart_.map));
    write_upright(layout_.colours.title, {layout_.colour_title_x, box.bottom + box.height / 2});
    for (const Scale::Tic& tic : layout_.colours.tics) {
      const double y = box.bottom + layout_.colours.part(tic.at) * box.height;
      sheet_.stroke({{right, y}, {right + sizes.tic, y}}, {});
      sheet_.write({.text = tic.text, .at = {right + sizes.tic_gap, y}});
    }
  }

  const Chart& chart_;
  const PictureLayout layout_;
  Svg sheet_;
};

}  // namespace

std::string drawn(const Chart& chart) {
  return Drawing(chart).drawn();
}

}  // namespace tribofit
