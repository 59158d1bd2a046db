#include <algorithm>
#include <cmath>
#include <limits>

#include "channel_samples.hpp"
#include "limits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

// Where a channel is cut off: a converter or an amplifier at its limit.

namespace tribofit::kinematics {
namespace {

/// How densely values gather near an end of their range, over the density below what noise makes of that.
struct DenseEnd {
  double density = 0;
  double level = 0;         ///< middle of the densest part
  double from = 0, to = 0;  ///< with the noise on it
  std::size_t count = 0;    ///< from its inner edge on
};

/// The densest of some widths at the end, or (noisy) near it. value(i) of n values, all within the range; upper: its
/// end.
template <class Value>
DenseEnd densest_near(std::size_t n, Value&& value, const Extremes& range, bool upper, bool noisy) {
  DenseEnd best;
  if (!(range.high > range.low)) return best;
  constexpr std::size_t kLooked = kClipBins / kNarrowestRange;  // the widest; five such are counted
  std::vector<std::size_t> counts(5 * kLooked, 0);              // from the end inwards
  const double bin = (range.high - range.low) / static_cast<double>(kClipBins);
  for (std::size_t i = 0; i < n; ++i) {
    const double inwards = (upper ? range.high - value(i) : value(i) - range.low) / bin;
    if (inwards >= 0 && inwards < static_cast<double>(counts.size())) ++counts[static_cast<std::size_t>(inwards)];
  }
  std::vector<std::size_t> sums(counts.size() + 1, 0);
  for (std::size_t k = 0; k < counts.size(); ++k) sums[k + 1] = sums[k] + counts[k];
  const std::size_t least = std::max(kFewestClipped, n / kOneClippedIn);
  for (std::size_t width = 1; width <= kLooked; width *= 2) {
    for (std::size_t k = 0; k == 0 || (noisy && k + width <= kLooked); k += std::max<std::size_t>(1, width / 4)) {
      const std::size_t within = sums[k + width] - sums[k], next = k + (noisy ? 2 : 1) * width;
      const std::size_t below = sums[next + 3 * width] - sums[next];
      const double density = 3 * static_cast<double>(within) / static_cast<double>(std::max<std::size_t>(1, below));
      if (within < least || density <= best.density) continue;
      // Noise takes as much below the limit as above it.
      const double inner = static_cast<double>(k + (noisy ? 2 : 1) * width) * bin;
      const double middle = (static_cast<double>(k) + 0.5 * static_cast<double>(width)) * bin;
      best = {density, upper ? range.high - middle : range.low + middle, range.low, range.high, sums[k + width]};
      (upper ? best.from : best.to) = upper ? range.high - inner : range.low + inner;
    }
  }
  return best;
}

/// Stretches between two values, with what noise takes out of them in between; the samples beside a long one were
/// chosen by their noise and belong to it.
std::vector<SampleSpan> spans_between(std::span<const double> x, double from, double to) {
  std::vector<SampleSpan> spans;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (x[i] < from || x[i] > to) continue;
    if (!spans.empty() && i < spans.back().end + kClipHole) {
      spans.back().end = i + 1;
    } else {
      spans.push_back({i, i + 1});
    }
  }
  for (SampleSpan& span : spans) {
    if (span.size() < kClipMargin) continue;
    span.begin -= std::min(span.begin, kClipMargin);
    span.end = std::min(x.size(), span.end + kClipMargin);
  }
  return spans;
}

/// Median innovation within stretches, and some standard errors more, over that of the channel where it does not
/// repeat; 1 where there are too few.
double noise_over(std::span<const double> x, const std::vector<SampleSpan>& stretches) {
  std::vector<double> inside, all = innovations_of(x);
  for (const SampleSpan& stretch : stretches) {
    for (std::size_t i = stretch.begin + 2; i + 2 < stretch.end; ++i) inside.push_back(innovation(x, i));
  }
  if (inside.size() < kFewestSamples || all.size() < kFewestSamples) return 1;
  const double errors = kClippedErrors / std::sqrt(static_cast<double>(inside.size()));
  return (1 + errors) * median(std::move(inside)) / median(std::move(all));
}

bool overlaps(const SampleSpan& span, const std::vector<SampleSpan>& others) {
  const auto next = std::ranges::upper_bound(others, span.begin, {}, &SampleSpan::end);
  return next != others.end() && next->begin < span.end;
}

/// Distance of the nearest other value from an end of the range; 0 where the channel has few levels, each of which
/// repeats.
double step_beside(const ChannelSamples& channel, double limit) {
  double step = std::numeric_limits<double>::infinity(), widest = 0;
  for (const double value : channel.x) {
    if (value == limit) continue;
    step = std::min(step, std::abs(value - limit));
    widest = std::max(widest, std::abs(value - limit));
  }
  return widest < static_cast<double>(kFewestLevels) * step ? 0 : step;
}

/// Runs at the very end of the range that are no turn: a turn stays some times as long in its last step as in the one
/// before, a limit far longer.
RangeEnd runs_at(const ChannelSamples& channel, double limit, double step) {
  const std::span<const double> x = channel.x;
  const std::size_t least = longest_by_chance(channel.repeats, x.size());
  std::size_t beside = 0, run = 0, in_runs = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    beside += x[i] != limit && std::abs(x[i] - limit) < 1.5 * step ? 1U : 0U;
    run = x[i] == limit ? run + 1 : 0;
    in_runs += run == least ? least : run > least ? 1U : 0U;
  }
  RangeEnd end{limit, 0, false, {}};
  if (in_runs < 2 * kShortestRun || static_cast<double>(in_runs) < kStepsOfATurn * static_cast<double>(beside))
    return end;
  end.spans = spans_between(x, limit, limit);
  end.count = samples_in(end.spans);
  end.is_quiet = true;
  return end;
}

}  // namespace

