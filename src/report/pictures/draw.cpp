#include "report/pictures/draw.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit {
namespace {

constexpr Paint kGrid = {kGridColour}, kMark = {kAxisColour};

/// Everything about one picture but the data.
class Drawing {
 public:
  Drawing(const Chart& chart, const PictureLayout& layout, Canvas& canvas)
      : chart_(chart), layout_(layout), canvas_(canvas) {}

  void draw() {
    for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
      const PanelFrame f = frame(k);
      draw_ground(f);
      if (k == 0 && chart_.map) draw_map(f, *chart_.map, layout_.colours);
      if (k == 0 && !chart_.bars.empty()) draw_bars(f, chart_.bars);
      for (const ChartLine& one : chart_.lines) {
        if (one.shown && one.panel == k) draw_line(f, one);
      }
      draw_axes(f);
      draw_marks(f, k);
      if (k == 0) draw_upright_words(f);
      draw_labels(f, k);
    }
    draw_numbers();
    draw_titles();
    draw_keys();
    if (chart_.map) draw_colour_box();
  }

 private:
  PanelFrame frame(std::size_t panel) const { return {layout_.x, layout_.y[panel], layout_.panels[panel], canvas_}; }
  void line(const Point& from, const Point& to, const Pen& pen = {}) { canvas_.stroke_path({from, to}, pen); }

  /// Shaded stretches and the grid.
  void draw_ground(const PanelFrame& f) {
    const double bottom = f.area.bottom, top = f.area.top(), right = f.area.right();
    for (const Stretch& stretch : chart_.stretches) {
      const double from = std::clamp(f.across(stretch.from), f.area.left, right);
      const double to = std::clamp(f.across(stretch.to), f.area.left, right);
      if (!(std::abs(to - from) > 0)) continue;  // elsewhere, or nowhere on a logarithmic axis
      canvas_.fill_path(Area{from, bottom, to - from, f.area.height}.corners(), style_of(stretch.shade, kShades).paint);
    }
    std::vector<Path> grid;
    for (const Scale::Tic& tic : f.x.tics) grid.push_back({{f.across(tic.at), bottom}, {f.across(tic.at), top}});
    for (const Scale::Tic& tic : f.y.tics) grid.push_back({{f.area.left, f.up(tic.at)}, {right, f.up(tic.at)}});
    canvas_.stroke(grid, {kGrid, 0.35});
  }

