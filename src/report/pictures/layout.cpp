#include "report/pictures/picture.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace tribofit {
namespace {

/// Whether anything is drawn at the k-th point of a line.
bool is_drawn(const ChartLine& line, std::size_t k) {
  const auto known = [&](const std::vector<double>& values) { return k < values.size() && std::isfinite(values[k]); };
  return known(line.y) || known(line.low);
}

Extent extent_of_abscissa(const Chart& chart) {
  Extent extent(chart.x.logarithmic);
  for (const ChartLine& line : chart.lines) {
    for (std::size_t k = 0; line.shown && k < line.x.size(); ++k) {
      if (is_drawn(line, k)) extent.add(line.x[k]);
    }
  }
  if (chart.map) extent.add(cell_edges(chart.map->x));
  return extent;
}

Extent extent_of_panel(const Chart& chart, std::size_t panel, const Scale& x) {
  Extent extent(chart.panels[panel].logarithmic);
  for (const ChartLine& line : chart.lines) {
    for (std::size_t k = 0; line.shown && line.panel == panel && k < line.x.size(); ++k) {
      const double part = x.part(line.x[k]);
      if (!(part >= -1e-9 && part <= 1 + 1e-9)) continue;
      for (const auto* values : {&line.y, &line.low, &line.high}) {
        if (k < values->size()) extent.add((*values)[k]);
      }
    }
  }
  for (const ChartMark& mark : chart.marks) {
    if (!mark.upright && mark.panel == panel) extent.add(mark.at);
  }
  if (chart.map && panel == 0) extent.add(cell_edges(chart.map->y));
  return extent;
}

/// Points at the very edge would be cut in half; a line or a map may reach it.
double margin_of_abscissa(const Chart& chart) {
  const auto has_symbols = [](const ChartLine& line) { return line.shown && line.stroke.has_symbols(); };
  return std::ranges::any_of(chart.lines, has_symbols) ? 0.03 : 0;
}

std::vector<Key> keys_of(const Chart& chart) {
  std::vector<Key> keys;
  for (const ChartLine& line : chart.lines) {
    if (!line.shown) continue;
    auto at = std::ranges::find(keys, line.name, &Key::name);
    if (at == keys.end()) at = keys.insert(keys.end(), {.name = line.name});
    if (!line.low.empty() && !line.bars && at->band == nullptr) at->band = &line;
    if (!line.y.empty() && at->line == nullptr) at->line = &line;
  }
  if (keys.size() == 1) keys.clear();  // one alone needs no name
  std::set<Shade> shades;
  for (const Stretch& stretch : chart.stretches) {
    if (!shades.insert(stretch.shade).second) continue;
    keys.push_back({.name = std::string(style_of(stretch.shade, kShades).meaning), .stretch = &stretch});
  }
  return keys;
}

/// Sets the entries side by side, as many as go into a row. Returns the height they take.
double place(std::vector<Key>& keys) {
  double x = sizes.edge, depth = 0;
  for (Key& key : keys) {
    key.name = shortened(key.name, sizes.width - 2 * sizes.edge - sizes.key_sample - sizes.key_gap);
    const double width = sizes.key_sample + sizes.key_gap + width_of(key.name);
    if (x > sizes.edge && x + width > sizes.width - sizes.edge) {
      x = sizes.edge;
      depth += sizes.text_line;
    }
    key.x = x;
    key.y = depth;
    x += width + sizes.between_keys;
  }
  const double height = keys.empty() ? 0 : depth + sizes.text_line;
  for (Key& key : keys) key.y = sizes.edge + height - sizes.text_line / 2 - key.y;
  return height;
}

double widest(const Scale& scale) {
  double width = 0;
  for (const Scale::Tic& tic : scale.tics) width = std::max(width, width_of(tic.text));
  return width;
}

/// Names of things may not take more than a part of the picture.
void shorten_names(Scale& scale, double most) {
  if (!scale.named) return;
  for (Scale::Tic& tic : scale.tics) tic.text = shortened(tic.text, most);
}

/// A title that is longer than its axis goes on two lines, broken at the blank nearest to its middle.
TitleLines broken(const std::string& title, double length) {
  if (title.empty()) return {};
  const std::string line = one_line(title);
  if (width_of(line) <= length) return {line};
  constexpr std::size_t kNone = std::string::npos;
  const std::size_t before = line.rfind(' ', line.size() / 2), after = line.find(' ', line.size() / 2);
  const std::size_t at = before == kNone || (after != kNone && before + after < line.size()) ? after : before;
  if (at == kNone) return {line};
  return {line.substr(0, at), line.substr(at + 1)};
}

/// Heights of the panels: what is left of the chart's height beside axis and gaps, by their parts.
std::vector<double> heights_of(const Chart& chart) {
  const double gaps = sizes.between_panels * static_cast<double>(chart.panels.size() - 1);
  const double all = sizes.pixel * chart.height() - 2 * sizes.text_line - sizes.tic_gap - 2 * sizes.edge - gaps;
  double parts = 0;
  for (const ChartAxis& panel : chart.panels) parts += panel.part;
  std::vector<double> heights;
  for (const ChartAxis& panel : chart.panels) {
    heights.push_back(std::max(sizes.least_panel, parts > 0 ? all * panel.part / parts : 0));
  }
  return heights;
}

/// Margins left and right; sets where titles go.
void place_across(const Chart& chart, PictureLayout& layout, const std::vector<double>& heights) {
  double tics = 0;
  std::size_t lines = 0;
  layout.titles.clear();
  for (std::size_t k = 0; k < chart.panels.size(); ++k) {
    shorten_names(layout.y[k], sizes.name_part * sizes.width);
    tics = std::max(tics, widest(layout.y[k]));
    layout.titles.push_back(broken(layout.y[k].title, heights[k] + sizes.between_panels));
    lines = std::max(lines, layout.titles.back().size());
  }
  layout.title_x = sizes.edge + sizes.text_line / 2;
  const double left = sizes.edge + static_cast<double>(lines) * sizes.text_line + tics + sizes.tic_gap + 0.8;
  double right = sizes.width - sizes.edge - 1.5;
  if (chart.map) {
    const bool titled = !layout.colours.title.empty();
    layout.colour_title_x = sizes.width - sizes.edge - sizes.text_line / 2;
    layout.colour_box.width = sizes.colour_box;
    layout.colour_box.left = sizes.width - sizes.edge - (titled ? sizes.text_line + 0.6 : 0) - widest(layout.colours) -
                             sizes.tic_gap - sizes.colour_box;
    right = layout.colour_box.left - 2;
  }
  for (Area& area : layout.panels) {
    area.left = left;
    area.width = right - left;
  }
}

/// Words at upright marks stand in rows at the top, so that none lies upon another.
std::vector<UprightWords> place_upright_words(const Chart& chart, const Scale& x, double panel_width) {
  std::vector<UprightWords> words;
  for (const ChartMark& mark : chart.marks) {
    const double part = x.part(mark.at);
    if (mark.upright && !mark.text.empty() && part >= 0 && part <= 1) words.push_back({&mark, part * panel_width, 0});
  }
  std::sort(words.begin(), words.end(), [](const auto& a, const auto& b) { return a.from < b.from; });
  std::vector<double> taken;  // right ends of the words in each row
  double before = 0;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const double at = words[k].from, width = width_of(words[k].mark->text, sizes.small_text);
    // To the right where no other line stands in the way, else to the left where that is free.
    const double next = k + 1 < words.size() ? words[k + 1].from : panel_width;
    const double ends = at + sizes.beside_mark + width, begins = at - sizes.beside_mark - width;
    const double from = ends > panel_width || (ends > next && begins >= before) ? begins : at + sizes.beside_mark;
    std::size_t& row = words[k].row;
    while (row < taken.size() && taken[row] > from) ++row;
    if (row == taken.size()) taken.push_back(0);
    taken[row] = from + width + 1;
    words[k].from = from;
    before = at;
  }
  return words;
}

