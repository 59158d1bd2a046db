#include "tribofit/statistics/standard_error_of_mean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace tribofit {

namespace {

/// First-order autocorrelation of a centred series, corrected for its small-sample bias, within [0, 0.97].
double first_autocorrelation(const std::vector<double>& d) {
  const auto n = static_cast<double>(d.size());
  double zero = 0, one = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    zero += d[i] * d[i];
    if (i > 0) one += d[i] * d[i - 1];
  }
  if (zero <= 0) return 0;
  const double r = one / zero * n / (n - 1);
  return std::clamp(r + (1 + 3 * r) / n, 0.0, 0.97);
}

}  // namespace

MeanError standard_error_of_mean(std::span<const double> series) {
  const std::size_t n = series.size();
  if (n < 3) return {std::numeric_limits<double>::quiet_NaN(), 1};
  const auto count = static_cast<double>(n);
  const auto centre = [count](std::vector<double>& x) {
    double mean = 0;
    for (const double value : x) mean += value;
    mean /= count;
    for (double& value : x) value -= mean;
  };
  std::vector<double> d(series.begin(), series.end());
  centre(d);
  const double r = first_autocorrelation(d);
  std::vector<double> w(n);
  w[0] = d[0] * std::sqrt(1 - r * r);
  for (std::size_t i = 1; i < n; ++i) w[i] = d[i] - r * d[i - 1];
  centre(w);
  const int frequencies = std::max(2, static_cast<int>(std::lround(0.4 * std::pow(count, 2.0 / 3.0))));
  double sum = 0;
  for (int j = 1; j <= frequencies; ++j) {
    double projection = 0;
    for (std::size_t i = 0; i < n; ++i) {
      projection += w[i] * std::cos(std::numbers::pi * j * (static_cast<double>(i) + 0.5) / count);
    }
    sum += 2 / count * projection * projection;
  }
  const double long_run_variance = sum / frequencies / ((1 - r) * (1 - r));
  return {std::sqrt(long_run_variance / count), static_cast<double>(frequencies)};
}

Estimate mean_with_error(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (values.empty()) return {kUnknown, kUnknown};
  double sum = 0;
  for (const double value : values) sum += value;
  const MeanError error = standard_error_of_mean(values);
  return {sum / static_cast<double>(values.size()), error.std_error, error.degrees_of_freedom};
}

}  // namespace tribofit
