#include "channel_outline.hpp"

#include <algorithm>
#include <array>

#include "limits.hpp"
#include "resolution.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

Extremes usual_range(std::span<const double> x) {
  std::vector<double> some = thinned(x, kThinned);
  std::sort(some.begin(), some.end());
  return {quantile_of_sorted(some, 0.001), quantile_of_sorted(some, 0.999)};
}

void widen(Extremes& range, const Extremes& by) {
  range = {std::min(range.low, by.low), std::max(range.high, by.high)};
}

}  // namespace

ChannelOutline::ChannelOutline(std::span<const double> samples) : x(samples) {
  if (x.empty()) return;
  const std::size_t chunks = (x.size() + Chunks::length - 1) / Chunks::length;
  for (Chunks* summary : {&values, &changes}) summary->part.reserve(chunks);
  repeats.reserve(chunks);
  values.whole = {x[0], x[0]};
  std::array<double, Chunks::length + 1> change{};  // the first is the last of the chunk before
  for (std::size_t begin = 0; begin < x.size(); begin += Chunks::length) {
    const std::size_t end = std::min(x.size(), begin + Chunks::length), changed = std::min(end, x.size() - 1);
    values.part.push_back(extremes(x.subspan(begin, end - begin)));
    widen(values.whole, values.part.back());
    if (begin == changed) break;
    const std::size_t n = changed - begin;
    for (std::size_t k = 0; k < n; ++k) change[k + 1] = x[begin + k + 1] - x[begin + k];
    std::size_t equal = 0, turned = 0;
    for (std::size_t k = 1; k <= n; ++k) equal += change[k] == 0 ? 1U : 0U;
    for (std::size_t k = 1; k <= n; ++k) turned += change[k - 1] * change[k] < 0 ? 1U : 0U;
    changes.part.push_back(extremes(std::span<const double>(change).subspan(1, n)));
    if (begin == 0) changes.whole = changes.part.back();
    widen(changes.whole, changes.part.back());
    change.front() = change[n];
    repeats.push_back(static_cast<std::uint16_t>(equal));
    turns += turned;
  }
  usual = usual_range(x);
  step = find_resolution(x);
}

bool ChannelOutline::turns_often() const {
  return static_cast<double>(turns) > kManyTurns * static_cast<double>(x.size());
}

}  // namespace tribofit::kinematics
