#include "recording_faults.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

std::vector<SampleSpan> find_markers(const ChannelOutline& channel) {
  const std::span<const double> x = channel.x;
  const Extremes &usual = channel.usual, &all = channel.values.whole;
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

/// Whether a channel is elsewhere after sample i than before it.
bool moves_at(std::span<const double> x, std::size_t i, double least) {
  if (i < 2 || i + 2 >= x.size()) return false;
  const auto [low, high] = std::minmax({x[i - 2], x[i - 1], x[i + 1], x[i + 2]});
  return high - low > least;
}

std::vector<SampleSpan> find_spikes(const ChannelOutline& channel, const ChannelOutline& other) {
  const std::span<const double> x = channel.x, beside = other.x;
  const double motion = kSlipOfSamples * (other.usual.high - other.usual.low);
  const Chunks& chunks = channel.values;
  const std::size_t stride = std::max<std::size_t>(1, x.size() / 8192);
  std::vector<double> usual;
  for (std::size_t i = 1; i + 1 < x.size(); i += stride) usual.push_back(std::abs(off_line(x, i)));
  const double far = std::max(kSpikeSigmas * kSigmaPerMad * median(std::move(usual)),
                              std::max(kSpikeDepth * channel.range(), kSpikeSteps * channel.step));
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
std::vector<SampleSpan> find_runs(const ChannelOutline& channel, std::size_t least) {
  const std::span<const double> x = channel.x;
  std::vector<SampleSpan> runs;
  for (std::size_t i = 0; i < x.size();) {
    const std::size_t chunk = i / Chunks::length;
    if (i % Chunks::length == 0 && chunk < channel.repeats.size() && channel.repeats[chunk] == 0) {
      i += Chunks::length;
      continue;
    }
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

/// Samples beside a run.
std::vector<double> beside_of(std::span<const double> x, const SampleSpan& run) {
  const std::size_t from = run.begin - std::min(run.begin, kBesideZeros),
                    to = std::min(x.size(), run.end + kBesideZeros);
  std::vector<double> out(x.begin() + static_cast<std::ptrdiff_t>(from),
                          x.begin() + static_cast<std::ptrdiff_t>(run.begin));
  out.insert(out.end(), x.begin() + static_cast<std::ptrdiff_t>(run.end), x.begin() + static_cast<std::ptrdiff_t>(to));
  return out;
}

/// Whether a sliding velocity that reads zero was zero: an encoder repeats it. A plug that was loose takes a speed away
/// within a sample, and perhaps gives it back, while friction stays as it is in sliding; at rest friction leaves that
/// level, or the velocity comes to zero by itself.
bool is_rest(const ChannelOutline& velocity, const ChannelOutline& friction, const SampleSpan& run) {
  const std::span<const double> v = velocity.x, f = friction.x;
  if (v[run.begin] != 0 || f.size() != v.size()) return false;
  const double usual = std::max(std::abs(velocity.usual.low), std::abs(velocity.usual.high));
  const auto slides = [&](std::size_t i) { return std::abs(v[i]) > kOfUsualSpeed * usual; };
  const bool taken = run.begin > 0 && slides(run.begin - 1), given = run.end < v.size() && slides(run.end);
  const bool at_end = run.begin == 0 || run.end == v.size();
  const bool same_way = at_end || v[run.begin - 1] * v[run.end] > 0;
  if (!(at_end ? taken || given : taken && given) || !same_way) return true;
  std::vector<double> beside = beside_of(f, run);
  if (beside.size() < kShortestZero) return true;
  const double level = median(beside);
  for (double& value : beside) value = std::abs(value - level);
  const double scatter = kSigmaPerMad * median(std::move(beside));
  const auto within = f.subspan(run.begin, run.size());
  return std::abs(median({within.begin(), within.end()}) - level) > kFrictionStays * scatter;
}

/// What a loose plug left of a channel. friction: beside a sliding velocity, which reads zero at rest as well.
std::vector<SampleSpan> find_frozen(const ChannelOutline& channel, const ChannelOutline* friction) {
  const std::span<const double> x = channel.x;
  std::vector<SampleSpan> runs = find_runs(channel, kShortestZero);
  std::erase_if(runs, [&](const SampleSpan& run) { return run.size() < kShortestFrozen && x[run.begin] != 0; });
  if (runs.empty() || !is_never_still(x, runs)) return {};
  // A limit of the range is no frozen channel, however often it is reached.
  const Extremes& range = channel.values.whole;
  std::erase_if(runs, [&](const SampleSpan& run) {
    const double value = x[run.begin];
    return (value != 0 && (value == range.low || value == range.high)) ||
           (friction != nullptr && is_rest(channel, *friction, run));
  });
  return runs;
}

}  // namespace

ChannelFaults find_channel_faults(const ChannelOutline& recorded, const ChannelOutline& beside,
                                  bool is_sliding_velocity) {
  ChannelFaults faults;
  if (recorded.size() < kFewestDistributed) return faults;
  std::vector<double> cleaned;
  ChannelOutline outline_of_cleaned;
  const ChannelOutline* channel = &recorded;
  const auto clean = [&](const std::vector<SampleSpan>& spans) {
    if (spans.empty()) return;
    if (cleaned.empty()) cleaned.assign(recorded.x.begin(), recorded.x.end());
    bridge(spans, cleaned);
    outline_of_cleaned = ChannelOutline(cleaned);
    channel = &outline_of_cleaned;
  };
  clean(faults.markers = find_markers(*channel));
  clean(faults.frozen = find_frozen(*channel, is_sliding_velocity ? &beside : nullptr));
  faults.spikes = find_spikes(*channel, beside);
  return faults;
}

std::vector<SampleSpan> find_marker_values(std::span<const double> channel) {
  if (channel.size() < kFewestDistributed) return {};
  return find_markers(ChannelOutline(channel));
}

std::vector<SampleSpan> find_excursions(const ChannelOutline& velocity, const ChannelOutline& other) {
  const std::span<const double> v = velocity.x, friction = other.x;
  if (v.size() < kFewestDistributed || friction.size() != v.size()) return {};
  const Extremes &range = other.usual, &speeds = velocity.usual;
  const double motion = kSlipOfSamples * (range.high - range.low);
  std::vector<double> usual;
  const std::size_t stride = std::max<std::size_t>(1, v.size() / 8192);
  for (std::size_t i = 1; i + 1 < v.size(); i += stride) usual.push_back(std::abs(off_line(v, i)));
  const double far = std::max(kSpikeSigmas * kSigmaPerMad * median(std::move(usual)),
                              std::max(kExcursionDepth * (speeds.high - speeds.low), kSpikeSteps * velocity.step));
  std::vector<SampleSpan> excursions;
  for (std::size_t i = 2; i + 2 < v.size(); ++i) {
    const std::size_t change = i - 1;
    const Extremes& chunk = velocity.changes.part[change / Chunks::length];
    if (change % Chunks::length == 0 && std::max(-chunk.low, chunk.high) <= far) {
      i += Chunks::length - 1;
      continue;
    }
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

}  // namespace tribofit::kinematics
