#include "measures.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit::segmentation {

Measure mean_over_cycles(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !(v == v); });
  const std::size_t n = values.size();
  if (n < 2) return {n == 1 ? values[0] : std::nan(""), std::nan("")};
  double sum = 0;
  for (double v : values) sum += v;
  const double count = static_cast<double>(n), mean = sum / count;
  const auto covariance = [&](std::size_t lag) {
    double c = 0;
    for (std::size_t i = lag; i < n; ++i) c += (values[i] - mean) * (values[i - lag] - mean);
    return c / count;
  };
  const double independent = covariance(0) * count / (count - 1);
  const auto lags = static_cast<std::size_t>(std::cbrt(count));
  double correlated = covariance(0);
  for (std::size_t lag = 1; lag <= lags && lag < n; ++lag) {
    correlated += 2 * (1 - static_cast<double>(lag) / static_cast<double>(lags + 1)) * covariance(lag);
  }
  return {mean, std::sqrt(std::max(independent, correlated) / count)};
}

Measure frequency_of(const std::vector<double>& periods) {
  std::vector<double> known;
  for (double p : periods) {
    if (p == p) known.push_back(p);
  }
  if (known.size() < 2) return {std::nan(""), std::nan("")};
  const auto median = [](std::vector<double> v) {
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
  };
  const double centre = median(known);
  std::vector<double> deviation;
  for (double p : known) deviation.push_back(std::abs(p - centre));
  const double limit = std::max(3 * 1.4826 * median(std::move(deviation)), 0.02 * centre);
  std::erase_if(known, [&](double p) { return std::abs(p - centre) > limit; });
  const Measure period = mean_over_cycles(std::move(known));
  return {1 / period.value, period.std_error / (period.value * period.value)};
}

}  // namespace tribofit::segmentation
