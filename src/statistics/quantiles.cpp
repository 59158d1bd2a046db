#include "tribofit/statistics/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tribofit {

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = fraction * static_cast<double>(values.size() - 1);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(at);
  std::nth_element(values.begin(), below, values.end());
  if (at > std::floor(at)) std::iter_swap(below + 1, std::min_element(below + 1, values.end()));
  return quantile_of_sorted(values, fraction);
}

double quantile_of_sorted(std::span<const double> sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double at = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const double part = at - std::floor(at);
  return part > 0 ? (1 - part) * sorted[below] + part * sorted[below + 1] : sorted[below];
}

double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

double median_absolute_deviation(std::span<const double> values, double centre) {
  std::vector<double> deviations(values.begin(), values.end());
  for (double& deviation : deviations) deviation = std::abs(deviation - centre);
  return median(std::move(deviations));
}

}  // namespace tribofit
