#include "reductions.hpp"

#include <algorithm>
#include <cmath>

namespace tribofit {

Extremes extremes(std::span<const double> x) {
  Extremes strands[4] = {{x[0], x[0]}, {x[0], x[0]}, {x[0], x[0]}, {x[0], x[0]}};  // they hide the latency
  std::size_t i = 0;
  for (const std::size_t whole = x.size() - x.size() % 4; i < whole; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) strands[k].take(x[i + k]);
  }
  for (; i < x.size(); ++i) strands[0].take(x[i]);
  for (const Extremes& strand : strands) strands[0].take(strand.low), strands[0].take(strand.high);
  return strands[0];
}

std::vector<double> thinned(std::span<const double> values, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, values.size() / most);
  std::vector<double> subset;
  subset.reserve(values.size() / stride + 1);
  for (std::size_t i = 0; i < values.size(); i += stride) subset.push_back(values[i]);
  return subset;
}

std::size_t block_length(std::span<const double> signal) {
  constexpr std::size_t kMostBlocks = std::size_t{1} << 17;
  const std::size_t n = signal.size();
  const std::size_t least = std::max<std::size_t>(1, (n + kMostBlocks - 1) / kMostBlocks);
  const std::size_t starts = std::min<std::size_t>(n, 8192);
  if (n < 64) return least;
  const std::vector<double> subset = thinned(signal, starts);
  const double mean = mean_of(subset);
  double variance = 0;
  for (double x : subset) variance += (x - mean) * (x - mean);
  variance /= static_cast<double>(subset.size());
  std::size_t lag = 1;
  for (; lag < n / 64; lag *= 2) {
    const std::size_t stride = std::max<std::size_t>(1, (n - lag) / starts);
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i + lag < n; i += stride, ++count) {
      const double d = signal[i + lag] - signal[i];
      sum += d * d;
    }
    if (sum >= 0.1 * variance * static_cast<double>(count)) break;
  }
  return std::max(least, lag / 8);
}

BlockMeans block_means(std::span<const double> signal, std::size_t length, double step) {
  BlockMeans blocks;
  blocks.length = std::max<std::size_t>(1, std::min(length, signal.size()));
  blocks.step = step * static_cast<double>(blocks.length);
  const std::size_t count = signal.empty() ? 0 : signal.size() / blocks.length;
  blocks.mean.resize(count);
  const double weight = 1 / static_cast<double>(blocks.length);
  for (std::size_t b = 0; b < count; ++b) {
    const double* x = signal.data() + b * blocks.length;
    double even = 0, odd = 0;  // two sums hide the latency of the addition
    std::size_t i = 0;
    for (; i + 1 < blocks.length; i += 2) even += x[i], odd += x[i + 1];
    if (i < blocks.length) even += x[i];
    blocks.mean[b] = (even + odd) * weight;
  }
  return blocks;
}

}  // namespace tribofit