  void draw_axes(const PanelFrame& f) {
    constexpr double kTic = 0.7;
    const double left = f.area.left, bottom = f.area.bottom;
    std::vector<Path> lines = {{{left, f.area.top()}, {left, bottom}, {f.area.right(), bottom}}};
    for (const Scale::Tic& tic : f.x.tics) {
      if (!f.x.named) lines.push_back({{f.across(tic.at), bottom}, {f.across(tic.at), bottom - kTic}});
    }
    for (const Scale::Tic& tic : f.y.tics) {
      if (!f.y.named) lines.push_back({{left, f.up(tic.at)}, {left - kTic, f.up(tic.at)}});
    }
    canvas_.stroke(lines, {});
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
        line({f.across(mark.at), bottom}, {f.across(mark.at), top}, pen);
        continue;
      }
      const double y = f.up(mark.at);
      line({left, y}, {right, y}, pen);
      if (mark.text.empty()) continue;
      const double width = width_of(mark.text, kSmallTextPoints);
      const double low = top - y < kMarkLine ? y - 2 * kHalf : y;
      const double first = left + kBesideMark, last = right - kBesideMark - width;
      const auto hidden = [&](double from) {
        return points_in({from - kReach, low - kReach, width + 2 * kReach, 2 * (kHalf + kReach)}, f, panel);
      };
      canvas_.write({.text = mark.text,
                     .at = {hidden(first) > hidden(last) ? last : first, low + kHalf},
                     .points = kSmallTextPoints,
                     .halo = true});
    }
  }

  void draw_upright_words(const PanelFrame& f) {
    for (const UprightWords& words : layout_.upright_words) {
      const double y = f.area.top() - kMarkLine * (static_cast<double>(words.row) + 0.5);
      canvas_.write(
          {.text = words.mark->text, .at = {f.area.left + words.from, y}, .points = kSmallTextPoints, .halo = true});
    }
  }

  /// Above their points, within the panel.
  void draw_labels(const PanelFrame& f, std::size_t panel) {
    constexpr double kAbove = 2.6;
    for (const ChartLabel& label : chart_.labels) {
      const Point at = f.at(label.x, label.y);
      if (label.panel != panel || !f.area.holds(at)) continue;
      const double half = std::min(width_of(label.text, kSmallTextPoints), f.area.width) / 2;
      const double middle = std::clamp(at.x, f.area.left + half, f.area.right() - half);
      const bool below = f.area.top() - at.y < kAbove + 1.5;
      canvas_.write({.text = label.text,
                     .at = {middle, at.y + (below ? -kAbove : kAbove)},
                     .anchor = Anchor::centre,
                     .points = kSmallTextPoints,
                     .halo = true});
    }
  }

  /// Numbers and names at the axes.
  void draw_numbers() {
    const PanelFrame lowest = frame(layout_.panels.size() - 1);
    for (const Scale::Tic& tic : layout_.x.tics) {
      const double y = lowest.area.bottom - kTicGap - (layout_.upright_names ? 0 : kTextLine / 2);
      canvas_.write({tic.text,
                     {lowest.across(tic.at), y},
                     layout_.upright_names ? Anchor::right : Anchor::centre,
                     kTextPoints,
                     layout_.upright_names,
                     !layout_.x.named});
    }
    for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
      const PanelFrame f = frame(k);
      for (const Scale::Tic& tic : f.y.tics) {
        canvas_.write({tic.text, {f.area.left - kTicGap, f.up(tic.at)}, Anchor::right, kTextPoints, false, !f.y.named});
      }
    }
  }

  void draw_titles() {
    const Area &low = layout_.panels.back(), &high = layout_.panels.front();
    const double half = std::min(kPictureWidth, width_of(layout_.x.title)) / 2;
    const double middle = std::clamp(low.left + low.width / 2, half, kPictureWidth - half);
    canvas_.write({layout_.x.title, {middle, layout_.x_title_y}, Anchor::centre});
    for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
      const Area& area = layout_.panels[k];
      double x = layout_.title_x;
      for (const std::string& title : layout_.titles[k]) {
        canvas_.write({title, {x, area.bottom + area.height / 2}, Anchor::centre, kTextPoints, true});
        x += kTextLine;
      }
    }
    if (!chart_.map) return;
    const Point beside{layout_.colour_title_x, (low.bottom + high.top()) / 2};
    canvas_.write({layout_.colours.title, beside, Anchor::centre, kTextPoints, true});
  }

  void draw_keys() {
    for (const Key& key : layout_.keys) {
      draw_sample(key);
      canvas_.write({key.name, {key.x + kKeySample + kKeyGap, key.y}, Anchor::left, kTextPoints, false, false});
    }
  }

  void draw_sample(const Key& key) {
    constexpr double kHalf = 1.1;
    const Area box{key.x, key.y - kHalf, kKeySample, 2 * kHalf};
    if (key.stretch != nullptr) {
      canvas_.fill_path(box.corners(), style_of(key.stretch->shade, kShades).paint);
      canvas_.stroke_path(closed(box.corners()), {{kKeyColour}, 0.5});
    }
    if (key.bars != nullptr) draw_box(canvas_, box, key.bars->colour, key.bars->hatched);
    if (key.band != nullptr) canvas_.fill_path(box.corners(), pale(key.band->stroke.colour));
    if (key.line == nullptr) return;
    const Stroke& stroke = key.line->stroke;
    if (stroke.joined) line({box.left, key.y}, {box.right(), key.y}, pen_of(stroke));
    if (stroke.symbol != Symbol::none || !stroke.joined)
      draw_symbols(canvas_, {{box.left + box.width / 2, key.y}}, stroke);
  }

  void draw_colour_box() {
    constexpr int kSteps = 64;
    const Area& box = layout_.colour_box;
    const double right = box.right(), step = box.height / kSteps;
    for (int k = 0; k < kSteps; ++k) {  // each reaches under the next
      const double y = box.bottom + k * step, height = std::min(box.top() - y, 1.5 * step);
      canvas_.fill_path(Area{box.left, y, box.width, height}.corners(),
                        {heat_colour((k + 0.5) / kSteps, colours_of(*chart_.map))});
    }
    for (const Scale::Tic& tic : layout_.colours.tics) {
      const double y = box.bottom + layout_.colours.part(tic.at) * box.height;
      line({right, y}, {right + 0.6, y});
      canvas_.write({tic.text, {right + kTicGap, y}});
    }
  }
  const Chart& chart_;
  const PictureLayout& layout_;
  Canvas& canvas_;
};

}  // namespace

void draw_chart(const Chart& chart, const PictureLayout& layout, Canvas& canvas) {
  Drawing(chart, layout, canvas).draw();
}

}  // namespace tribofit
