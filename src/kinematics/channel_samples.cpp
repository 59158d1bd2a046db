#include "channel_samples.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>

#include "limits.hpp"
#include "resolution.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What innovations reach by chance once in a thousand records of so many samples, or kMostReach. Two quantiles that
/// outliers do not move, if fewer than one in a hundred samples is one, give the degrees of freedom of their t.
double reach_of(std::vector<double> innovations, std::size_t samples) {
  if (innovations.size() < kFewestDistributed) return kInfinity;
  using boost::math::complement, boost::math::quantile, boost::math::students_t;
  const double half = median(innovations), quantile_95 = tribofit::quantile(std::move(innovations), 0.95);
  const auto ratio = [](double freedom) {
    return quantile(students_t(freedom), 0.975) / quantile(students_t(freedom), 0.75);
  };
  double low = kHeaviestTail, high = kNormalTail;
  for (int k = 0; k < kBitsOfSearch; ++k) {
    const double middle = std::sqrt(low * high);
    (ratio(middle) > quantile_95 / half ? low : high) = middle;
  }
  const students_t tails(low);
  const double chance = 1e-3 / static_cast<double>(samples);
  const double reach = quantile_95 / quantile(tails, 0.975) * quantile(complement(tails, 0.5 * chance));
  return std::min(reach, kMostReach * quantile_95);
}

/// Stretches of at least so many equal samples.
std::vector<SampleSpan> runs_of_one_value(std::span<const double> x, std::size_t least) {
  std::vector<SampleSpan> runs;
  for (std::size_t begin = 0, i = 1; i <= x.size(); ++i) {
    if (i < x.size() && x[i] == x[begin]) continue;
    if (i - begin >= least) runs.push_back({begin, i});
    begin = i;
  }
  return runs;
}

/// Whether a channel changes between these samples by much of its range.
bool moves_between(const ChannelSamples& channel, std::size_t first, std::size_t end) {
  if (channel.x.size() < end) return false;
  const Extremes e = extremes(channel.x.subspan(first, end - first));
  return e.high - e.low > kSlipOfSamples * channel.range();
}

/// Stretches that the channel enters by a jump beyond its innovations and leaves by another, to go on where it was
/// within few samples, whatever it reads in between; or in which it is far beyond all others, at one value or for few
/// samples.
std::vector<SampleSpan> find_outliers(const ChannelSamples& channel, const ChannelSamples& beside) {
  const std::span<const double> x = channel.x;
  const double far = std::max({channel.reach, kLeastOutlier * channel.range(), kStepsOfOutlier * channel.step});
  const auto change = [&](std::size_t i) { return std::abs(x[i] - x[i - 1]); };
  std::vector<SampleSpan> outliers;
  if (!(channel.range() > 0)) return outliers;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool is_marker = channel.is_beyond(x[i]);
    if (!is_marker && (i == 0 || !(change(i) > far))) continue;
    // What leaves again sooner than it was away has not been back.
    const bool goes_on = !is_marker && !outliers.empty() && outliers.back().begin > 0 &&
                         i <= outliers.back().end + outliers.back().size();
    const std::size_t begin = goes_on ? outliers.back().begin : i;
    std::size_t end = goes_on ? i : i + 1, equal = 1;
    if (is_marker) {
      for (; end < x.size() && channel.is_beyond(x[end]); ++end) equal += x[end] == x[i] ? 1U : 0U;
    } else {
      double away = 0;
      const auto off = [&](std::size_t k) { return std::abs(x[k] - x[begin - 1]); };
      for (std::size_t k = begin; k < end; ++k) away = std::max(away, off(k));
      while (end < x.size() && end <= begin + kWidestOutlier && !(change(end) > far && off(end) < kQuietBeside * away))
        away = std::max(away, off(end++));
    }
    const bool repeats = is_marker && equal == end - i, is_short = end - begin <= kWidestOutlier && end < x.size();
    const bool was_quiet = is_marker || goes_on || i == 1 || end == i + 1 || change(i - 1) < kQuietBeside * change(i);
    const std::size_t before = begin - std::min<std::size_t>(begin, 2), after = std::min(x.size(), end + 2);
    if (repeats || (is_short && was_quiet && !moves_between(beside, before, after))) {
      if (goes_on) outliers.pop_back();
      outliers.push_back({begin, end});
      i = end;
    } else if (is_marker) {
      i = end;
    }
  }
  return outliers;
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

