#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tribofit/report/chart.hpp"

namespace tribofit {

/// Where a value stands on an axis: its decimal logarithm on a logarithmic one, which has no place for what is not
/// positive (NaN).
inline double along(double value, bool logarithmic) {
  return !logarithmic ? value : value > 0 ? std::log10(value) : std::numeric_limits<double>::quiet_NaN();
}

/// An axis with everything decided: its range, where its tics are and what they say.
struct Scale {
  double low = 0, high = 1;  ///< along() the axis; low < high also where it falls
  bool logarithmic = false, falling = false, named = false;
  struct Tic {
    double at;
    std::string text;  ///< markup; of a named axis the name as it is
  };
  std::vector<Tic> tics;
  std::string title;  ///< markup: quantity and unit

  /// Part of the way along the axis, 0 to 1 from left to right or from bottom to top; NaN where it has none.
  double part(double value) const {
    const double rising = (along(value, logarithmic) - low) / (high - low);
    return falling ? 1 - rising : rising;
  }
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
};

/// The scale of an axis that shows this extent, with `margin` (a part of it) beside it where the data set the range,
/// and at most `most_tics` tics.
Scale scale_of(const ChartAxis& axis, const Extent& extent, double margin, int most_tics);

}  // namespace tribofit