/// The first panel has room for the words at upright marks above its data.
ChartAxis with_room_for_words(const ChartAxis& axis, const Scale& scale, const PictureLayout& layout, double height) {
  constexpr double kMostRoom = 0.4;
  ChartAxis wider = axis;
  std::size_t rows = 0;
  for (const UprightWords& words : layout.upright_words) rows = std::max(rows, words.row + 1);
  if (rows == 0 || scale.named || std::isfinite(axis.high)) return wider;
  const double factor = 1 / (1 - std::min(kMostRoom, static_cast<double>(rows) * sizes.mark_line / height));
  const double top = scale.low + factor * (scale.high - scale.low);
  wider.high = scale.logarithmic ? std::pow(10, top) : top;
  return wider;
}

/// The last number of the abscissa may reach beyond the data.
void keep_last_tic_inside(PictureLayout& layout) {
  for (const Scale::Tic& tic : layout.x.tics) {
    const double at = layout.panels.front().left + layout.x.part(tic.at) * layout.panels.front().width;
    const double over = at + width_of(tic.text) / 2 - (sizes.width - 0.3);
    if (over <= 0 || layout.upright_names || layout.colour_box.width > 0) continue;
    for (Area& area : layout.panels) area.width -= over;
  }
}

/// Names of the abscissa stand on end where they would touch. Returns the height of its numbers or names.
double place_names(PictureLayout& layout) {
  if (!layout.x.named) return sizes.text_line;
  const double room = layout.panels.front().width / static_cast<double>(layout.x.tics.size());
  layout.upright_names = widest(layout.x) + 1.5 > room;
  if (!layout.upright_names) return sizes.text_line;
  shorten_names(layout.x, sizes.name);
  return widest(layout.x) + 0.5;
}

