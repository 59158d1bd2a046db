#include "tribofit/diagnosis/residual_map.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

ResidualMap residual_map(const Motion& motion, const Segmentation& segmentation, std::span<const double> prediction,
                         std::size_t most_rows, std::size_t columns) {
  constexpr double kUsual = 0.995;
  const std::vector<Cycle>& cycles = segmentation.cycles;
  const std::size_t rows = std::min(most_rows, cycles.size());
  ResidualMap map;
  map.mean.assign(rows, std::vector<double>(columns, 0.0));
  auto count = map.mean;
  for (std::size_t c = 0; c < cycles.size(); ++c) {
    const Cycle& cycle = cycles[c];
    if (!cycle.slip_complete || !segmentation.is_selected(cycle)) continue;
    const std::size_t row = c * rows / cycles.size();
    for (std::size_t i = cycle.slip.begin; i < std::min(cycle.slip.end, prediction.size()); ++i) {
      if (!std::isfinite(prediction[i])) continue;
      const std::size_t column = std::min(columns - 1, (i - cycle.slip.begin) * columns / cycle.slip.size());
      map.mean[row][column] += cycle.direction * (motion.friction[i] - prediction[i]);
      count[row][column] += 1;
    }
  }
  std::vector<double> sizes;
  for (std::size_t row = 0; row < rows; ++row) {
    map.first_cycle.push_back(static_cast<double>((row * cycles.size() + rows - 1) / rows));
    for (std::size_t k = 0; k < columns; ++k) {
      map.mean[row][k] /= count[row][k];
      if (std::isfinite(map.mean[row][k])) sizes.push_back(std::abs(map.mean[row][k]));
    }
  }
  for (std::size_t k = 0; k < columns; ++k) {
    map.phase.push_back((static_cast<double>(k) + 0.5) / static_cast<double>(columns));
  }
  if (!sizes.empty()) map.usual = quantile(std::move(sizes), kUsual);
  return map;
}

}  // namespace tribofit
