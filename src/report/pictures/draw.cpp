#include "report/pictures/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/geometry/algorithms/simplify.hpp>
#include <boost/geometry/geometries/register/linestring.hpp>
#include <boost/geometry/geometries/register/point.hpp>
#include <boost/geometry/strategies/strategies.hpp>
#include <cmath>
#include <set>

BOOST_GEOMETRY_REGISTER_POINT_2D(tribofit::Point, double, boost::geometry::cs::cartesian, x, y)
BOOST_GEOMETRY_REGISTER_LINESTRING(tribofit::Path)

namespace tribofit {

namespace {

constexpr Paint kGrid = {kGridColour}, kMark = {kAxisColour};
constexpr Point kGap = {kFromData, kFromData};

bool finite(const Point& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

/// A panel with its scales.
struct Panel {
  std::size_t number;
  const Scale &x, &y;
  const Area& area;

  double across(double value) const { return area.left + x.part(value) * area.width; }
  double up(double value) const { return area.bottom + y.part(value) * area.height; }
  Point at(double x_value, double y_value) const { return {across(x_value), up(y_value)}; }
  bool has(const ChartLine& line) const { return line.shown && line.panel == number; }
};

/// The points of a line that has these values, NaN where it has none.
Path points_of(const Panel& panel, const ChartLine& line, const std::vector<double>& values) {
  Path points;
  for (std::size_t k = 0; k < std::min(line.x.size(), values.size()); ++k)
    points.push_back(panel.at(line.x[k], values[k]));
  return points;
}

/// Runs of finite points, without those that paper does not show (Douglas and Peucker 1973): no peak is lost.
std::vector<Path> thinned_runs(const Path& points) {
  std::vector<Path> runs;
  for (auto begin = points.begin(), end = begin; begin != points.end(); begin = end) {
    begin = std::find_if(begin, points.end(), finite);
    end = std::find_if_not(begin, points.end(), finite);
    if (begin != end) boost::geometry::simplify(Path(begin, end), runs.emplace_back(), sizes.tolerance);
  }
  return runs;
}

/// Of points that are not joined the first within each square of paper.
Path thinned_points(const Path& points) {
  std::set<std::pair<double, double>> taken;
  Path out;
  for (const Point& p : points) {
    const double cell = sizes.symbol_cell;
    if (taken.emplace(std::floor(p.x / cell), std::floor(p.y / cell)).second) out.push_back(p);
  }
  return out;
}

/// Colour of a part of the map's range, 0 to 1, in steps; none where there is no value.
std::string heat_colour(double part, std::span<const std::string_view> scale) {
  if (!std::isfinite(part)) return "";
  const double step = std::min(std::floor(std::clamp(part, 0.0, 1.0) * sizes.colour_steps), sizes.colour_steps - 1.0);
  const double at = (step + 0.5) / sizes.colour_steps * static_cast<double>(scale.size() - 1), below = std::floor(at);
  std::string out = "#";
  for (std::size_t k = 0; k < 3; ++k) {
    const int from = channel_of(scale[static_cast<std::size_t>(below)], k);
    const int to = channel_of(scale[static_cast<std::size_t>(below) + 1], k);
    out += fmt::format("{:02x}", std::lround(from + (at - below) * (to - from)));
  }
  return out;
}

Pen pen_of(const Stroke& stroke) {
  Pen pen{ink(stroke.colour), std::clamp(sizes.pixel_points * stroke.width, 0.5, 1.2)};
  for (const double pixels : style_of(stroke.dash, kDashes).lengths) {
    if (pixels > 0) pen.dashes.push_back(sizes.pixel_points * pixels);
  }
  return pen;
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart)
      : chart_(chart), layout_(layout_of(chart)), sheet_(sizes.width, layout_.height, one_line(chart.title)) {}

  std::string drawn() {
    for (std::size_t k = 0; k < layout_.panels.size(); ++k) {
      const Panel panel{k, layout_.x, layout_.y[k], layout_.panels[k]};
      draw_ground(panel);
      if (k == 0 && chart_.map) draw_map(panel, *chart_.map);
      for (const ChartLine& line : chart_.lines) {
        if (panel.has(line)) draw_line(panel, line);
      }
      draw_axes(panel);
      draw_marks(panel);
      if (k == 0) draw_words(panel);
    }
    draw_title_of_abscissa();
    for (const Key& key : layout_.keys) draw_key(key);
    if (chart_.map) draw_colour_box();
    return sheet_.finish();
  }

 private:
  /// Shaded stretches and the grid.
  void draw_ground(const Panel& p) {
    const double bottom = p.area.bottom, top = p.area.top(), left = p.area.left, right = p.area.right();
    for (const Stretch& stretch : chart_.stretches) {
      const double from = std::clamp(p.across(stretch.from), left, right);
      const double to = std::clamp(p.across(stretch.to), left, right);
      if (!(std::abs(to - from) > 0)) continue;  // elsewhere, or nowhere on a logarithmic axis
      sheet_.fill(Area{from, bottom, to - from, p.area.height}, style_of(stretch.shade, kShades).paint);
    }
    std::vector<Path> grid;
    for (const Scale::Tic& tic : p.x.tics) grid.push_back({{p.across(tic.at), bottom}, {p.across(tic.at), top}});
    for (const Scale::Tic& tic : p.y.tics) grid.push_back({{left, p.up(tic.at)}, {right, p.up(tic.at)}});
    sheet_.stroke(grid, {kGrid, 0.35});
  }

  /// Cells of one row that have the same colour are one box.
  void draw_map(const Panel& p, const HeatMap& map) {
    const std::vector<double> x = cell_edges(map.x), y = cell_edges(map.y);
    sheet_.begin_plot(p.area);
    for (std::size_t r = 0; r + 1 < y.size() && r < map.z.size(); ++r) {
      std::vector<std::string> row;
      for (std::size_t c = 0; c < std::min(map.z[r].size(), map.x.size()); ++c)
        row.push_back(heat_colour(layout_.colours.part(map.z[r][c]), colours_of(map)));
      for (std::size_t c = 0, end = 0; c < row.size(); c = end) {
        while (end < row.size() && row[end] == row[c]) ++end;
        const Point low = p.at(x[c], y[r]), high = p.at(x[end], y[r + 1]);
        if (!row[c].empty()) sheet_.tile({low.x, low.y, high.x - low.x, high.y - low.y}, row[c]);
      }
    }
    sheet_.end_plot();
  }

  /// A line with its band, symbols and bars of errors.
  void draw_line(const Panel& p, const ChartLine& line) {
    const Path points = points_of(p, line, line.y);
    sheet_.begin_plot(p.area);
    if (!line.bars && !line.low.empty()) draw_band(p, line);
    if (!line.y.empty() && line.stroke.joined) sheet_.stroke(thinned_runs(points), pen_of(line.stroke));
    if (!line.y.empty() && line.bars) draw_error_bars(p, line);
    sheet_.end_plot();
    if (line.y.empty() || !line.stroke.has_symbols()) return;
    Path inside, kept;
    for (const Point& one : points) {
      if (p.area.holds(one)) inside.push_back(one);
    }
    const Path apart = thinned_points(inside);
    const std::size_t every = line.stroke.joined ? 1 + apart.size() / kMostSymbols : 1;
    for (std::size_t k = 0; k < apart.size(); k += every) kept.push_back(apart[k]);
    draw_symbols(kept, line.stroke);
  }

  void draw_symbols(const Path& at, const Stroke& stroke) {
    const double points = std::clamp(1.25 * sizes.pixel_points * stroke.size, 2.0, 5.5);
    sheet_.symbols(at, stroke.symbol, points / 2 * kMillimetresPerPoint, stroke.colour);
  }

  void draw_band(const Panel& p, const ChartLine& line) {
    Path low = points_of(p, line, line.low), high = points_of(p, line, line.high);
    for (std::size_t k = 0; k < low.size(); ++k) {
      if (!finite(low[k]) || !finite(high[k])) low[k] = high[k] = kGap;
    }
    std::vector<Path> bands = thinned_runs(low);
    const std::vector<Path> highs = thinned_runs(high);
    for (std::size_t k = 0; k < bands.size(); ++k) bands[k].insert(bands[k].end(), highs[k].rbegin(), highs[k].rend());
    sheet_.fill(bands, pale(line.stroke.colour));
  }

  void draw_error_bars(const Panel& p, const ChartLine& line) {
    const Path lows = points_of(p, line, line.low), highs = points_of(p, line, line.high);
    std::vector<Path> bars;
    for (std::size_t k = 0; k < lows.size(); ++k) {
      if (!finite(lows[k]) || !finite(highs[k]) || !(highs[k].y > lows[k].y)) continue;
      bars.push_back({lows[k], highs[k]});
      for (const Point& end : {lows[k], highs[k]})
        bars.push_back({{end.x - sizes.half_cap, end.y}, {end.x + sizes.half_cap, end.y}});
    }
    sheet_.stroke(bars, {ink(line.stroke.colour), 0.5});
  }

  /// With their numbers or names, and the title of the ordinate.
  void draw_axes(const Panel& p) {
    const double left = p.area.left, bottom = p.area.bottom;
    std::vector<Path> lines = {{{left, p.area.top()}, {left, bottom}, {p.area.right(), bottom}}};
    const bool lowest = p.number + 1 == layout_.panels.size(), upright = layout_.upright_names;
    for (const Scale::Tic& tic : p.x.tics) {
      const double x = p.across(tic.at), y = bottom - sizes.tic_gap - (upright ? 0 : sizes.text_line / 2);
      if (!p.x.named) lines.push_back({{x, bottom}, {x, bottom - sizes.tic}});
      if (!lowest) continue;
      sheet_.write({.text = tic.text,
                    .at = {x, y},
                    .anchor = upright ? Anchor::right : Anchor::centre,
                    .upright = upright,
                    .markup = !p.x.named});
    }
    for (const Scale::Tic& tic : p.y.tics) {
      const double y = p.up(tic.at);
      if (!p.y.named) lines.push_back({{left, y}, {left - sizes.tic, y}});
      sheet_.write({.text = tic.text, .at = {left - sizes.tic_gap, y}, .anchor = Anchor::right, .markup = !p.y.named});
    }
    sheet_.stroke(lines, {});
    double x = layout_.title_x;
    for (const std::string& title : layout_.titles[p.number]) {
      write_upright(title, {x, bottom + p.area.height / 2});
      x += sizes.text_line;
    }
  }

  void write_upright(const std::string& title, const Point& at) {
    sheet_.write({.text = title, .at = at, .anchor = Anchor::centre, .upright = true});
  }

  void write_beside(const std::string& text, const Point& at) {
    sheet_.write({.text = text, .at = at, .points = sizes.small_text, .halo = true});
  }

  /// Points of the lines of a panel within an area.
  std::ptrdiff_t points_in(const Area& area, const Panel& p) const {
    std::ptrdiff_t count = 0;
    for (const ChartLine& line : chart_.lines) {
      if (!p.has(line)) continue;
      count += std::ranges::count_if(points_of(p, line, line.y), [&](const Point& one) { return area.holds(one); });
    }
    return count;
  }

  /// The words of level marks stand above them, at the end where they hide less.
  void draw_marks(const Panel& p) {
    constexpr double kHalf = 1.6, kReach = 1;  // half a line of text, half a large symbol
    const double left = p.area.left, right = p.area.right(), bottom = p.area.bottom, top = p.area.top();
    for (const ChartMark& mark : chart_.marks) {
      const Pen pen{kMark, 0.6, pen_of({.dash = mark.dash}).dashes};
      const double part = mark.upright ? p.x.part(mark.at) : p.y.part(mark.at);
      if (!(part >= 0 && part <= 1) || (!mark.upright && mark.panel != p.number)) continue;
      if (mark.upright) {
        sheet_.stroke({{p.across(mark.at), bottom}, {p.across(mark.at), top}}, pen);
        continue;
      }
      const double y = p.up(mark.at);
      sheet_.stroke({{left, y}, {right, y}}, pen);
      if (mark.text.empty()) continue;
      const double width = width_of(mark.text, sizes.small_text);
      const double low = top - y < sizes.mark_line ? y - 2 * kHalf : y;
      const double first = left + sizes.beside_mark, last = right - sizes.beside_mark - width;
      const auto hidden = [&](double from) {
        return points_in({from - kReach, low - kReach, width + 2 * kReach, 2 * (kHalf + kReach)}, p);
      };
      write_beside(mark.text, {hidden(first) > hidden(last) ? last : first, low + kHalf});
    }
  }

  /// Those at upright marks in the first panel.
  void draw_words(const Panel& p) {
    for (const UprightWords& words : layout_.upright_words) {
      const double y = p.area.top() - sizes.mark_line * (static_cast<double>(words.row) + 0.5);
      write_beside(words.mark->text, {p.area.left + words.from, y});
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
    if (key.band != nullptr) sheet_.fill(box, pale(key.band->stroke.colour));
    if (key.line != nullptr) {
      const Stroke& stroke = key.line->stroke;
      if (stroke.joined) sheet_.stroke({{box.left, key.y}, {box.right(), key.y}}, pen_of(stroke));
      if (stroke.has_symbols()) draw_symbols({{box.left + box.width / 2, key.y}}, stroke);
    }
    sheet_.write({.text = key.name, .at = {box.right() + sizes.key_gap, key.y}, .markup = false});
  }

  void draw_colour_box() {
    const Area& box = layout_.colour_box;
    const double right = box.right(), step = box.height / sizes.colour_steps;
    sheet_.begin_plot(box);
    for (int k = 0; k < sizes.colour_steps; ++k) {
      const std::string colour = heat_colour((k + 0.5) / sizes.colour_steps, colours_of(*chart_.map));
      sheet_.tile({box.left, box.bottom + k * step, box.width, step}, colour);
    }
    sheet_.end_plot();
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
