#pragma once

#include <array>
#include <functional>
#include <vector>

namespace tribofit {

/// Mean friction over speed, as the data show it before any law is fitted: what laws are started from. SI.
struct FrictionCurve {
  struct Bin {
    double speed = 0;     ///< mean |v_r| [m/s]
    double friction = 0;  ///< mean |friction| [1 or N]
    double weight = 0;
  };
  std::vector<Bin> bins;
  double break_away = 0;  ///< mean friction at break-away; NaN where nothing broke away
  double fastest = 0;     ///< the data reach up to this |v_r| [m/s]

  /// friction = constant + slope basis(speed) by least squares; a constant is not below zero.
  struct Line {
    double constant = 0, slope = 0;
    double cost = 0;  ///< weighted sum of squares
  };
  Line line_over(const std::function<double(double speed)>& basis) const;

  /// friction = at_high_speed + (at_rest - at_high_speed) shape(steepness v), by least squares.
  struct Fall {
    double at_rest = 0, at_high_speed = 0;
    double steepness = 0;  ///< [s/m]
  };
  /// The best steepness of a grid over what the data can resolve.
  Fall best_fall(const std::function<double(double x)>& shape) const;

  /// Steepness of a law [s/m] between which it is neither a constant nor a straight line over speeds up to `fastest`.
  static std::array<double, 2> resolved_steepness(double fastest);
};

}  // namespace tribofit
