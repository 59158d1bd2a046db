#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "health_checks.hpp"
#include "ingest/limits.hpp"
#include "limits.hpp"
#include "saturation.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

// What the recorder did: a range that was too small, samples and times that are missing.

namespace tribofit::kinematics {
namespace {

using Status = HealthItem::Status;

// A quantised channel repeats its extremes by chance, as it repeats every other value.
bool repeats_elsewhere(std::span<const double> x, const Extremes& range) {
  std::size_t equal = 0, looked_at = 0;
  const std::size_t stride = std::max<std::size_t>(1, x.size() / kValuesForRepeats);
  for (std::size_t i = 1; i < x.size(); i += stride) {
    if (x[i] == range.low || x[i] == range.high) continue;
    ++looked_at;
    equal += x[i] == x[i - 1] ? 1u : 0u;
  }
  return static_cast<double>(equal) > kRepeatsOfSteps * static_cast<double>(looked_at);
}

std::vector<SampleSpan> runs_at(std::span<const double> x, const Chunks& chunks, double limit) {
  constexpr std::size_t least = kShortestAtEnd;
  std::vector<SampleSpan> runs;
  std::size_t run = 0;
  for (std::size_t c = 0; c < chunks.part.size(); ++c) {
    if (chunks.part[c].low != limit && chunks.part[c].high != limit) {
      run = 0;
      continue;
    }
    const std::size_t end = std::min(x.size(), (c + 1) * Chunks::length);
    for (std::size_t i = c * Chunks::length; i < end; ++i) {
      run = x[i] == limit ? run + 1 : 0;
      if (run == least) runs.push_back({i + 1 - least, i + 1});
      if (run > least) runs.back().end = i + 1;
    }
  }
  return runs;
}

/// The smallest distance of another value from an end of the range.
double step_beside(const ChannelOutline& channel, double limit) {
  double step = std::numeric_limits<double>::infinity();
  const bool upper = limit == channel.values.whole.high;
  for (std::size_t c = 0; c < channel.values.part.size(); ++c) {
    const double nearest = upper ? channel.values.part[c].high : channel.values.part[c].low;
    if (nearest != limit) {
      step = std::min(step, std::abs(nearest - limit));
      continue;
    }
    const std::size_t begin = c * Chunks::length, length = std::min(Chunks::length, channel.size() - begin);
    for (const double value : channel.x.subspan(begin, length)) {
      if (value != limit) step = std::min(step, std::abs(value - limit));
    }
  }
  return step;
}

/// Whether the longest run at a limit is a turn that the channel's steps are too coarse to show, as noiseless friction
/// makes where its law is flat at rest: had the run gone on as fast as it is entered and left, it would have passed the
/// limit by a few steps.
bool turns_over(const ChannelOutline& channel, double limit, const std::vector<SampleSpan>& runs) {
  const double step = step_beside(channel, limit);
  const SampleSpan longest = *std::ranges::max_element(runs, {}, &SampleSpan::size);
  const auto rate = [&](auto first, auto last) {  // steps in a sample; a run at an end of the record: any
    if (first == last) return std::numeric_limits<double>::infinity();
    const double value = *first;
    const auto next = std::find_if(first, last, [&](double other) { return other != value; });
    return std::abs(value - limit) / step / static_cast<double>(next - first);
  };
  const std::span<const double> before = channel.x.first(longest.begin), after = channel.x.subspan(longest.end);
  const double entered = rate(before.rbegin(), before.rend()), left = rate(after.begin(), after.end());
  return static_cast<double>(longest.size()) / (1 / entered + 1 / left) < kStepsOfATurn;
}

/// smooths: a dense part is looked for behind noise, too. A velocity gathers where the contact creeps.
std::array<EndRuns, 2> ends_of(const ChannelOutline& channel, bool smooths) {
  const std::span<const double> x = channel.x;
  const Extremes& range = channel.values.whole;
  std::array<EndRuns, 2> ends;
  ends[0].at = range.low, ends[1].at = range.high;
  if (x.size() < kFewestSamples || range.low == range.high || repeats_elsewhere(x, range)) return ends;
  // Without noise a limit repeats one value, and the dense part of a turn is as quiet as all the rest.
  const bool has_noise = channel.turns_often();
  std::array<Saturation, 2> saturations = has_noise ? find_saturation(channel) : std::array<Saturation, 2>{};
  const std::array<Saturation, 2> smoothed =
      has_noise && smooths ? find_saturation_behind_noise(x) : std::array<Saturation, 2>{};
  for (std::size_t k = 0; k < 2; ++k) {
    if (saturations[k].density < kDenseAlone && !saturations[k].is_quiet && smoothed[k].count > 0)
      saturations[k] = smoothed[k];
  }
  for (std::size_t k = 0; k < 2; ++k) {
    ends[k].spans = runs_at(x, channel.values, ends[k].at);
    if (!ends[k].spans.empty() && turns_over(channel, ends[k].at, ends[k].spans)) ends[k].spans.clear();
    for (const SampleSpan& run : ends[k].spans) ends[k].count += run.size();
    ends[k].saturation = saturations[k];
    ends[k].is_far = std::abs(ends[k].at) >= std::abs(ends[1 - k].at);
  }
  return ends;
}

/// A channel as a person reads it.
struct Units {
  const char* name;
  double factor;
  const char* unit;
  std::uint8_t kind;
};

/// Whether a limit holds what gathers at an end of the range. Where nothing sticks a channel may rest there, as
/// friction does at the fastest of some constant speeds, but not far from zero and without its noise.
bool is_held(const EndRuns& end, bool sticks) {
  const Saturation& saturation = end.saturation;
  if (saturation.count == 0) return false;
  if (sticks) return saturation.is_quiet || saturation.density >= kDenseAlone || saturation.stops_rising;
  return saturation.is_quiet && saturation.is_still && end.is_far;
}

/// An end of the velocity's range without what rests there in stick; where that is not known, what gathers may.
EndRuns without_rest(EndRuns end, double range, const std::optional<LevelRange>& plateau) {
  const auto is_rest = [&](double width) {
    const double off = kSettled * std::max(std::abs(plateau->low), std::abs(plateau->high)) + width;
    return end.at >= plateau->low - off && end.at <= plateau->high + off;
  };
  if (plateau && is_rest(kRoundingOfRange * range)) end.count = 0;
  if (!plateau || is_rest(range / static_cast<double>(kNarrowestRange))) end.saturation.count = 0;
  return end;
}

/// Reports the samples at an end of a channel's range. Returns where they are; null: there are none.
const std::vector<SampleSpan>* add_range_end(const Units& channel, const EndRuns& end, bool sticks, std::size_t samples,
                                             const char* unreliable, HealthItem& item) {
  const bool held = is_held(end, sticks), repeats = end.count >= kFewestAtEnd;
  if (!repeats && !held) return nullptr;
  const std::size_t count = std::max(end.count, held ? end.saturation.count : 0);
  const double share = static_cast<double>(count) / static_cast<double>(samples);
  item.status = share > kMuchClipped ? Status::problem : Status::warning;
  item.message =
      fmt::format("{} stays at {}{} for {} samples ({} %): the range was too small; they are not used, {} unreliable",
                  channel.name, general(channel.factor * (repeats ? end.at : end.saturation.level), 4), channel.unit,
                  count, general(100 * share, 3), unreliable);
  return held ? &end.saturation.spans : &end.spans;
}

/// rate: largest change of the channel in a second, where changes gather at it; 0: they do not.
void add_slew(const Units& channel, double rate, HealthItem& item) {
  if (rate == 0) return;
  const bool is_first = item.status == Status::ok;
  item.status = Status::problem;
  item.message = fmt::format(
      "{}{}{} changes by at most {}{} per second: the slew rate of its amplifier limits it; mu_s, mu_k and the "
      "law's decay (alpha) are unreliable",
      is_first ? "" : item.message, is_first ? "" : "; ", channel.name, general(channel.factor * rate, 3),
      channel.unit);
}

void compare_with_declared(double largest_velocity, const Instruments& instruments, HealthItem& item) {
  const auto& declared = instruments.vibrometer.range;
  if (!declared || !(largest_velocity > 0) || largest_velocity < kAtDeclaredRange * declared->value) return;
  item.status = Status::warning;
  item.message = fmt::format("velocity reaches {} mm/s, the declared range is {} mm/s",
                             general(1e3 * largest_velocity, 4), general(1e3 * declared->value, 4));
}

struct Gaps {
  std::size_t count = 0;
  double longest = 0;  // [s]
};

// Stretches whose duration is as it should be are not looked into.
Gaps gaps_of(std::span<const double> time, double step) {
  constexpr std::size_t length = 64;
  const double longest = kGapInterval * step, excess = longest - step;
  Gaps gaps;
  for (std::size_t begin = 0; begin + 1 < time.size(); begin += length) {
    const std::size_t end = std::min(time.size() - 1, begin + length);
    if (time[end] - time[begin] < static_cast<double>(end - begin) * step + excess) continue;
    for (std::size_t i = begin; i < end; ++i) {
      const double d = time[i + 1] - time[i];
      if (d > longest) ++gaps.count;
      gaps.longest = std::max(gaps.longest, d);
    }
  }
  return gaps;
}

}  // namespace

RangeEnds range_ends(const Trace& trace, const ChannelOutlines& channels, int threads) {
  const bool recorded = trace.velocity_std_error.empty();  // not made from another channel
  const ChannelOutline &friction = channels.friction, &velocity = channels.velocity;
  RangeEnds out;
  out.largest_velocity = std::max(std::abs(velocity.values.whole.low), std::abs(velocity.values.whole.high));
  const auto find_friction_ends = [&] {
    out.friction = ends_of(friction, true);
    const bool shows_rest = recorded && trace.velocity_kind == VelocityKind::block && friction.turns_often();
    for (std::size_t k = 0; k < 2 && shows_rest; ++k) {
      // Friction gathers at break-away too, where it is the same every time: the block slips there already.
      if (out.friction[k].count == 0)
        out.friction[k].saturation = find_saturation_in_stick(friction, velocity.x, k == 1);
    }
  };
  run_tasks(4, threads, [&](std::size_t k) {
    if (k == 0) find_friction_ends();
    if (k == 1) out.velocity = ends_of(velocity, false);
    if (k == 2 && recorded) out.friction_slew = find_slew_limit(friction);
    if (k == 3 && recorded) out.velocity_slew = find_slew_limit(velocity);
  });
  return out;
}

HealthItem check_clipping(const RangeEnds& ends, const Trace& trace, const Instruments& instruments,
                          const Resting& resting, double step, SpoiltSamples& spoilt) {
  HealthItem item{health_check::kClipping, Status::ok, "no samples crowd at the end of a channel's range"};
  const bool is_force = trace.friction_kind == FrictionKind::force;
  const Units friction{"friction", 1, is_force ? " N" : "", SampleFault::friction};
  const Units velocity{"velocity", 1e3, " mm/s", SampleFault::velocity};
  const auto add_end = [&](const Units& channel, const EndRuns& end, const char* unreliable) {
    const std::vector<SampleSpan>* spans = add_range_end(channel, end, resting.sticks, trace.size(), unreliable, item);
    if (spans != nullptr) spoilt.add_clipped(*spans, channel.kind);
  };
  const auto& [low, high] = ends.friction;
  if (low.at <= 0) add_end(friction, low, high.at <= 0 ? "mu_s is" : "the lowest friction is");
  if (high.at >= 0) add_end(friction, high, "mu_s is");
  const double range = std::abs(ends.velocity[1].at - ends.velocity[0].at);
  for (const EndRuns& end : ends.velocity)
    add_end(velocity, without_rest(end, range, resting.plateau), "mu_k and the law's decay (alpha) are");
  if (resting.sticks) {
    add_slew(friction, ends.friction_slew / step, item);
    add_slew(velocity, ends.velocity_slew / step, item);
  }
  if (item.status == Status::ok) compare_with_declared(ends.largest_velocity, instruments, item);
  return item;
}

HealthItem check_drop_outs(const Trace& trace, const SpoiltSamples& spoilt, const LostSamples& lost,
                           std::size_t plateaus, double step) {
  const std::size_t n = trace.size();
  if (n < kFewestSamples) return {health_check::kDropOuts, Status::warning, fmt::format("only {} samples", n)};
  const Gaps gaps = gaps_of(trace.time, step);
  const std::vector<std::string>& spoilt_by = spoilt.sentences();
  const SampleSpan& still = spoilt.longest_still();
  HealthItem item{health_check::kDropOuts, Status::ok,
                  fmt::format("none in {} samples, {} s", n, general(trace.duration(), 4))};
  if (still.size() >= kShortestFrozen && static_cast<double>(still.size()) > kMuchFrozen * static_cast<double>(n) &&
      still.size() < n) {
    item.status = Status::problem;
    item.message = fmt::format("both channels do not change from {} s for {} s ({} % of the record)",
                               general(trace.time[still.begin], 4),
                               general(trace.time[still.end - 1] - trace.time[still.begin], 4),
                               general(100 * static_cast<double>(still.size()) / static_cast<double>(n), 3));
    for (const std::string& sentence : spoilt_by) item.message += "; " + sentence;
    return item;
  }
  const bool loses = are_lost(lost, plateaus);
  if (gaps.count == 0 && spoilt_by.empty() && !loses) return item;
  const auto faults = static_cast<double>(gaps.count + spoilt.spikes());
  const bool many = loses || faults > kMuchFaulty * static_cast<double>(n) || spoilt.frozen_part() > kMuchFrozen;
  item.status = many ? Status::problem : Status::warning;
  item.message.clear();
  if (gaps.count > 0) {
    item.message = fmt::format("{} gaps in time (longest {} ms at a sampling interval of {} ms)", gaps.count,
                               general(1e3 * gaps.longest, 3), general(1e3 * step, 3));
  }
  for (const std::string& sentence : spoilt_by) item.message += (item.message.empty() ? "" : "; ") + sentence;
  if (loses) {
    item.message += fmt::format(
        "{}the velocity jumps {} times without a gap in time ({} % of the fast intervals): samples were lost "
        "and the time column was regenerated; the frequency and all times are unreliable",
        item.message.empty() ? "" : "; ", lost.jumps, general(100 * lost.part, 3));
  }
  return item;
}

}  // namespace tribofit::kinematics
