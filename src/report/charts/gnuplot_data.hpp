#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "report/charts/layout.hpp"
#include "tribofit/report/chart.hpp"
#include "tribofit/report/pictures.hpp"

namespace tribofit {

/// What gnuplot plots in one panel: data in blocks of their own, then the elements that show them. Only numbers are in
/// it.
class PlotList {
 public:
  /// data: coordinates in the units of the axes; area: where they lie on paper.
  PlotList(const Scale& x, const Scale& y, const Area& area, PictureFormat format)
      : x_(x), y_(y), area_(area), format_(format) {}

  void add_map(const HeatMap& map, const Scale& colours);
  void add_line(const ChartLine& line);
  /// bars: all that lie beside the names of the vertical axis.
  void add_bars(const std::vector<ChartBars>& bars);

  /// Blocks and the plot command.
  std::string text() const;

 private:
  /// Begins a block; rows follow by row() and gap(), its end by element(), with what is said of it after its name.
  void begin();
  void row(std::initializer_list<double> values);
  void gap();
  void element(const std::string& how);

  struct Run {
    std::size_t begin, end;
  };
  template <class Drawable>
  std::vector<Run> runs(std::size_t count, Drawable drawable) const;
  double across(double x) const { return x_.part(x) * area_.width; }
  double upwards(double y) const { return y_.part(y) * area_.height; }
  void add_band(const ChartLine& line);
  void add_joined(const ChartLine& line);
  void add_symbols(const ChartLine& line);
  void add_error_bars(const ChartLine& line);
  void add_bar_set(const ChartBars& bars, double from, double thickness);
  void add_hatching(double from, double to, double low, double high);

  const Scale &x_, &y_;
  Area area_;
  PictureFormat format_;
  std::size_t blocks_ = 0;
  std::string data_, elements_;
};

}  // namespace tribofit
