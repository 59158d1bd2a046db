#include "plateau.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tribofit::kinematics {
namespace {

constexpr std::size_t most_blocks = std::size_t{1} << 17;
constexpr double band = 0.12;      // of the largest excursion: what still counts as near the level
constexpr double flatness = 0.10;  // of the band: how far the middle of a rest may stand out from its shoulders
constexpr std::size_t least_blocks = 4;

// Evenly spaced subset, so that sorting costs the same for any length of record.
std::vector<double> thinned(std::span<const double> values, std::size_t most) {
  const std::size_t stride = std::max<std::size_t>(1, values.size() / most);
  std::vector<double> subset;
  subset.reserve(values.size() / stride + 1);
  for (std::size_t i = 0; i < values.size(); i += stride) subset.push_back(values[i]);
  return subset;
}

// Half-sample mode (Robertson and Cryer 1974; Bickel 2002): halve to the densest half until few remain.
double half_sample_mode(std::span<const double> sorted) {
  while (sorted.size() > 3) {
    const std::size_t half = (sorted.size() + 1) / 2;
    std::size_t best = 0;
    double width = sorted[half - 1] - sorted[0];
    for (std::size_t i = 1; i + half <= sorted.size(); ++i) {
      const double w = sorted[i + half - 1] - sorted[i];
      if (w < width) width = w, best = i;
    }
    // Of many identical values (quantised or noise-free data) all must stay, or the walk to the end would drift.
    if (width == 0) return sorted[best];
    sorted = sorted.subspan(best, half);
  }
  return std::accumulate(sorted.begin(), sorted.end(), 0.0) / static_cast<double>(sorted.size());
}

double mean_of(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// A rest is flat when its middle does not stand out from its shoulders.
bool is_flat(std::span<const double> run, double half_band) {
  const std::size_t n = run.size(), eighth = std::max<std::size_t>(1, n / 8);
  if (n < least_blocks) return false;
  const auto middle = run.subspan(n / 2 - std::min(n / 2, eighth), 2 * eighth);
  const auto left = run.subspan(eighth / 2, 2 * eighth);
  const auto right = run.subspan(n - eighth / 2 - 2 * eighth, 2 * eighth);
  return std::abs(mean_of(middle) - 0.5 * (mean_of(left) + mean_of(right))) < flatness * half_band * 2;
}

double weighted_level(const std::vector<StickPlateau>& runs) {
  std::vector<const StickPlateau*> order;
  std::size_t total = 0;
  for (const StickPlateau& run : runs) order.push_back(&run), total += run.size();
  std::sort(order.begin(), order.end(),
            [](const StickPlateau* a, const StickPlateau* b) { return a->level < b->level; });
  std::size_t sum = 0;
  for (const StickPlateau* run : order) {
    sum += run->size();
    if (2 * sum >= total) return run->level;
  }
  return 0;
}

}  // namespace

std::size_t block_length(std::span<const double> signal) {
  const std::size_t n = signal.size();
  const std::size_t least = std::max<std::size_t>(1, (n + most_blocks - 1) / most_blocks);
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

Rests find_rests(std::span<const double> velocity, std::optional<LevelRange> range) {
  Rests rests;
  if (velocity.size() < least_blocks) return rests;
  std::vector<double> sorted = thinned(velocity, std::size_t{1} << 15);
  std::sort(sorted.begin(), sorted.end());
  std::span<const double> candidates = sorted;
  if (range) {
    const auto first = std::lower_bound(sorted.begin(), sorted.end(), range->low);
    const auto last = std::upper_bound(first, sorted.end(), range->high);
    candidates =
        candidates.subspan(static_cast<std::size_t>(first - sorted.begin()), static_cast<std::size_t>(last - first));
  }
  if (candidates.size() < least_blocks) return rests;
  const double mode = half_sample_mode(candidates);
  const std::size_t tail = sorted.size() / 1000;
  rests.depth = std::max(sorted[sorted.size() - 1 - tail] - mode, mode - sorted[tail]);
  const double half_band = band * rests.depth;
  for (std::size_t i = 0; i < velocity.size();) {
    if (std::abs(velocity[i] - mode) > half_band) {
      ++i;
      continue;
    }
    StickPlateau run{i, i, 0};
    while (i < velocity.size() && std::abs(velocity[i] - mode) <= half_band) ++i;
    run.end = i;
    if (!is_flat(velocity.subspan(run.begin, run.size()), half_band)) continue;
    run.level = mean_of(velocity.subspan(run.inner_begin(), run.inner_end() - run.inner_begin()));
    rests.runs.push_back(run);
  }
  rests.level = weighted_level(rests.runs);
  return rests;
}

Line fit_line(std::span<const double> samples) {
  const double n = static_cast<double>(samples.size());
  if (samples.empty()) return {};
  const double centre = 0.5 * (n - 1);
  double sum = 0, moment = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sum += samples[i];
    moment += (static_cast<double>(i) - centre) * samples[i];
  }
  return {sum / n, n > 1 ? moment * 12 / (n * (n * n - 1)) : 0};
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

std::vector<double> spreads_about_parabolas(std::span<const double> signal, const std::vector<StickPlateau>& stretches,
                                            std::size_t factor) {
  constexpr std::size_t most_stretches = 256, parts = 4, least_samples = 8;
  std::vector<double> spreads;
  const std::size_t stride = std::max<std::size_t>(1, stretches.size() / most_stretches);
  for (std::size_t r = 0; r < stretches.size(); r += stride) {
    const std::size_t begin = stretches[r].inner_begin() * factor;
    const std::size_t end = std::min(signal.size(), stretches[r].inner_end() * factor);
    if (end < begin + least_samples) continue;
    const std::size_t length = std::max(least_samples, std::min<std::size_t>((end - begin) / parts, 4096));
    for (std::size_t i = begin; i + length <= end; i += std::max(length, (end - begin) / parts)) {
      // Orthogonal polynomials on equally spaced points: constant, line, parabola.
      const double n = static_cast<double>(length), centre = 0.5 * (n - 1), shift = (n * n - 1) / 12;
      double s0 = 0, s1 = 0, s2 = 0, squares = 0, norm2 = 0;
      const double origin = signal[i];  // keeps the squares small beside a large mean
      for (std::size_t k = 0; k < length; ++k) {
        const double x = static_cast<double>(k) - centre, p2 = x * x - shift, y = signal[i + k] - origin;
        s0 += y, s1 += x * y, s2 += p2 * y, squares += y * y, norm2 += p2 * p2;
      }
      const double rest = squares - s0 * s0 / n - s1 * s1 * 12 / (n * (n * n - 1)) - s2 * s2 / norm2;
      spreads.push_back(std::sqrt(std::max(0.0, rest) / (n - 3)));
    }
  }
  return spreads;
}

double spread_about_parabolas(std::span<const double> signal, const std::vector<StickPlateau>& stretches,
                              std::size_t factor) {
  return median(spreads_about_parabolas(signal, stretches, factor));
}

}  // namespace tribofit::kinematics
