#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <vector>

namespace tribofit {

/// Series with fewer samples, as they are drawn: no peak is lost.

/// Indices of the samples to draw, in order: the first, the least, the largest and the last of each of `bins` stretches
/// of equal length (at a bin per column of pixels the line looks as if every sample were drawn: Jugel et al. 2014, M4).
/// A stretch with samples that are not finite keeps the first of them, so that gaps stay gaps. All samples where that
/// is no more. Cost: one pass.
std::vector<std::size_t> drawn_samples(std::span<const double> values, std::size_t bins);

/// A stretch of samples [begin, end) whose flags are equal.
struct FlagRun {
  std::size_t begin, end;
  bool set;
};
std::vector<FlagRun> runs_of(std::span<const std::uint8_t> flags);

/// Indices of the samples to draw of channels that belong together: the extremes of each in about `bins` stretches,
/// three quarters of which lie where the flags are not set (`calm` where they are: little happens there).
std::vector<std::size_t> drawn_samples(std::initializer_list<std::span<const double>> channels,
                                       std::span<const std::uint8_t> calm, std::size_t bins);

/// At most `most` of `count` things, evenly, the ends among them.
std::vector<std::size_t> thinned(std::size_t count, std::size_t most);

}  // namespace tribofit
