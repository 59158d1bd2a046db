#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "report/pictures/svg.hpp"
#include "tribofit/report/chart.hpp"

namespace tribofit {

/// A chart as SVG.
std::string drawn(const Chart& chart);

// Axes: scale.cpp.

/// Where a value stands on an axis: its decimal logarithm on a logarithmic one, which has no place for what is not
/// positive (NaN).
inline double along(double value, bool logarithmic) {
  return !logarithmic ? value : value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

/// An axis with everything decided: its range, where its tics are and what they say.
struct Scale {
  double low = 0, high = 1;  ///< along() the axis
  bool logarithmic = false, named = false;
  struct Tic {
    double at;
    std::string text;  ///< markup; of a named axis the name as it is
  };
  std::vector<Tic> tics;
  std::string title;  ///< markup: quantity and unit

  /// Part of the way along the axis, 0 to 1 from left to right or from bottom to top; NaN where it has none.
  double part(double value) const { return (along(value, logarithmic) - low) / (high - low); }
};

/// Least and largest of what is added, along() an axis; what has no place on it is left out.
struct Extent {
  bool logarithmic;
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();

  explicit Extent(bool on_logarithmic_axis) : logarithmic(on_logarithmic_axis) {}
  void add(double value) {
    const double place = along(value, logarithmic);
    if (!std::isfinite(place)) return;
    low = std::min(low, place);
    high = std::max(high, place);
  }
  void add(const std::vector<double>& values) {
    for (const double value : values) add(value);
  }
};

/// The scale of an axis that shows this extent, with `margin` (a part of it) beside it where the data set the range,
/// and at most `most_tics` tics.
Scale scale_of(const ChartAxis& axis, const Extent& extent, double margin, int most_tics);

// Where everything of a picture lies: layout.cpp. Lengths in mm, from the lower left corner.

/// What an entry of the legend shows left of its name.
struct Key {
  std::string name = {};  ///< as it is
  const ChartLine *line = nullptr, *band = nullptr;
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
std::vector<double> cell_edges(const std::vector<double>& centres);

/// Decides the layout of a chart: ranges, tics, margins wide enough for the numbers and names, the legend in rows
/// below. `chart` must outlive it.
PictureLayout layout_of(const Chart& chart);

}  // namespace tribofit
