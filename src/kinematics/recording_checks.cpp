#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "health_checks.hpp"
#include "tribofit/kinematics/health_names.hpp"
#include "tribofit/statistics/quantiles.hpp"

// What the recorder did: a range that was too small, samples and times that are missing.

namespace tribofit::kinematics {
namespace {

using Status = HealthItem::Status;

// A quantised channel repeats its extremes by chance, as it repeats every other value.
bool repeats_elsewhere(std::span<const double> x, const Extremes& range) {
  std::size_t equal = 0, looked_at = 0;
  const std::size_t stride = std::max<std::size_t>(1, x.size() / 20000);
  for (std::size_t i = 1; i < x.size(); i += stride) {
    if (x[i] == range.low || x[i] == range.high) continue;
    ++looked_at;
    equal += x[i] == x[i - 1] ? 1u : 0u;
  }
  return 5 * equal > looked_at;
}

std::size_t samples_in_runs(std::span<const double> x, const Chunks& chunks, double limit) {
  constexpr std::size_t least = 3;
  std::size_t in_runs = 0, run = 0;
  for (std::size_t c = 0; c < chunks.part.size(); ++c) {
    if (chunks.part[c].low != limit && chunks.part[c].high != limit) {
      run = 0;
      continue;
    }
    const std::size_t end = std::min(x.size(), (c + 1) * Chunks::length);
    for (std::size_t i = c * Chunks::length; i < end; ++i) {
      run = x[i] == limit ? run + 1 : 0;
      if (run == least) in_runs += least;
      if (run > least) ++in_runs;
    }
  }
  return in_runs;
}

std::array<EndRuns, 2> ends_of(std::span<const double> x, const Chunks& chunks) {
  const Extremes range = chunks.whole;
  std::array<EndRuns, 2> ends = {EndRuns{range.low, 0}, EndRuns{range.high, 0}};
  if (x.size() < 16 || range.low == range.high || repeats_elsewhere(x, range)) return ends;
  for (EndRuns& end : ends) end.count = samples_in_runs(x, chunks, end.at);
  return ends;
}

/// A stretch of samples in which neither channel changes.
struct Frozen {
  std::size_t begin = 0, length = 0;
};

Frozen longest_frozen(std::span<const double> a, std::span<const double> b) {
  Frozen longest;
  if (a.size() != b.size()) return longest;
  std::size_t run = 1;
  for (std::size_t i = 1; i < a.size(); ++i) {
    run = a[i] == a[i - 1] && b[i] == b[i - 1] ? run + 1 : 1;
    if (run > longest.length) longest = {i + 1 - run, run};
  }
  return longest;
}

// Samples that jump away and back at once, far beyond what neighbouring samples do.
std::size_t lone_samples(std::span<const double> x, const Chunks& chunks) {
  if (x.size() < 64) return 0;
  const std::size_t stride = std::max<std::size_t>(1, x.size() / 8192);
  std::vector<double> usual;
  for (std::size_t i = 1; i + 1 < x.size(); i += stride) usual.push_back(std::abs(x[i] - 0.5 * (x[i - 1] + x[i + 1])));
  const double spread = kSigmaPerMad * median(std::move(usual));
  const double far = std::max(20 * spread, 0.05 * (chunks.whole.high - chunks.whole.low));
  std::size_t count = 0;
  for (std::size_t c = 0; c < chunks.part.size(); ++c) {
    const std::size_t begin = std::max<std::size_t>(1, c * Chunks::length);
    const std::size_t end = std::min(x.size() - 1, (c + 1) * Chunks::length);
    // Within a chunk that spans less than the jump only its first or last sample can be alone.
    const bool wide = chunks.part[c].high - chunks.part[c].low > far;
    for (std::size_t i = begin; i < end; i += wide || i + 1 >= end ? 1 : end - 1 - i) {
      const double left = x[i] - x[i - 1], right = x[i] - x[i + 1];
      const bool alone = (left > far && right > far) || (left < -far && right < -far);
      // At re-stick friction peaks for a sample too, but between neighbours on different levels.
      if (alone && std::abs(x[i + 1] - x[i - 1]) < 0.25 * std::min(std::abs(left), std::abs(right))) ++count;
    }
  }
  return count;
}

struct Gaps {
  std::size_t count = 0;
  double longest = 0;  // [s]
};

// Intervals longer than 1.6 of the usual one; stretches whose duration is as it should be are not looked into.
Gaps gaps_of(std::span<const double> time, double step) {
  constexpr std::size_t length = 64;
  Gaps gaps;
  for (std::size_t begin = 0; begin + 1 < time.size(); begin += length) {
    const std::size_t end = std::min(time.size() - 1, begin + length);
    if (time[end] - time[begin] < (static_cast<double>(end - begin) + 0.5) * step) continue;
    for (std::size_t i = begin; i < end; ++i) {
      const double d = time[i + 1] - time[i];
      if (d > 1.6 * step) ++gaps.count;
      gaps.longest = std::max(gaps.longest, d);
    }
  }
  return gaps;
}

}  // namespace

RangeEnds range_ends(const Trace& trace, const Chunks& friction, const Chunks& velocity) {
  return {ends_of(trace.friction, friction), ends_of(trace.velocity, velocity),
          std::max(std::abs(velocity.whole.low), std::abs(velocity.whole.high))};
}

HealthItem check_clipping(const RangeEnds& ends, const Trace& trace, const Instruments& instruments,
                          std::optional<double> plateau) {
  HealthItem item{health_check::kClipping, Status::ok, "no runs of identical samples at the end of a channel's range"};
  const auto add_warning = [&](const char* name, const EndRuns& end, double factor, const char* unit) {
    if (end.count < 6) return;
    const double share = static_cast<double>(end.count) / static_cast<double>(trace.size());
    item.status = share > 0.001 ? Status::problem : Status::warning;
    item.message = fmt::format("{} stays at {:.4g}{} for {} samples ({:.2g} %): the range was too small", name,
                               factor * end.at, unit, end.count, 100 * share);
  };
  const auto& [low, high] = ends.friction;
  const char* unit = trace.friction_kind == FrictionKind::force ? " N" : "";
  if (low.at <= 0) add_warning("friction", low, 1, unit);
  if (high.at >= 0) add_warning("friction", high, 1, unit);
  const double range = std::abs(ends.velocity[1].at - ends.velocity[0].at);
  for (const EndRuns& end : ends.velocity) {
    const bool is_plateau = plateau && std::abs(end.at - *plateau) <= 0.02 * std::abs(*plateau) + 1e-6 * range;
    if (!is_plateau) add_warning("velocity", end, 1e3, " mm/s");
  }
  if (item.status == Status::ok && instruments.vibrometer.range && ends.largest_velocity > 0) {
    const double declared = instruments.vibrometer.range->value;
    if (ends.largest_velocity >= 0.995 * declared) {
      item.status = Status::warning;
      item.message = fmt::format("velocity reaches {:.4g} mm/s, the declared range is {:.4g} mm/s",
                                 1e3 * ends.largest_velocity, 1e3 * declared);
    }
  }
  return item;
}

HealthItem check_drop_outs(const Trace& trace, const Chunks& friction, const Chunks& velocity) {
  const std::size_t n = trace.size();
  if (n < 16) return {health_check::kDropOuts, Status::warning, fmt::format("only {} samples", n)};
  const double step = trace.interval();
  const Gaps gaps = gaps_of(trace.time, step);
  const std::size_t spikes = lone_samples(trace.friction, friction) + lone_samples(trace.velocity, velocity);
  const Frozen frozen = longest_frozen(trace.friction, trace.velocity);
  HealthItem item{health_check::kDropOuts, Status::ok,
                  fmt::format("none in {} samples, {:.4g} s", n, trace.duration())};
  if (frozen.length >= 16 && 20 * frozen.length > n && frozen.length < n) {
    item.status = Status::problem;
    item.message =
        fmt::format("both channels stand still from {:.4g} s on for {:.4g} s ({:.2g} % of the record)",
                    trace.time[frozen.begin], trace.time[frozen.begin + frozen.length - 1] - trace.time[frozen.begin],
                    100 * static_cast<double>(frozen.length) / static_cast<double>(n));
    return item;
  }
  if (gaps.count == 0 && spikes == 0) return item;
  const bool many = static_cast<double>(gaps.count + spikes) > 1e-3 * static_cast<double>(n);
  item.status = many ? Status::problem : Status::warning;
  item.message = fmt::format(
      "{} gaps in time (longest {:.3g} ms at a sampling interval of {:.3g} ms), {} lone samples far "
      "from their neighbours",
      gaps.count, 1e3 * gaps.longest, 1e3 * step, spikes);
  return item;
}

}  // namespace tribofit::kinematics
