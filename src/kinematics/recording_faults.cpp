#include "recording_faults.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "resolution.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// Where all but one value in a thousand lie at each end.
Extremes usual_range(std::span<const double> x) {
  std::vector<double> some = thinned(x, kThinned);
  std::sort(some.begin(), some.end());
  return {quantile_of_sorted(some, 0.001), quantile_of_sorted(some, 0.999)};
}

std::vector<SampleSpan> find_markers(std::span<const double> x) {
  const Extremes usual = usual_range(x), all = extremes(x);
  const double span = usual.high - usual.low;
  const double low = usual.low - kMarkerReach * span, high = usual.high + kMarkerReach * span;
  if (!(span > 0) || (all.low >= low && all.high <= high)) return {};
  const auto is_beyond = [&](std::size_t i) { return x[i] < low || x[i] > high; };
  const auto is_usual = [&](std::size_t i) {
    return x[i] > usual.low - kMarkerShoulder * span && x[i] < usual.high + kMarkerShoulder * span;
  };
  std::vector<SampleSpan> markers;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!is_beyond(i)) continue;
    const std::size_t begin = i;
    bool repeats = true;
    for (; i < x.size() && is_beyond(i); ++i) repeats = repeats && x[i] == x[begin];
    const bool jumps = (begin == 0 || is_usual(begin - 1)) && (i == x.size() || is_usual(i));
    if (jumps && (repeats || i - begin <= kWidestSpike)) markers.push_back({begin, i});
  }
  return markers;
}

/// What a sample is off the line between its neighbours.
double off_line(std::span<const double> x, std::size_t i) {
  return x[i] - 0.5 * (x[i - 1] + x[i + 1]);
}

/// Whether a channel is elsewhere after sample i than before it.
bool moves_at(std::span<const double> x, std::size_t i, double least) {
  if (i < 2 || i + 2 >= x.size()) return false;
  const auto [low, high] = std::minmax({x[i - 2], x[i - 1], x[i + 1], x[i + 2]});
  return high - low > least;
}

std::vector<SampleSpan> find_spikes(std::span<const double> x, std::span<const double> beside) {
  const Extremes range = beside.empty() ? Extremes{} : usual_range(beside);
  const double motion = kSlipOfSamples * (range.high - range.low);
  const Chunks chunks = chunks_of(x);
  const std::size_t stride = std::max<std::size_t>(1, x.size() / 8192);
  std::vector<double> usual;
  for (std::size_t i = 1; i + 1 < x.size(); i += stride) usual.push_back(std::abs(off_line(x, i)));
  const double far =
      std::max(kSpikeSigmas * kSigmaPerMad * median(std::move(usual)),
               std::max(kSpikeDepth * (chunks.whole.high - chunks.whole.low), kSpikeSteps * find_resolution(x)));
  std::vector<SampleSpan> spikes;
  for (std::size_t c = 0; c < chunks.part.size(); ++c) {
    const std::size_t begin = std::max<std::size_t>(1, c * Chunks::length);
    const std::size_t end = std::min(x.size() - 1, (c + 1) * Chunks::length);
    // Within a chunk that spans less than the jump only its first or last sample can be alone.
    const bool wide = chunks.part[c].high - chunks.part[c].low > far;
    for (std::size_t i = begin; i < end; i += wide || i + 1 >= end ? 1 : end - 1 - i) {
      const double left = x[i] - x[i - 1], right = x[i] - x[i + 1];
      const bool alone = (left > far && right > far) || (left < -far && right < -far);
      // At re-stick friction peaks for a sample too, but between neighbours on different levels.
      if (!alone || std::abs(x[i + 1] - x[i - 1]) >= 0.25 * std::min(std::abs(left), std::abs(right))) continue;
      if (!moves_at(beside, i, motion)) spikes.push_back({i, i + 1});
    }
  }
  return spikes;
}

/// Runs of one value.
std::vector<SampleSpan> find_runs(std::span<const double> x, std::size_t least) {
  std::vector<SampleSpan> runs;
  for (std::size_t i = 0; i < x.size();) {
    const std::size_t begin = i;
    while (i < x.size() && x[i] == x[begin]) ++i;
    if (i - begin >= least) runs.push_back({begin, i});
  }
  return runs;
}

/// Whether the channel turns again and again outside of these runs, and hardly repeats a value there: it has noise and
/// fine steps, so that a run of one value cannot be its own.
bool is_never_still(std::span<const double> x, const std::vector<SampleSpan>& runs) {
  std::size_t looked_at = 0, equal = 0, turns = 0, next = 0;
  for (std::size_t i = 1; i + 1 < x.size(); ++i) {
    while (next < runs.size() && runs[next].end < i) ++next;
    if (next < runs.size() && i + 1 >= runs[next].begin) {
      i = runs[next].end;
      continue;
    }
    ++looked_at;
    equal += x[i] == x[i - 1] ? 1U : 0U;
    turns += (x[i] - x[i - 1]) * (x[i + 1] - x[i]) < 0 ? 1U : 0U;
  }
  const auto n = static_cast<double>(looked_at);
  return looked_at >= kFewestDistributed &&
         static_cast<double>(equal)<kFewRepeats * n&& static_cast<double>(turns)> kManyTurns * n;
}