void find_ends(ChannelSamples& channel, bool gathers, const std::vector<SampleSpan>& bridged) {
  const std::span<const double> x = channel.x;
  const Extremes range = x.empty() ? Extremes{} : extremes(x);
  for (std::size_t k = 0; k < 2; ++k) {
    RangeEnd& end = channel.ends[k];
    end.level = k == 0 ? range.low : range.high;
    if (x.size() < kFewestSamples || range.low == range.high || channel.repeats > kRepeatsOfSteps) continue;
    const double step = step_beside(channel, end.level);
    if (step == 0) continue;
    end = runs_at(channel, end.level, step);
    if (end.count > 0 || !channel.is_noisy || x.size() < kFewestDistributed) continue;
    const DenseEnd dense = densest_near(
        x.size(), [&](std::size_t i) { return x[i]; }, range, k == 1, true);
    if (dense.density < kDenseQuiet) continue;
    std::vector<SampleSpan> spans = spans_between(x, dense.from, dense.to);
    std::erase_if(spans, [&](const SampleSpan& span) { return overlaps(span, bridged); });
    const bool is_quiet = noise_over(x, spans) < kQuiet;
    if (is_quiet || (gathers && dense.density >= kDenseAlone))
      end = {dense.level, samples_in(spans), is_quiet, std::move(spans)};
  }
}

double find_slew_limit(const ChannelSamples& channel) {
  const std::span<const double> x = channel.x;
  if (x.size() < kFewestDistributed) return 0;
  const auto change = [&](std::size_t i) { return x[i + 1] - x[i]; };
  Extremes range{change(0), change(0)};
  for (std::size_t i = 1; i + 1 < x.size(); ++i) range.take(change(i));
  for (const bool upper : {false, true}) {
    const DenseEnd dense = densest_near(x.size() - 1, change, range, upper, false);
    const double level = dense.level;
    if (dense.density < kDenseAlone || std::abs(level) < kSlewSteps * channel.step) continue;
    std::size_t samples = 0, run = 0;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      run = std::abs(change(i) - level) < kSlewWidth * std::abs(level) ? run + 1 : 0;
      samples += run == kShortestSlew ? kShortestSlew : run > kShortestSlew ? 1 : 0;
    }
    if (2 * samples > dense.count) return std::abs(level);
  }
  return 0;
}