void place_upwards(PictureLayout& layout, const std::vector<double>& heights, double keys_height, double names_height) {
  double bottom = sizes.edge + keys_height + (keys_height > 0 ? 1 : 0);
  if (!layout.x.title.empty()) {
    layout.x_title_y = bottom + sizes.text_line / 2;
    bottom += sizes.text_line;
  }
  bottom += names_height + sizes.tic_gap;
  for (std::size_t k = heights.size(); k-- > 0;) {
    layout.panels[k].bottom = bottom;
    layout.panels[k].height = heights[k];
    bottom += heights[k] + sizes.between_panels;
  }
  layout.height = bottom - sizes.between_panels + sizes.edge + 1;
  layout.colour_box.bottom = layout.panels.back().bottom;
  layout.colour_box.height = layout.panels.front().top() - layout.colour_box.bottom;
}

}  // namespace

std::vector<double> cell_edges(const std::vector<double>& centres) {
  if (centres.empty()) return {};
  if (centres.size() == 1) return {centres[0] - 0.5, centres[0] + 0.5};
  std::vector<double> edges = {centres[0] - (centres[1] - centres[0]) / 2};
  for (std::size_t k = 1; k < centres.size(); ++k) edges.push_back((centres[k - 1] + centres[k]) / 2);
  edges.push_back(centres.back() + (centres.back() - centres[centres.size() - 2]) / 2);
  return edges;
}

PictureLayout layout_of(const Chart& chart) {
  PictureLayout layout;
  const std::vector<double> heights = heights_of(chart);
  layout.panels.resize(heights.size());
  const Extent across = extent_of_abscissa(chart);
  const double margin = margin_of_abscissa(chart);
  layout.x = scale_of(chart.x, across, margin, 5);
  const auto scale_up = [&](std::size_t k, const ChartAxis& axis) {
    const int most = std::max(3, static_cast<int>(heights[k] / 6));
    return scale_of(axis, extent_of_panel(chart, k, layout.x), chart.map ? 0 : 0.05, most);
  };
  for (std::size_t k = 0; k < heights.size(); ++k) layout.y.push_back(scale_up(k, chart.panels[k]));
  if (chart.map) {
    const HeatMap& map = *chart.map;
    Extent extent(false);
    for (const std::vector<double>& row : map.z) extent.add(row);
    layout.colours = scale_of({.quantity = map.quantity, .unit = map.unit, .low = map.low, .high = map.high}, extent, 0,
                              static_cast<int>(heights.front() / 8));
  }
  layout.keys = keys_of(chart);
  place_across(chart, layout, heights);
  const double width = layout.panels.front().width;
  const double of_tic = widest(scale_of(chart.x, across, 0, 5)) + 5;  // with room beside it
  layout.x = scale_of(chart.x, across, margin, std::max(2, static_cast<int>(width / of_tic)));
  const double names = place_names(layout);
  keep_last_tic_inside(layout);
  layout.upright_words = place_upright_words(chart, layout.x, layout.panels.front().width);
  if (!layout.upright_words.empty()) {
    layout.y[0] = scale_up(0, with_room_for_words(chart.panels[0], layout.y[0], layout, heights[0]));
    place_across(chart, layout, heights);
    keep_last_tic_inside(layout);
  }
  place_upwards(layout, heights, place(layout.keys), names);
  return layout;
}

}  // namespace tribofit