/// Whether a velocity that reads zero was zero. A plug that was loose takes a speed away within a sample, and perhaps
/// gives it back, while friction stays as it is in sliding; at rest friction leaves that level, or the velocity comes
/// to zero by itself.
bool is_rest(const ChannelSamples& velocity, const ChannelSamples& friction, const SampleSpan& run) {
  const std::span<const double> v = velocity.x, f = friction.x;
  if (v[run.begin] != 0 || f.size() != v.size()) return false;
  const double usual = std::max(std::abs(velocity.usual.low), std::abs(velocity.usual.high));
  const double before = run.begin > 0 ? v[run.begin - 1] : v[run.end], after = run.end < v.size() ? v[run.end] : before;
  if (std::min(std::abs(before), std::abs(after)) < kOfUsualSpeed * usual || before * after < 0) return true;
  std::vector<double> beside;
  for (std::size_t k = 1; k <= kBesideZeros; ++k) {
    if (run.begin >= k) beside.push_back(f[run.begin - k]);
    if (run.end + k <= f.size()) beside.push_back(f[run.end + k - 1]);
  }
  const double level = median(beside), scatter = kSigmaPerMad * median_absolute_deviation(beside, level);
  const auto within = f.subspan(run.begin, run.size());
  return std::abs(median({within.begin(), within.end()}) - level) > kFrictionStays * scatter;
}

}  // namespace

ChannelSamples::ChannelSamples(std::span<const double> samples) : x(samples) {
  if (x.empty()) return;
  std::vector<double> some = thinned(x, kThinned);
  std::sort(some.begin(), some.end());
  usual = {quantile_of_sorted(some, 0.001), quantile_of_sorted(some, 0.999)};
  step = find_resolution(x);
  reach = reach_of(innovations_of(x), x.size());
  const Extremes all = extremes(x);
  std::size_t turns = 0, equal = 0, within = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    turns += i + 1 < x.size() && (x[i] - x[i - 1]) * (x[i + 1] - x[i]) < 0 ? 1U : 0U;
    const bool at_end = x[i] == all.low || x[i] == all.high;
    within += at_end ? 0U : 1U;
    equal += !at_end && x[i] == x[i - 1] ? 1U : 0U;
  }
  is_noisy = static_cast<double>(turns) > kManyTurns * static_cast<double>(x.size());
  repeats = static_cast<double>(equal) / static_cast<double>(std::max<std::size_t>(1, within));
}

bool ChannelSamples::is_beyond(double value) const {
  return value < usual.low - kMarkerReach * range() || value > usual.high + kMarkerReach * range();
}

void find_outliers_and_held(ChannelSamples& channel, const ChannelSamples& beside, bool rests_at_zero) {
  const std::span<const double> x = channel.x;
  if (x.size() < kFewestDistributed) return;
  channel.outliers = find_outliers(channel, beside);
  const std::vector<SampleSpan> runs = runs_of_one_value(x, longest_by_chance(kRepeatsOfSteps, x.size()));
  if (!is_never_still(x, runs)) return;
  const Extremes range = extremes(x);
  bool rests = false;
  auto outlier = channel.outliers.begin();
  for (const SampleSpan& run : runs) {
    while (outlier != channel.outliers.end() && outlier->end <= run.begin) ++outlier;
    const bool is_outlier = outlier != channel.outliers.end() && outlier->begin < run.end;
    // A limit of the range is no frozen channel, however often it is reached.
    const double value = x[run.begin];
    if (is_outlier || (value != 0 && (value == range.low || value == range.high))) continue;
    const bool is_resting = rests_at_zero && is_rest(channel, beside, run);
    rests |= is_resting;
    if (!is_resting) channel.held.push_back(run);
  }
  // A drive that rests begins and ends so.
  std::erase_if(channel.held, [&](const SampleSpan& run) {
    return rests && x[run.begin] == 0 && (run.begin == 0 || run.end == x.size());
  });
}

std::vector<double> innovations_of(std::span<const double> x) {
  std::vector<double> all;
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kThinned);
  for (std::size_t i = 2; i + 2 < x.size(); i += stride) {
    if (x[i] != x[i - 1]) all.push_back(innovation(x, i));
  }
  return all;
}

std::size_t longest_by_chance(double repeats, std::size_t samples) {
  const auto n = static_cast<double>(samples);
  const double fraction = std::clamp(repeats, 1 / n, 1 - 1 / n);
  return std::max(kShortestRun, 1 + static_cast<std::size_t>(std::ceil(std::log(1e-3 / n) / std::log(fraction))));
}

std::size_t samples_in(const std::vector<SampleSpan>& spans) {
  std::size_t samples = 0;
  for (const SampleSpan& span : spans) samples += span.size();
  return samples;
}

void bridge(const std::vector<SampleSpan>& spans, std::vector<double>& channel) {
  for (const SampleSpan& span : spans) {
    const bool from_left = span.begin > 0, from_right = span.end < channel.size();
    if (!from_left && !from_right) continue;
    const double left = channel[from_left ? span.begin - 1 : span.end];
    const double right = channel[from_right ? span.end : span.begin - 1];
    const double steps = static_cast<double>(span.size()) + 1;
    for (std::size_t i = span.begin; i < span.end; ++i)
      channel[i] = left + (right - left) * static_cast<double>(i - span.begin + 1) / steps;
  }
}

}  // namespace tribofit::kinematics