std::vector<SampleSpan> find_frozen(std::span<const double> x) {
  std::vector<SampleSpan> runs = find_runs(x, kShortestZero);
  std::erase_if(runs, [&](const SampleSpan& run) { return run.size() < kShortestFrozen && x[run.begin] != 0; });
  if (runs.empty() || !is_never_still(x, runs)) return {};
  // A limit of the range is no frozen channel, however often it is reached.
  const Extremes range = extremes(x);
  std::erase_if(runs, [&](const SampleSpan& run) {
    const double value = x[run.begin];
    return value != 0 && (value == range.low || value == range.high);
  });
  return runs;
}

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

struct Reach {
  Extremes all, often;
};

/// What a record reaches, and what a good part of its parts do. The first pull on a rig that was slack passes through
/// the rest of the range once: beside that, all of a small drop of friction looks like one level.
Reach reach_of(std::span<const double> x) {
  std::vector<double> low, high;
  const std::size_t length = x.size() / kPartsOfRange;
  Extremes all{x[0], x[0]};
  const auto look_at = [&](std::span<const double> part) {
    const Extremes reached = extremes(part);
    all = {std::min(all.low, reached.low), std::max(all.high, reached.high)};
    return reached;
  };
  for (std::size_t k = 0; k < kPartsOfRange; ++k) {
    const Extremes part = look_at(x.subspan(k * length, length));
    low.push_back(part.low), high.push_back(part.high);
  }
  if (const auto rest = x.subspan(kPartsOfRange * length); !rest.empty()) look_at(rest);
  return {all, {quantile(std::move(low), kReachIt), quantile(std::move(high), 1 - kReachIt)}};
}

