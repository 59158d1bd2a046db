#include "levelling.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "range_crowds.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Slope of friction against the way of the block over some samples, with the squares of that way: times the step.
StraightLine rise_of(std::span<const double> friction, std::span<const double> velocity) {
  std::vector<double> way(velocity.size());
  double at = 0;
  for (std::size_t i = 0; i < way.size(); ++i) way[i] = at += velocity[i];
  return fit_line(way, friction);
}

/// The first samples, from some on, over which the block is behind the disc by this part of what it was there.
std::size_t falls_behind(std::span<const double> velocity, std::size_t from, double part) {
  const double usual = mean_of(velocity.subspan(from, kShortestStretch));
  std::size_t i = from + kShortestStretch;
  while (i + kShortestStretch <= velocity.size() &&
         std::abs(mean_of(velocity.subspan(i, kShortestStretch)) - usual) < part * std::abs(usual))
    i += kShortestStretch / 4;
  return std::min(i + kShortestStretch / 2, velocity.size());
}

/// Leaves off slip and where it begins: friction hardly changes there, and the block falls behind like the square of
/// time at first, over twice as long to four times as much.
void cut_slip(std::span<const double> velocity, SampleSpan& stretch) {
  if (stretch.begin + kShortestStretch > velocity.size()) return;
  const std::size_t little = falls_behind(velocity, stretch.begin, kCarriedOn),
                    more = falls_behind(velocity, stretch.begin, 4 * kCarriedOn);
  const std::size_t cut = std::min(little, 2 * (more - little));
  stretch.end = std::clamp(little - cut, stretch.begin, stretch.end);
}

/// Whether friction stops rising in these stretches, while the block that hangs on its spring is carried on: against
/// the way of the block at rest it is a straight line for any law, however the contact creeps.
bool levels_off(std::span<const double> friction, std::span<const double> velocity,
                const std::vector<SampleSpan>& stretches) {
  std::vector<double> ratios;
  for (SampleSpan rest : stretches) {
    cut_slip(velocity, rest);
    const std::size_t half = rest.size() / 2, before = rest.begin - std::min(rest.begin, half);
    if (half < kShortestStretch || rest.begin < half) continue;
    const StraightLine usual = rise_of(friction.subspan(before, half), velocity.subspan(before, half)),
                       there =
                           rise_of(friction.subspan(rest.end - half, half), velocity.subspan(rest.end - half, half));
    const double carried = std::sqrt(there.squares / usual.squares);
    if (usual.slope != 0 && std::abs(carried - 1) < kCarriedOn) ratios.push_back(there.slope / usual.slope);
  }
  if (ratios.size() < kFewestPeriods) return false;
  const double centre = median(ratios);
  const double error =
      kSigmaPerMad * median_absolute_deviation(ratios, centre) / std::sqrt(static_cast<double>(ratios.size()));
  return centre + kClippedErrors * error < kStillRises;
}

/// Where samples crowd near the end of a range: the densest part over that below it, and how far it reaches.
struct Crowd {
  double density = 0, from = 0;
};

/// sign: -1 looks at the lower end, of a range that is turned over, too.
Crowd find_crowd(const ChannelOutline& channel, const Extremes& range, double sign) {
  const std::span<const double> x = channel.x;
  std::vector<std::size_t> counts(kClipBins, 0);  // from the end of the range inwards
  const double scale = static_cast<double>(kClipBins) / (range.high - range.low);
  const double looked_at = (5 * static_cast<double>(kClipBins / kNarrowestRange) + 1) / scale;
  for (std::size_t c = 0; c < channel.values.part.size(); ++c) {
    const Extremes& part = channel.values.part[c];
    if (range.high - sign * (sign > 0 ? part.high : part.low) >= looked_at) continue;
    const std::size_t begin = c * Chunks::length;
    for (const double value : x.subspan(begin, std::min(Chunks::length, x.size() - begin))) {
      const double below = range.high - sign * value;
      if (below < looked_at) ++counts[std::min(kClipBins - 1, static_cast<std::size_t>(below * scale))];
    }
  }
  Crowd best;
  const auto sum = [&](std::size_t from, std::size_t to) {
    return std::accumulate(counts.begin() + static_cast<std::ptrdiff_t>(from),
                           counts.begin() + static_cast<std::ptrdiff_t>(to), std::size_t{0});
  };
  for (std::size_t w = 4; w <= kClipBins / kNarrowestRange; w *= 2) {
    for (std::size_t k = 0; k + w <= kClipBins / kNarrowestRange; k += std::max<std::size_t>(1, w / 4)) {
      const std::size_t within = sum(k, k + w), below = sum(k + 2 * w, k + 5 * w);
      if (within < std::max(kFewestClipped, x.size() / kOneClippedIn)) continue;
      const double density = 3 * static_cast<double>(within) / static_cast<double>(std::max<std::size_t>(1, below));
      if (density > best.density) best = {density, range.high - static_cast<double>(k + 2 * w) / scale};
    }
  }
  return best;
}

}  // namespace

PileUp find_levelling(const ChannelOutline& channel, std::span<const double> velocity, bool upper) {
  const std::span<const double> friction = channel.x;
  PileUp pile;
  if (friction.size() < kFewestDistributed || friction.size() != velocity.size()) return pile;
  const Extremes &whole = channel.values.whole, range = upper ? whole : Extremes{-whole.high, -whole.low};
  if (!(range.high > range.low)) return pile;
  const Crowd crowd = find_crowd(channel, range, upper ? 1 : -1);
  if (crowd.density < kCrowdedQuiet) return pile;
  std::vector<double> turned_over;
  if (!upper) std::ranges::transform(friction, std::back_inserter(turned_over), std::negate());
  const std::span<const double> x = upper ? friction : turned_over;
  const std::vector<SampleSpan> spans = spans_at_limit(x, crowd.from, range.high);
  if (!levels_off(x, velocity, spans)) return pile;
  pile.levels_off = true;
  pile.density = crowd.density;
  pile.spans = spans;
  std::vector<double> held;
  for (const SampleSpan& span : spans) {
    pile.count += span.size();
    held.insert(held.end(), friction.begin() + static_cast<std::ptrdiff_t>(span.begin + span.size() / 2),
                friction.begin() + static_cast<std::ptrdiff_t>(span.end));
  }
  pile.level = median(std::move(held));
  pile.from = upper ? crowd.from : -range.high;
  pile.to = upper ? range.high : -crowd.from;
  return pile;
}

}  // namespace tribofit::kinematics
