#include "range_crowds.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Of the distances from a line through both neighbours; 1 where there are too few.
double ratio_of_noise(std::vector<double> inside, std::vector<double> elsewhere) {
  if (inside.size() < kFewestSamples || elsewhere.size() < kFewestSamples) return 1;
  return median(std::move(inside)) / median(std::move(elsewhere));
}

/// Noise of the samples that lie in [from, to] with both neighbours, over that of the channel.
double noise_within(std::span<const double> x, double from, double to) {
  std::vector<double> inside, outside;
  const auto is_inside = [&](std::size_t i) { return x[i] >= from && x[i] <= to; };
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kValuesForSteps);
  std::size_t next = stride;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    const bool in = is_inside(i) && is_inside(i - 1) && is_inside(i + 1), is_next = i == next;
    if (is_next) next += stride;
    if (in ? inside.size() < kValuesForSteps : is_next) (in ? inside : outside).push_back(std::abs(off_line(x, i)));
  }
  return ratio_of_noise(std::move(inside), std::move(outside));
}

/// Noise of whole stretches over that of the channel. Samples that were picked for lying near one another look quiet
/// whatever holds them; what a limit holds is quiet with all that is between.
double noise_over(std::span<const double> x, const std::vector<SampleSpan>& stretches) {
  std::vector<double> inside, all;
  for (const SampleSpan& stretch : stretches) {
    for (std::size_t i = stretch.begin + 1; i + 1 < stretch.end; ++i) inside.push_back(std::abs(off_line(x, i)));
  }
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kValuesForSteps);
  for (std::size_t i = 1; i + 1 < x.size(); i += stride) all.push_back(std::abs(off_line(x, i)));
  return ratio_of_noise(std::move(inside), std::move(all));
}

/// Values in their order with the extremes of their chunks: samples of a channel, or changes from one to the next.
struct Values {
  std::span<const double> x;
  const Chunks& chunks;
  bool are_changes = false;

  std::size_t size() const { return are_changes ? x.size() - 1 : x.size(); }
  double operator[](std::size_t i) const { return are_changes ? x[i + 1] - x[i] : x[i]; }

  /// look(extremes or value), of whole chunks where they lie within [begin, end).
  template <class Look>
  void each_within(std::size_t begin, std::size_t end, Look&& look) const {
    for (std::size_t i = begin; i < end;) {
      if (i % Chunks::length == 0 && i + Chunks::length <= end) {
        look(chunks.part[i / Chunks::length]);
        i += Chunks::length;
      } else {
        const double value = (*this)[i++];
        look(Extremes{value, value});
      }
    }
  }

  /// take(value), of those in [low, high].
  template <class Take>
  void each_between(double low, double high, Take&& take) const {
    for (std::size_t c = 0; c < chunks.part.size(); ++c) {
      if (chunks.part[c].low > high || chunks.part[c].high < low) continue;
      const std::size_t end = std::min(size(), (c + 1) * Chunks::length);
      for (std::size_t i = c * Chunks::length; i < end; ++i) {
        const double value = (*this)[i];
        if (value >= low && value <= high) take(value);
      }
    }
  }
};

struct Reach {
  Extremes all, often;
};

/// What a record reaches, and what a good part of its parts do. The first pull on a rig that was slack passes through
/// the rest of the range once: beside that, all of a small drop of friction looks like one level.
Reach reach_of(const Values& values) {
  std::vector<double> low, high;
  const std::size_t length = values.size() / kPartsOfRange;
  for (std::size_t k = 0; k < kPartsOfRange; ++k) {
    Extremes part{values[k * length], values[k * length]};
    values.each_within(k * length, (k + 1) * length, [&](const Extremes& reached) {
      part = {std::min(part.low, reached.low), std::max(part.high, reached.high)};
    });
    low.push_back(part.low), high.push_back(part.high);
  }
  return {values.chunks.whole, {quantile(std::move(low), kReachIt), quantile(std::move(high), 1 - kReachIt)}};
}

/// What crowds at an end of a range, counted from there inwards; without its noise and where it is.
PileUp crowd_at(const Values& values, const Extremes& range, bool upper) {
  if (!(range.high > range.low)) return {};
  std::vector<std::size_t> counts(kClipBins, 0);
  const double scale = static_cast<double>(kClipBins) / (range.high - range.low);
  const double bin = (range.high - range.low) / static_cast<double>(counts.size());
  constexpr std::size_t kWidest = kClipBins / kNarrowestRange;
  // Most values are in bins that are not looked at.
  const double looked_at = (4 * static_cast<double>(kWidest) + 1) * bin;
  const double first = upper ? range.high - looked_at : range.low, last = upper ? range.high : range.low + looked_at;
  values.each_between(first, last, [&](double value) {
    ++counts[std::min(kClipBins - 1, static_cast<std::size_t>((value - range.low) * scale))];
  });
  PileUp best;
  double width = 0;
  for (std::size_t w = 1; w <= kWidest; w *= 2) {
    std::size_t within = 0, below = 0;
    for (std::size_t k = 0; k < 4 * w; ++k) (k < w ? within : below) += counts[upper ? counts.size() - 1 - k : k];
    if (within < std::max(kFewestClipped, values.size() / kOneClippedIn)) continue;
    const double density = 3 * static_cast<double>(within) / std::max(1.0, static_cast<double>(below));
    if (density <= best.density) continue;
    best.density = density;
    best.count = within;
    width = static_cast<double>(w) * bin;
  }
  if (best.density < kCrowdedQuiet) return {};
  const double from = upper ? range.high - width : range.low, to = upper ? range.high : range.low + width;
  best.level = 0.5 * (from + to);
  best.from = from, best.to = to;
  return best;
}

