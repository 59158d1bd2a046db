#pragma once

#include <string>
#include <vector>

#include "tribofit/report/chart.hpp"

namespace tribofit {

/// An axis with everything decided: its range, where its tics are and what they say.
struct Scale {
  double low = 0, high = 1;  ///< low < high also where it falls
  bool logarithmic = false, falling = false, named = false;
  struct Tic {
    double at;
    std::string text;  ///< markup; of a named axis the name as it is
  };
  std::vector<Tic> tics;
  std::string title;  ///< markup: quantity and unit

  /// Part of the way along the axis, 0 to 1 from left to right or from bottom to top; NaN where it has none.
  double part(double value) const;
};

/// Least and largest of what is added; what is not finite, and on a logarithmic axis not positive, is left out.
class Extent {
 public:
  explicit Extent(bool logarithmic) : logarithmic_(logarithmic) {}
  void add(double value);
  bool empty() const { return !(low_ <= high_); }
  double low() const { return low_; }
  double high() const { return high_; }

 private:
  bool logarithmic_;
  double low_ = std::numeric_limits<double>::infinity(), high_ = -std::numeric_limits<double>::infinity();
};

/// The scale of an axis that shows this extent, with `margin` (a part of it) beside it where the data set the range,
/// and at most `most_tics` tics.
Scale scale_of(const ChartAxis& axis, const Extent& extent, double margin, int most_tics);

}  // namespace tribofit
