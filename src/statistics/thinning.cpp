#include "thinning.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <set>

namespace tribofit {
namespace {

/// Appends what is to be drawn of samples [begin, end).
void draw_stretch(std::span<const double> values, std::size_t begin, std::size_t end, std::vector<std::size_t>& drawn) {
  std::size_t least = end, largest = end, gap = end;
  for (std::size_t i = begin; i < end; ++i) {
    if (!std::isfinite(values[i])) {
      gap = std::min(gap, i);
      continue;
    }
    if (least == end || values[i] < values[least]) least = i;
    if (largest == end || values[i] > values[largest]) largest = i;
  }
  std::array<std::size_t, 5> kept = {begin, least, largest, gap, end - 1};
  std::sort(kept.begin(), kept.end());
  for (const std::size_t i : kept) {
    if (i != end && (drawn.empty() || drawn.back() != i)) drawn.push_back(i);
  }
}

}  // namespace

std::vector<std::size_t> drawn_samples(std::span<const double> values, std::size_t bins) {
  constexpr std::size_t kPerBin = 4;
  const std::size_t n = values.size();
  std::vector<std::size_t> drawn;
  if (n <= kPerBin * bins) {
    drawn.resize(n);
    std::iota(drawn.begin(), drawn.end(), std::size_t{0});
    return drawn;
  }
  for (std::size_t k = 0; k < bins; ++k) draw_stretch(values, n * k / bins, n * (k + 1) / bins, drawn);
  return drawn;
}

std::vector<FlagRun> runs_of(std::span<const std::uint8_t> flags) {
  std::vector<FlagRun> runs;
  for (std::size_t i = 0; i < flags.size(); i = runs.back().end) {
    std::size_t end = i;
    while (end < flags.size() && flags[end] == flags[i]) ++end;
    runs.push_back({i, end, flags[i] != 0});
  }
  return runs;
}

std::vector<std::size_t> drawn_samples(std::initializer_list<std::span<const double>> channels,
                                       std::span<const std::uint8_t> calm, std::size_t bins) {
  std::vector<FlagRun> runs = runs_of(calm);
  if (runs.size() > bins / 4) runs = {{0, calm.size(), false}};  // too many to be distinguishable
  const std::size_t of_run = std::max<std::size_t>(2, 2 * bins / std::max<std::size_t>(1, runs.size()));
  std::set<std::size_t> kept;
  for (const FlagRun& run : runs) {
    const std::size_t here = runs.size() == 1 ? bins : run.set ? of_run / 4 : of_run - of_run / 4;
    for (const std::span<const double> channel : channels) {
      for (const std::size_t i : drawn_samples(channel.subspan(run.begin, run.end - run.begin), here)) {
        kept.insert(run.begin + i);
      }
    }
  }
  return {kept.begin(), kept.end()};
}

std::vector<std::size_t> thinned(std::size_t count, std::size_t most) {
  std::vector<std::size_t> kept;
  const std::size_t shown = std::min(count, most);
  for (std::size_t i = 0; i < shown; ++i) kept.push_back(shown < 2 ? 0 : i * (count - 1) / (shown - 1));
  return kept;
}

}  // namespace tribofit
