#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// Smallest and largest of some samples.
struct Extremes {
  double low = 0, high = 0;

  void take(double value) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
};

/// Extremes of a span that is not empty.
Extremes extremes(std::span<const double> x);

/// Sum of term(sample), in four strands.
template <typename Term>
double sum_of(std::span<const double> x, Term term) {
  double sum[4] = {0, 0, 0, 0};
  std::size_t i = 0;
  for (const std::size_t whole = x.size() - x.size() % 4; i < whole; i += 4) {
    for (std::size_t k = 0; k < 4; ++k) sum[k] += term(x[i + k]);
  }
  for (; i < x.size(); ++i) sum[0] += term(x[i]);
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

/// Mean of values; NaN where there are none.
inline double mean_of(std::span<const double> x) {
  return sum_of(x, [](double value) { return value; }) / static_cast<double>(x.size());
}

/// Standard deviation of values about their mean; NaN where there are fewer than two.
inline double standard_deviation(std::span<const double> x) {
  const double mean = mean_of(x), squares = sum_of(x, [mean](double value) { return (value - mean) * (value - mean); });
  return std::sqrt(squares / static_cast<double>(x.size() - std::min<std::size_t>(x.size(), 1)));
}

/// Evenly spaced subset of about `most` values at the most (up to twice as many), so that sorting costs the same for
/// any length of record.
std::vector<double> thinned(std::span<const double> values, std::size_t most);

/// Means over blocks of `length` samples; a last incomplete block is left out unless it is the only one.
struct BlockMeans {
  std::size_t length = 1;    ///< samples in a block
  double step = 0;           ///< duration of a block [s]
  std::vector<double> mean;  ///< in the signal's unit
};

/// Number of samples that can be averaged without losing the motion: an eighth of the time in which the signal
/// changes by a tenth of its variance, at least so many that 2^17 blocks are not exceeded.
std::size_t block_length(std::span<const double> signal);

BlockMeans block_means(std::span<const double> signal, std::size_t length, double step);

}  // namespace tribofit
