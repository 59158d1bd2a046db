#include "saturation.hpp"

#include <algorithm>
#include <cmath>

#include <functional>
#include <iterator>
#include <numeric>
#include <utility>
#include <vector>
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
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

/// What gathers at an end of a range, counted from there inwards; without its noise and where it is.
Saturation densest_at(const Values& values, const Extremes& range, bool upper) {
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
  Saturation best;
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
  if (best.density < kDenseQuiet) return {};
  const double from = upper ? range.high - width : range.low, to = upper ? range.high : range.low + width;
  best.level = 0.5 * (from + to);
  best.from = from, best.to = to;
  return best;
}

/// At the low and the high end.
std::array<Saturation, 2> densest_at_ends(const Values& values) {
  if (values.size() < kFewestDistributed) return {};
  const auto [all, often] = reach_of(values);
  return {densest_at(values, {all.low, often.high}, false), densest_at(values, {often.low, all.high}, true)};
}

/// Stretches within the dense part of at least so many samples.
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

std::array<Saturation, 2> find_saturation(const ChannelOutline& channel) {
  std::array<Saturation, 2> saturations = densest_at_ends({channel.x, channel.values});
  for (Saturation& saturation : saturations) {
    if (saturation.count == 0) continue;
    saturation.is_quiet = noise_within(channel.x, saturation.from, saturation.to) < kQuiet;
    if (!saturation.is_quiet && saturation.density < kDenseAlone) continue;  // nothing holds it
    saturation.spans = spans_at_limit(channel.x, saturation.from, saturation.to);
    saturation.is_still = noise_over(channel.x, saturation.spans) < kQuiet;
  }
  return saturations;
}

std::array<Saturation, 2> find_saturation_behind_noise(std::span<const double> channel) {
  std::array<Saturation, 2> found;
  const std::vector<double> means = block_means(channel, kSmoothedOver, 1).mean;
  const Chunks chunks = chunks_of(means);
  const Values values{means, chunks};
  const std::array<Saturation, 2> saturations = densest_at_ends(values);
  for (std::size_t k = 0; k < 2; ++k) {
    if (saturations[k].density < kDenseSmoothed) continue;
    Saturation saturation = saturations[k];
    saturation.spans = runs_within(values, saturation.from, saturation.to, kFewestSmoothed);
    std::size_t blocks = 0;
    for (SampleSpan& span : saturation.spans) {
      blocks += span.size();
      span = {span.begin * kSmoothedOver, span.end * kSmoothedOver};
    }
    if (2 * blocks < saturation.count) continue;
    saturation.count = blocks * kSmoothedOver;
    found[k] = saturation;
  }
  return found;
}

double find_slew_limit(const ChannelOutline& channel) {
  if (channel.size() < kFewestDistributed) return 0;
  const Values changes{channel.x, channel.changes, true};
  for (const Saturation& saturation : densest_at_ends(changes)) {
    if (saturation.density < kDenseAlone || std::abs(saturation.level) < kSlewSteps * channel.step) continue;
    const double reach = kSlewWidth * std::abs(saturation.level);
    std::size_t samples = 0;
    for (const SampleSpan& run :
         runs_within(changes, saturation.level - reach, saturation.level + reach, kShortestSlew))
      samples += run.size();
    if (2 * samples > saturation.count) return std::abs(saturation.level);
  }
  return 0;
}

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
bool stops_rising(std::span<const double> friction, std::span<const double> velocity,
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

/// Where samples gather near the end of a range: the densest part over that below it, and how far it reaches.
struct DensePart {
  double density = 0, from = 0;
};

/// sign: -1 looks at the lower end, of a range that is turned over, too.
DensePart densest_near(const ChannelOutline& channel, const Extremes& range, double sign) {
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
  DensePart best;
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

Saturation find_saturation_in_stick(const ChannelOutline& channel, std::span<const double> velocity, bool upper) {
  const std::span<const double> friction = channel.x;
  Saturation saturation;
  if (friction.size() < kFewestDistributed || friction.size() != velocity.size()) return saturation;
  const Extremes &whole = channel.values.whole, range = upper ? whole : Extremes{-whole.high, -whole.low};
  if (!(range.high > range.low)) return saturation;
  const DensePart dense = densest_near(channel, range, upper ? 1 : -1);
  if (dense.density < kDenseQuiet) return saturation;
  std::vector<double> turned_over;
  if (!upper) std::ranges::transform(friction, std::back_inserter(turned_over), std::negate());
  const std::span<const double> x = upper ? friction : turned_over;
  const std::vector<SampleSpan> spans = spans_at_limit(x, dense.from, range.high);
  if (!stops_rising(x, velocity, spans)) return saturation;
  saturation.stops_rising = true;
  saturation.density = dense.density;
  saturation.spans = spans;
  std::vector<double> held;
  for (const SampleSpan& span : spans) {
    saturation.count += span.size();
    held.insert(held.end(), friction.begin() + static_cast<std::ptrdiff_t>(span.begin + span.size() / 2),
                friction.begin() + static_cast<std::ptrdiff_t>(span.end));
  }
  saturation.level = median(std::move(held));
  saturation.from = upper ? dense.from : -range.high;
  saturation.to = upper ? range.high : -dense.from;
  return saturation;
}

}  // namespace tribofit::kinematics
