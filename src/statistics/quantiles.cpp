#include "tribofit/statistics/quantiles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace tribofit {
namespace {

/// Where a quantile lies: after which order statistic, and how far towards the next.
struct Place {
  std::size_t below = 0;
  double part = 0;
};

Place place_of(std::size_t count, double fraction) {
  const double at = fraction * static_cast<double>(count - 1);
  const auto below = std::min(static_cast<std::size_t>(at), count - 1);
  return {below, at - static_cast<double>(below)};
}

double between(double below, double above, double part) {
  return (1 - part) * below + part * above;
}

}  // namespace

double quantile(std::vector<double> values, double fraction) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Place place = place_of(values.size(), fraction);
  const auto below = values.begin() + static_cast<std::ptrdiff_t>(place.below);
  std::nth_element(values.begin(), below, values.end());
  if (!(place.part > 0)) return *below;
  return between(*below, *std::min_element(below + 1, values.end()), place.part);
}

double quantile_of_sorted(std::span<const double> sorted, double fraction) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const Place place = place_of(sorted.size(), fraction);
  if (!(place.part > 0)) return sorted[place.below];
  return between(sorted[place.below], sorted[place.below + 1], place.part);
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
