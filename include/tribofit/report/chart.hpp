#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tribofit {

/// A picture as data: what it shows, in the units people read, and what distinguishes its parts. It is drawn by the
/// page (page/chart.js, with Plotly) and by write_pictures(), from the same numbers and the same styles.
///
/// Texts may hold subscripts and superscripts as "v_{r}" and "s^{2}"; names of lines, categories and files are taken as
/// they are. Colours are those of Okabe and Ito, distinguishable for people who do not see colours alike; as a colour
/// alone never carries a meaning, each line has a dash or a symbol of its own as well.

enum class Colour { black, blue, red, green, purple, grey };
enum class Dash { solid, dashed, dotted, dash_dotted, long_dashed };
enum class Symbol { none, circle, square, diamond, triangle_up, triangle_down, cross };

struct Stroke {
  Colour colour = Colour::black;
  Dash dash = Dash::solid;
  Symbol symbol = Symbol::none;
  double width = 1.6;  ///< [CSS pixels]
  double size = 6;     ///< of the symbol [CSS pixels]
  bool joined = true;  ///< false: symbols only

  bool has_symbols() const { return symbol != Symbol::none || !joined; }
};

inline constexpr double kFromData = std::numeric_limits<double>::quiet_NaN();

struct ChartAxis {
  std::string quantity = {};                 ///< "time"
  std::string unit = {};                     ///< "s"; "1" for a pure number; empty: none is shown
  double low = kFromData, high = kFromData;  ///< shown range
  bool from_zero = false;
  bool logarithmic = false;
  std::vector<std::string> names = {};  ///< of the values 0, 1, 2 ... where the axis counts things
  double part = 1;                      ///< height of a panel without names, in 150 pixels of the page
};

/// A line or points; with `low` and `high` also what is uncertain about it.
struct ChartLine {
  std::string name = {};               ///< in the legend, which names and switches all of one name together
  std::vector<double> x = {}, y = {};  ///< NaN: a gap. y may be empty where there is a band only
  Stroke stroke = {};
  std::vector<double> low = {}, high = {};  ///< of each y: a band, or bars where `bars`
  bool bars = false;
  bool shown = true;  ///< false: switched off until the legend is used, and left out of pictures
  std::size_t panel = 0;

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
  /// With its error to either side as a bar; one that is not known has no length.
  void add(double at, double value, double error) {
    add(at, value);
    bars = true;
    low.push_back(error > 0 ? value - error : value);
    high.push_back(error > 0 ? value + error : value);
  }
};

/// A stretch of the abscissa that is shaded over all panels.
enum class Shade { stick, slip, beyond, left_out, range };
struct Stretch {
  double from = 0, to = 0;
  Shade shade = Shade::stick;
};

/// A straight line across a panel (upright: over all of them) with a word beside it.
struct ChartMark {
  double at = 0;
  bool upright = false;
  Dash dash = Dash::dashed;
  std::string text = {};
  std::size_t panel = 0;
};

/// A quantity over two others on axes that are not logarithmic, in colours that rise in lightness as well, or that
/// diverge from zero.
struct HeatMap {
  std::vector<double> x = {}, y = {};       ///< of the columns, of the rows
  std::vector<std::vector<double>> z = {};  ///< rows; NaN: nothing there
  std::string quantity = {}, unit = {};
  double low = kFromData, high = kFromData;
  /// It has both signs: pale at zero, the middle of the scale. Others have lines of equal value on the page.
  bool diverging = false;
};

struct Chart {
  std::string id = {};  ///< name of its file and anchor; letters, digits and '-'
  std::string title = {};
  std::string note = {};  ///< what to look at, a sentence or two
  ChartAxis x = {};
  std::vector<ChartAxis> panels = std::vector<ChartAxis>(1);  ///< ordinates, from top to bottom
  std::vector<ChartLine> lines = {};
  std::optional<HeatMap> map = {};  ///< under the lines
  std::vector<Stretch> stretches = {};
  std::vector<ChartMark> marks = {};
  bool half = false;  ///< stands beside its neighbour where the page is wide

  /// What panels and names take on the page [CSS pixels].
  int height() const {
    double sum = x.names.empty() ? 140 : 240;
    for (const ChartAxis& panel : panels) {
      const auto names = static_cast<double>(panel.names.size());
      sum += names > 0 ? 26 * std::max(4.0, names) : 150 * panel.part;
    }
    return static_cast<int>(sum);
  }

  /// A line without points yet; a report leaves out lines that get none.
  ChartLine& line(std::string name, const Stroke& stroke, std::size_t panel = 0) {
    return lines.emplace_back(ChartLine{.name = std::move(name), .stroke = stroke, .panel = panel});
  }
};

}  // namespace tribofit