namespace {

/// Slope of friction against the displacement of the block over some samples [in sampling intervals].
StraightLine rise_of(std::span<const double> friction, std::span<const double> velocity) {
  std::vector<double> way(velocity.size());
  double at = 0;
  for (std::size_t i = 0; i < way.size(); ++i) way[i] = at += velocity[i];
  return fit_line(way, friction);
}

/// The first samples, from some on, over which the block is behind the disc by this part of what it was there.
std::size_t falls_behind(std::span<const double> velocity, std::size_t from, double fraction) {
  const double usual = mean_of(velocity.subspan(from, kShortestStretch));
  std::size_t i = from + kShortestStretch;
  while (i + kShortestStretch <= velocity.size() &&
         std::abs(mean_of(velocity.subspan(i, kShortestStretch)) - usual) < fraction * std::abs(usual))
    i += kShortestStretch / 4;
  return std::min(i + kShortestStretch / 2, velocity.size());
}

/// Leaves off slip and where it begins: friction hardly changes there, and the block falls behind like the square of
/// time at first, over twice as long to four times as much.
SampleSpan without_slip(std::span<const double> velocity, SampleSpan stretch) {
  if (stretch.begin + kShortestStretch > velocity.size()) return stretch;
  velocity = velocity.first(std::min(velocity.size(), stretch.end + 2 * stretch.size() + kShortestStretch));
  const std::size_t little = falls_behind(velocity, stretch.begin, kCarriedOn),
                    more = falls_behind(velocity, stretch.begin, 4 * kCarriedOn);
  const std::size_t cut = std::min(little, 2 * (more - little));
  stretch.end = std::clamp(little - cut, stretch.begin, stretch.end);
  return stretch;
}

/// Whether friction stops rising in these stretches, while the block that hangs on its spring is carried on.
bool stops_rising(std::span<const double> friction, std::span<const double> velocity,
                  const std::vector<SampleSpan>& stretches) {
  std::vector<double> ratios;
  for (const SampleSpan& stretch : stretches) {
    const SampleSpan rest = without_slip(velocity, stretch);
    const std::size_t half = rest.size() / 2;
    if (half < kShortestStretch || rest.begin < half) continue;
    const std::size_t before = rest.begin - half, last = rest.end - half;
    const StraightLine usual = rise_of(friction.subspan(before, half), velocity.subspan(before, half)),
                       there = rise_of(friction.subspan(last, half), velocity.subspan(last, half));
    const double carried = std::sqrt(there.squares / usual.squares);
    if (usual.slope != 0 && std::abs(carried - 1) < kCarriedOn) ratios.push_back(there.slope / usual.slope);
  }
  if (ratios.size() < kFewestPeriods) return false;
  const double centre = median(ratios);
  const double error =
      kSigmaPerMad * median_absolute_deviation(ratios, centre) / std::sqrt(static_cast<double>(ratios.size()));
  return centre + kClippedErrors * error < kStillRises;
}

}  // namespace

RangeEnd find_end_in_stick(const ChannelSamples& channel, std::span<const double> velocity, bool upper) {
  const std::span<const double> x = channel.x;
  if (x.size() < kFewestDistributed || x.size() != velocity.size()) return {};
  const Extremes range = extremes(x);
  const DenseEnd dense = densest_near(
      x.size(), [&](std::size_t i) { return x[i]; }, range, upper, true);
  if (dense.density < kDenseQuiet) return {};
  RangeEnd end{0, 0, false, spans_between(x, dense.from, dense.to)};
  if (!stops_rising(x, velocity, end.spans)) return {};
  std::vector<double> held;
  for (const SampleSpan& span : end.spans) {
    const auto at = [&](std::size_t i) { return x.begin() + static_cast<std::ptrdiff_t>(i); };
    held.insert(held.end(), at(span.begin + span.size() / 2), at(span.end));
  }
  end.count = samples_in(end.spans);
  end.level = median(std::move(held));
  return end;
}

}  // namespace tribofit::kinematics
