#include "measures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit::segmentation {

double branch_difference(std::span<const double> velocity, std::span<const double> friction, int direction) {
  constexpr std::size_t bins = 10;
  const auto speed = [&](std::size_t i) { return direction * velocity[i]; };
  std::size_t top = 0;
  for (std::size_t i = 1; i < velocity.size(); ++i) {
    if (speed(i) > speed(top)) top = i;
  }
  if (velocity.empty() || !(speed(top) > 0)) return std::nan("");
  struct Bin {
    double sum = 0, count = 0;
  };
  std::array<Bin, bins> up{}, down{};
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double place = (speed(i) / speed(top) - 0.25) / 0.5;  // 0 at a quarter of the peak, 1 at three quarters
    if (!(place >= 0 && place < 1)) continue;
    Bin& bin = (i < top ? up : down)[static_cast<std::size_t>(place * bins)];
    bin.sum += direction * friction[i];
    bin.count += 1;
  }
  double difference = 0, compared = 0;
  for (std::size_t k = 0; k < bins; ++k) {
    if (up[k].count == 0 || down[k].count == 0) continue;
    difference += up[k].sum / up[k].count - down[k].sum / down[k].count;
    compared += 1;
  }
  return compared > 0 ? difference / compared : std::nan("");
}

Estimate frequency_of(const std::vector<double>& periods) {
  std::vector<double> known;
  for (double p : periods) {
    if (p == p) known.push_back(p);
  }
  if (known.size() < 2) return {std::nan(""), std::nan("")};
  const double centre = median(known);
  const double limit = std::max(3 * kSigmaPerMad * median_absolute_deviation(known, centre), 0.02 * centre);
  std::erase_if(known, [&](double p) { return std::abs(p - centre) > limit; });
  const Estimate period = mean_with_error(std::move(known));
  return {1 / period.value, period.std_error / (period.value * period.value), period.degrees_of_freedom};
}

Estimate mean_over_slips(std::vector<double> values) {
  std::erase_if(values, [](double x) { return std::isnan(x); });
  const auto n = static_cast<double>(values.size());
  if (values.size() < 3 || values.size() >= kManySlips) return mean_with_error(std::move(values));
  double mean = 0, squares = 0;
  for (const double x : values) mean += x / n;
  for (const double x : values) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / (n * (n - 1))), n - 1};
}

}  // namespace tribofit::segmentation
