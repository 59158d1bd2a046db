#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/pictures/scale.hpp"
#include "report/pictures/svg.hpp"
#include "tribofit/report/chart.hpp"

namespace tribofit {

/// Where everything of a picture lies. Lengths in mm, from the lower left corner.

/// What an entry of the legend shows left of its name.
struct Key {
  std::string name = {};  ///< as it is
  const ChartLine *line = nullptr, *band = nullptr;
  const ChartBars* bars = nullptr;
  const Stretch* stretch = nullptr;
  double x = 0, y = 0;  ///< of the left end of its sample, half-way up
};

/// Words at an upright mark: where they begin, from the left edge of the panel, and in which row from the top.
struct UprightWords {
  const ChartMark* mark;
  double from;
  std::size_t row;
};

/// A title along an axis: one line, or two where it is too long.
using TitleLines = std::vector<std::string>;

struct PictureLayout {
  double height = 0;
  Scale x;
  std::vector<Scale> y;      ///< of each panel
  std::vector<Area> panels;  ///< their data
  std::vector<TitleLines> titles;
  double title_x = 0;  ///< middle of the first line of the titles of the panels
  double x_title_y = 0;
  bool upright_names = false;               ///< those of the abscissa stand on end
  std::vector<UprightWords> upright_words;  ///< in the first panel
  std::vector<Key> keys;
  Scale colours;  ///< of the map
  Area colour_box;
  double colour_title_x = 0;
};

/// Edges of the cells of a map about these centres, one more than there are.
std::vector<double> cell_edges(std::vector<double> centres, bool logarithmic);

/// Decides the layout of a chart: ranges, tics, margins wide enough for the numbers and names, the legend in rows
/// below. `chart` must outlive it.
PictureLayout layout_of(const Chart& chart);

}  // namespace tribofit
