#pragma once

#include <cmath>

namespace tribofit {

/// Where a function of one variable is least, and how much it is there.
struct Minimum {
  double at = 0, value = 0;
};

/// The minimum of `cost` between `low` and `high` by golden section, where it has one minimum there: known to
/// 0.618^steps of that interval after `steps` + 2 evaluations.
template <class Cost>
Minimum golden_section(const Cost& cost, double low, double high, int steps) {
  const double ratio = (std::sqrt(5.0) - 1) / 2;
  double left = high - ratio * (high - low), right = low + ratio * (high - low);
  double left_cost = cost(left), right_cost = cost(right);
  for (int step = 0; step < steps; ++step) {
    if (left_cost < right_cost) {
      high = right;
      right = left;
      right_cost = left_cost;
      left = high - ratio * (high - low);
      left_cost = cost(left);
    } else {
      low = left;
      left = right;
      left_cost = right_cost;
      right = low + ratio * (high - low);
      right_cost = cost(right);
    }
  }
  return {(low + high) / 2, left_cost < right_cost ? left_cost : right_cost};
}

}  // namespace tribofit