/// At the low and the high end.
std::array<PileUp, 2> find_crowds(const Values& values) {
  if (values.size() < kFewestDistributed) return {};
  const auto [all, often] = reach_of(values);
  return {crowd_at(values, {all.low, often.high}, false), crowd_at(values, {often.low, all.high}, true)};
}

/// Stretches within the crowd of at least so many samples.
std::vector<SampleSpan> runs_within(const Values& values, double from, double to, std::size_t least) {
  std::vector<SampleSpan> runs;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Extremes& chunk = values.chunks.part[i / Chunks::length];
    if (chunk.high < from || chunk.low > to) i = (i / Chunks::length + 1) * Chunks::length;  // nothing of it
    if (i >= values.size()) break;
    if (values[i] < from || values[i] > to) continue;
    const std::size_t begin = i;
    while (i < values.size() && values[i] >= from && values[i] <= to) ++i;
    if (i - begin >= least) runs.push_back({begin, i});
  }
  return runs;
}

}  // namespace

std::vector<SampleSpan> spans_at_limit(std::span<const double> x, double from, double to) {
  // Counted first: where a plateau of noise crosses a limit there are as many as a tenth of the samples, and a vector
  // that grows takes three times their room.
  std::size_t count = 0, end = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < from || x[i] > to) continue;
    count += count == 0 || i >= end + kClipHole ? 1 : 0;
    end = i + 1;
  }
  std::vector<SampleSpan> spans;
  spans.reserve(count);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < from || x[i] > to) continue;
    if (!spans.empty() && i < spans.back().end + kClipHole) {
      spans.back().end = i + 1;
    } else {
      spans.push_back({i, i + 1});
    }
  }
  // The samples beside a stretch at the limit were chosen by their noise.
  for (SampleSpan& span : spans) {
    if (span.size() < kClipMargin) continue;
    span.begin -= std::min(span.begin, kClipMargin);
    span.end = std::min(x.size(), span.end + kClipMargin);
  }
  return spans;
}

std::array<PileUp, 2> find_pile_ups(const ChannelOutline& channel) {
  std::array<PileUp, 2> piles = find_crowds({channel.x, channel.values});
  for (PileUp& pile : piles) {
    if (pile.count == 0) continue;
    pile.is_quiet = noise_within(channel.x, pile.from, pile.to) < kQuiet;
    if (!pile.is_quiet && pile.density < kCrowdedAlone) continue;  // nothing holds it
    pile.spans = spans_at_limit(channel.x, pile.from, pile.to);
    pile.is_still = noise_over(channel.x, pile.spans) < kQuiet;
  }
  return piles;
}

std::array<PileUp, 2> find_smoothed_pile_ups(std::span<const double> channel) {
  std::array<PileUp, 2> found;
  const std::vector<double> means = block_means(channel, kSmoothedOver, 1).mean;
  const Chunks chunks = chunks_of(means);
  const Values values{means, chunks};
  const std::array<PileUp, 2> piles = find_crowds(values);
  for (std::size_t k = 0; k < 2; ++k) {
    if (piles[k].density < kCrowdedSmoothed) continue;
    PileUp pile = piles[k];
    pile.spans = runs_within(values, pile.from, pile.to, kFewestSmoothed);
    std::size_t blocks = 0;
    for (SampleSpan& span : pile.spans) {
      blocks += span.size();
      span = {span.begin * kSmoothedOver, span.end * kSmoothedOver};
    }
    if (2 * blocks < pile.count) continue;
    pile.count = blocks * kSmoothedOver;
    found[k] = pile;
  }
  return found;
}

double find_slew_limit(const ChannelOutline& channel) {
  if (channel.size() < kFewestDistributed) return 0;
  const Values changes{channel.x, channel.changes, true};
  for (const PileUp& pile : find_crowds(changes)) {
    if (pile.density < kCrowdedAlone || std::abs(pile.level) < kSlewSteps * channel.step) continue;
    const double reach = kSlewWidth * std::abs(pile.level);
    std::size_t samples = 0;
    for (const SampleSpan& run : runs_within(changes, pile.level - reach, pile.level + reach, kShortestSlew))
      samples += run.size();
    if (2 * samples > pile.count) return std::abs(pile.level);
  }
  return 0;
}

}  // namespace tribofit::kinematics