/// What crowds at an end of a range, counted from there inwards; without its noise and where it is.
PileUp crowd_at(std::span<const double> x, const Extremes& range, bool upper) {
  if (!(range.high > range.low)) return {};
  std::vector<std::size_t> counts(kClipBins, 0);
  const double scale = static_cast<double>(kClipBins) / (range.high - range.low);
  const double bin = (range.high - range.low) / static_cast<double>(counts.size());
  constexpr std::size_t kWidest = kClipBins / kNarrowestRange;
  // Most values are in bins that are not looked at.
  const double looked_at = (4 * static_cast<double>(kWidest) + 1) * bin;
  const double first = upper ? range.high - looked_at : range.low, last = upper ? range.high : range.low + looked_at;
  for (const double value : x) {
    if (value < first || value > last) continue;
    ++counts[std::min(kClipBins - 1, static_cast<std::size_t>((value - range.low) * scale))];
  }
  PileUp best;
  double width = 0;
  for (std::size_t w = 1; w <= kWidest; w *= 2) {
    std::size_t within = 0, below = 0;
    for (std::size_t k = 0; k < 4 * w; ++k) (k < w ? within : below) += counts[upper ? counts.size() - 1 - k : k];
    if (within < std::max(kFewestClipped, x.size() / kOneClippedIn)) continue;
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
std::array<PileUp, 2> find_crowds(std::span<const double> x) {
  if (x.size() < kFewestDistributed) return {};
  const auto [all, often] = reach_of(x);
  return {crowd_at(x, {all.low, often.high}, false), crowd_at(x, {often.low, all.high}, true)};
}

}  // namespace

bool turns_often(std::span<const double> channel) {
  std::size_t turns = 0;
  for (std::size_t i = 1; i + 1 < channel.size(); ++i)
    turns += (channel[i] - channel[i - 1]) * (channel[i + 1] - channel[i]) < 0 ? 1U : 0U;
  return static_cast<double>(turns) > kManyTurns * static_cast<double>(channel.size());
}

ChannelFaults find_channel_faults(std::span<const double> channel, std::span<const double> beside) {
  ChannelFaults faults;
  if (channel.size() < kFewestDistributed) return faults;
  std::vector<double> cleaned;
  const auto clean = [&](const std::vector<SampleSpan>& spans) {
    if (spans.empty()) return;
    if (cleaned.empty()) cleaned.assign(channel.begin(), channel.end());
    bridge(spans, cleaned);
    channel = cleaned;
  };
  clean(faults.markers = find_markers(channel));
  clean(faults.frozen = find_frozen(channel));
  faults.spikes = find_spikes(channel, beside);
  return faults;
}

std::vector<SampleSpan> find_excursions(std::span<const double> v, std::span<const double> friction) {
  if (v.size() < kFewestDistributed || friction.size() != v.size()) return {};
  const Extremes range = usual_range(friction), speeds = usual_range(v);
  const double motion = kSlipOfSamples * (range.high - range.low);
  std::vector<double> usual;
  const std::size_t stride = std::max<std::size_t>(1, v.size() / 8192);
  for (std::size_t i = 1; i + 1 < v.size(); i += stride) usual.push_back(std::abs(off_line(v, i)));
  const double far = std::max(kSpikeSigmas * kSigmaPerMad * median(std::move(usual)),
                              std::max(kExcursionDepth * (speeds.high - speeds.low), kSpikeSteps * find_resolution(v)));
  std::vector<SampleSpan> excursions;
  for (std::size_t i = 2; i + 2 < v.size(); ++i) {
    const double jump = v[i] - v[i - 1];
    if (!(std::abs(jump) > far) || std::abs(v[i - 1] - v[i - 2]) > kExcursionQuiet * std::abs(jump)) continue;
    const std::size_t last = std::min(v.size() - 1, i + kWidestExcursion);
    std::size_t end = i + 1;
    while (end < last && std::abs(v[end] - v[end - 1]) < kExcursionQuiet * std::abs(jump)) ++end;
    const bool returns = std::abs(v[end] - v[i - 1]) < kExcursionBack * std::abs(jump) && end > i + 1 &&
                         std::abs(v[end] - v[end - 1]) > (1 - kExcursionBack) * std::abs(jump);
    if (!returns) continue;
    const std::size_t after = std::min(friction.size(), end + 3);
    const auto [low, high] = std::ranges::minmax(friction.subspan(i - 2, after - i + 2));
    if (high - low > motion) continue;  // a slip of few samples
    excursions.push_back({i, end});
    i = end;
  }
  return excursions;
}

void bridge(const std::vector<SampleSpan>& spans, std::vector<double>& channel) {
  for (const SampleSpan& span : spans) {
    const bool from_left = span.begin > 0, from_right = span.end < channel.size();
    if (!from_left && !from_right) continue;
    const double left = channel[from_left ? span.begin - 1 : span.end];
    const double right = channel[from_right ? span.end : span.begin - 1];
    const double steps = static_cast<double>(span.size()) + 1;
    for (std::size_t i = span.begin; i < span.end; ++i) {
      channel[i] = left + (right - left) * static_cast<double>(i - span.begin + 1) / steps;
    }
  }
}

std::vector<SampleSpan> spans_at_limit(std::span<const double> x, double from, double to) {
  std::vector<SampleSpan> spans;
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

std::array<PileUp, 2> find_pile_ups(std::span<const double> channel) {
  std::array<PileUp, 2> piles = find_crowds(channel);
  for (PileUp& pile : piles) {
    if (pile.count == 0) continue;
    pile.is_quiet = noise_within(channel, pile.from, pile.to) < kQuiet;
    if (!pile.is_quiet && pile.density < kCrowdedAlone) continue;  // nothing holds it
    pile.spans = spans_at_limit(channel, pile.from, pile.to);
    pile.is_still = noise_over(channel, pile.spans) < kQuiet;
  }
  return piles;
}

namespace {

/// Stretches within the crowd of at least so many samples.
std::vector<SampleSpan> runs_within(std::span<const double> x, double from, double to, std::size_t least) {
  std::vector<SampleSpan> runs;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < from || x[i] > to) continue;
    const std::size_t begin = i;
    while (i < x.size() && x[i] >= from && x[i] <= to) ++i;
    if (i - begin >= least) runs.push_back({begin, i});
  }
  return runs;
}

}  // namespace

std::array<PileUp, 2> find_smoothed_pile_ups(std::span<const double> channel) {
  std::array<PileUp, 2> found;
  const std::vector<double> means = block_means(channel, kSmoothedOver, 1).mean;
  const std::array<PileUp, 2> piles = find_crowds(means);
  for (std::size_t k = 0; k < 2; ++k) {
    if (piles[k].density < kCrowdedSmoothed) continue;
    PileUp pile = piles[k];
    pile.spans = runs_within(means, pile.from, pile.to, kFewestSmoothed);
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

double find_slew_limit(std::span<const double> channel) {
  if (channel.size() < kFewestDistributed) return 0;
  std::vector<double> changes(channel.size() - 1);
  for (std::size_t i = 0; i < changes.size(); ++i) changes[i] = channel[i + 1] - channel[i];
  const double step = find_resolution(channel);
  for (const PileUp& pile : find_crowds(changes)) {
    if (pile.density < kCrowdedAlone || std::abs(pile.level) < kSlewSteps * step) continue;
    const double reach = kSlewWidth * std::abs(pile.level);
    std::size_t samples = 0;
    for (const SampleSpan& run : runs_within(changes, pile.level - reach, pile.level + reach, kShortestSlew))
      samples += run.size();
    if (2 * samples > pile.count) return std::abs(pile.level);
  }
  return 0;
}

}  // namespace tribofit::kinematics
