#include "resolution.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {

namespace {

/// Values that are further apart than `same`, in ascending order.
std::vector<double> levels_of(std::vector<double> values, double same) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a <= same; }),
               values.end());
  return values;
}

}  // namespace

double find_resolution(std::span<const double> channel) {
  const std::vector<double> values = thinned(channel, kValuesForSteps);
  if (values.size() < kFewestLevels) return 0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double same = 1e-9 * (*high - *low);  // two spellings of one level differ in the last digits
  // Where some of the values have too many levels, all have: most channels need no more to be sorted.
  if (levels_of(thinned(values, 2 * kMostLevels), same).size() > kMostLevels) return 0;
  const std::vector<double> levels = levels_of(values, same);
  if (levels.size() < kFewestLevels || levels.size() > kMostLevels) return 0;
  std::vector<double> steps;
  for (std::size_t i = 1; i < levels.size(); ++i) steps.push_back(levels[i] - levels[i - 1]);
  const double step = *std::min_element(steps.begin(), steps.end());
  const auto whole = std::count_if(steps.begin(), steps.end(),
                                   [&](double s) { return std::abs(s / step - std::round(s / step)) < kOffWholeStep; });
  return static_cast<double>(whole) >= kWholeSteps * static_cast<double>(steps.size()) ? step : 0;
}

bool repeats_unevenly(std::span<const double> channel) {
  const std::size_t n = std::min(channel.size(), kValuesForSteps);
  const std::span<const double> x = channel.subspan((channel.size() - n) / 2, n);
  std::vector<double> changes;
  std::size_t begun = 0;
  for (std::size_t i = 1; i < n; ++i) {
    if (x[i] != x[i - 1]) changes.push_back(std::abs(x[i] - x[i - 1]));
    begun += x[i] == x[i - 1] && (i == 1 || x[i - 1] != x[i - 2]) ? 1U : 0U;
  }
  if (static_cast<double>(begun) < kUnevenRepeats * static_cast<double>(n) || changes.size() < kFewestDistributed)
    return false;
  const double smallest = quantile(changes, 0.01);
  return median(std::move(changes)) > kFineChanges * smallest;
}

double rounding_of_level(double step, double spread) {
  if (!(step > 0)) return 0;
  const double uniform = step / std::sqrt(12.0);
  const double variance = std::max(0.0, spread * spread - uniform * uniform);
  return uniform * std::exp(-2 * std::numbers::pi * std::numbers::pi * variance / (step * step));
}

}  // namespace tribofit::kinematics
