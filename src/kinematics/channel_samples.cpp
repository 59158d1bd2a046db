#include "channel_samples.hpp"

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "limits.hpp"
#include "resolution.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// How far some samples, spread over the channel, are off the cubic through two neighbours on either side, which
/// follows the motion; not of samples that repeat, as an encoder does at rest.
std::vector<double> innovations_of(std::span<const double> x) {
  std::vector<double> off;
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kThinned);
  for (std::size_t i = 2; i + 2 < x.size(); i += stride) {
    const double distance = std::abs(x[i] - (4 * (x[i - 1] + x[i + 1]) - (x[i - 2] + x[i + 2])) / 6);
    if (x[i] != x[i - 1]) off.push_back(distance);
  }
  return off;
}

/// What innovations reach by chance once in a thousand records of so many samples. Two quantiles that faults of less
/// than a hundredth do not move give the degrees of freedom of their t distribution.
double reach_of(std::vector<double> innovations, std::size_t samples) {
  if (innovations.size() < kFewestDistributed) return kInfinity;
  using boost::math::complement, boost::math::quantile, boost::math::students_t;
  const double often = tribofit::quantile(innovations, 0.9), seldom = tribofit::quantile(std::move(innovations), 0.99);
  const auto ratio = [](double freedom) {
    return quantile(students_t(freedom), 0.995) / quantile(students_t(freedom), 0.95);
  };
  double low = kHeaviestTail, high = kNormalTail;
  for (int k = 0; k < kBitsOfSearch; ++k) {
    const double middle = std::sqrt(low * high);
    (ratio(middle) > seldom / often ? low : high) = middle;
  }
  const students_t tails(low);
  const double chance = 1e-3 / static_cast<double>(samples);
  return std::min(seldom / quantile(tails, 0.995) * quantile(complement(tails, 0.5 * chance)), kMostReach * often);
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
/// within few samples; or in which it holds a value far beyond all others.
std::vector<SampleSpan> find_outliers(const ChannelSamples& channel, const ChannelSamples& beside) {
  const std::span<const double> x = channel.x;
  const double far = std::max({channel.reach, kLeastOutlier * channel.range(), kStepsOfOutlier * channel.step});
  const auto change = [&](std::size_t i) { return std::abs(x[i] - x[i - 1]); };
  std::vector<SampleSpan> outliers;
  if (!(channel.range() > 0)) return outliers;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const bool is_marker = channel.is_beyond(x[i]);
    if (!(i == 0 ? is_marker : change(i) > far)) continue;
    std::size_t end = i + 1;
    if (is_marker) {
      while (end < x.size() && x[end] == x[i]) ++end;
      const bool comes_back = end == x.size() || !channel.is_beyond(x[end]);
      if ((i == 0 || !channel.is_beyond(x[i - 1])) && comes_back) outliers.push_back({i, end});
      if (comes_back) i = end;
      continue;
    }
    const double jump = change(i);
    const std::size_t last = std::min(x.size(), i + kWidestOutlier);
    while (end < last && change(end) < kQuietBeside * jump) ++end;
    const bool was_quiet = i == 1 || change(i - 1) < kQuietBeside * jump || end == i + 1;
    const bool returns = end < last && std::abs(x[end] - x[i - 1]) < kQuietBeside * jump;
    if (!returns || !was_quiet || moves_between(beside, i - std::min<std::size_t>(i, 2), std::min(x.size(), end + 2)))
      continue;
    outliers.push_back({i, end});
    i = end;
  }
  return outliers;
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
  std::vector<SampleSpan> runs = runs_of_one_value(x, longest_by_chance(kRepeatsOfSteps, x.size()));
  const std::size_t in_runs = samples_in(runs);
  const auto others = static_cast<double>(x.size() - in_runs);
  const double equal = channel.repeats * static_cast<double>(x.size()) - static_cast<double>(in_runs);
  if (others < kFewestDistributed || !channel.is_noisy || equal > kFewRepeats * others) return;
  const auto rests_in = [&](const SampleSpan& run) { return rests_at_zero && is_rest(channel, beside, run); };
  const bool rests = std::ranges::any_of(runs, rests_in);
  // A limit of the range is no frozen channel, however often it is reached. A drive that rests begins and ends so.
  const Extremes range = extremes(x);
  std::erase_if(runs, [&](const SampleSpan& run) {
    const double value = x[run.begin];
    const bool at_limit = value != 0 && (value == range.low || value == range.high);
    const bool at_end = value == 0 && (run.begin == 0 || run.end == x.size());
    const bool is_marker = std::ranges::find(channel.outliers, run.begin, &SampleSpan::begin) != channel.outliers.end();
    return at_limit || is_marker || rests_in(run) || (rests && at_end);
  });
  channel.held = std::move(runs);
}

std::size_t longest_by_chance(double repeats, std::size_t samples) {
  const auto n = static_cast<double>(samples);
  const double part = std::clamp(repeats, 1 / n, 1 - 1 / n);
  return std::max<std::size_t>(kShortestRun, 1 + static_cast<std::size_t>(std::log(1e-3 / n) / std::log(part)));
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
