#include "tribofit/kinematics/clock_offset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "clock_scan.hpp"
#include "force_balance.hpp"
#include "ingest/limits.hpp"
#include "ingest/recording.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

/// The velocity most samples have, and how far slip takes it away from that.
struct Plateau {
  double velocity = 0, reach = 0;
};

Plateau find_plateau(const std::vector<double>& velocity) {
  const double low = quantile(thinned(velocity, kEnough), kSpikesOfVelocity),
               high = quantile(thinned(velocity, kEnough), 1 - kSpikesOfVelocity);
  std::array<std::size_t, kVelocityBins> bins{};
  const double width = (high - low) / static_cast<double>(bins.size());
  if (!(width > 0)) return {low, 0};
  for (const double v : velocity) {
    const double bin = std::clamp((v - low) / width, 0.0, static_cast<double>(bins.size() - 1));
    ++bins[static_cast<std::size_t>(bin)];
  }
  const auto top = std::max_element(bins.begin(), bins.end()) - bins.begin();
  const double mode = low + (static_cast<double>(top) + 0.5) * width;
  return {mode, std::max(high - mode, mode - low)};
}

/// Times at which `signal` goes from below `arm` to above `level`, where it has been below `arm` since the last time.
template <typename Signal>
std::vector<double> upward_crossings(const std::vector<double>& time, Signal signal, double arm, double level) {
  std::vector<double> events;
  bool armed = false;
  double last = signal(0);
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double value = signal(i);
    if (value < arm) armed = true;
    if (armed && value > level && i > 0) {
      armed = false;
      events.push_back(time[i - 1] + (time[i] - time[i - 1]) * (level - last) / (value - last));
    }
    last = value;
  }
  return events;
}

/// Slips as the velocity shows them.
struct Slips {
  std::vector<double> jumps;        ///< times at which it leaves its plateau
  double period = 0, duration = 0;  ///< medians [s]
};

Slips find_slips(const TimedChannel& velocity) {
  const Plateau plateau = find_plateau(velocity.value);
  if (!(plateau.reach > 0)) return {};
  const auto excursion = [&](std::size_t i) { return std::abs(velocity.value[i] - plateau.velocity); };
  Slips out;
  out.jumps = upward_crossings(velocity.time, excursion, kRiseFrom * plateau.reach, kRiseTo * plateau.reach);
  if (out.jumps.size() < kFewestBreakAways) return {};
  double outside = 0;
  for (std::size_t i = 0; i < velocity.time.size(); ++i) outside += excursion(i) > kRiseTo * plateau.reach ? 1 : 0;
  out.period = typical_interval(out.jumps);
  out.duration = outside * typical_interval(velocity.time) / static_cast<double>(out.jumps.size());
  if (out.duration < kFewestInSlip * typical_interval(velocity.time)) return {};
  return out;
}

/// Offsets of parts of the time that both share, and the line through them.
struct PartsOfClock {
  ClockLine clock;
  double offset_std_error = 0, drift_std_error = 0;
};

/// Each part is looked at by itself, at most `reach` beside a clock: what wanders from cycle to cycle scatters them.
PartsOfClock follow_parts(const ForceBalance& unbalanced, const ClockMatch& match, double reach, double step,
                          double tolerance) {
  const std::size_t parts = std::clamp(match.cycles / kCyclesOfPart, kFewestParts, kMostParts);
  const double length = (match.to - match.from) / static_cast<double>(parts);
  std::vector<double> middles, offsets;
  for (std::size_t k = 0; k < parts; ++k) {
    const double from = match.from + static_cast<double>(k) * length;
    middles.push_back(from + 0.5 * length);
    offsets.push_back(unbalanced.minimise(match.clock, reach, step, tolerance, unbalanced.sample_at(from),
                                          unbalanced.sample_at(from + length)));
  }
  const StraightLine line = fit_line(middles, offsets);
  double squares = 0;
  for (std::size_t k = 0; k < parts; ++k) squares += std::pow(offsets[k] - line.at(middles[k]), 2);
  const auto count = static_cast<double>(parts);
  const double variance = squares / (count - 2) + tolerance * tolerance;
  return {{match.clock.at(line.middle) + line.value, match.clock.drift + line.slope, line.middle},
          std::sqrt(variance / count),
          std::sqrt(variance / line.squares)};
}

/// The best alignment and the best other one.
struct Decision {
  ClockMatch best, other;
  double margin() const { return best.evidence - other.evidence; }
  bool is_clear() const { return best.unbalanced < kMostUnbalanced && margin() > kClearEvidence; }
};

/// Of a stretch of friction, [from, to) of its bins.
Decision decide(const ScannedChannels& channels, const ForceBalance& unbalanced, std::size_t from, std::size_t to,
                double reach) {
  ClockScan scan = scan_clocks(channels, from, to);
  for (ClockMatch& match : scan.best) {
    match.clock = follow_parts(unbalanced, match, reach, channels.width, kFoundInBin * channels.width).clock;
    match.unbalanced = unbalanced(match.clock, unbalanced.sample_at(match.from), unbalanced.sample_at(match.to));
    match.evidence = evidence_of(match.unbalanced, scan.usual, match.cycles);
  }
  std::stable_sort(scan.best.begin(), scan.best.end(),
                   [](const ClockMatch& a, const ClockMatch& b) { return a.evidence > b.evidence; });
  Decision out;
  if (!scan.best.empty()) out.best = scan.best[0];
  if (scan.best.size() > 1) out.other = scan.best[1];
  return out;
}

/// Clocks are compared over stretches in which a drift does not matter, from the middle of friction outwards, until one
/// shows the offset.
Decision find_alignment(const ScannedChannels& channels, const ForceBalance& unbalanced, double blur) {
  const std::size_t n = channels.friction.time.size();
  const double whole = channels.width * static_cast<double>(n), longest = 2 * blur / kMostClockDrift;
  const auto stretches = static_cast<std::size_t>(std::ceil(whole / longest));
  const double reach = std::min(blur, 0.5 * whole * kMostClockDrift) + 2 * channels.width;
  Decision found;
  for (std::size_t k = 0; k < stretches && !found.is_clear(); ++k) {
    const std::size_t beside = (k + 1) / 2, middle = stretches / 2;
    const std::size_t at = k % 2 == 0 ? middle + beside : middle - beside;
    const Decision next = decide(channels, unbalanced, at * n / stretches, (at + 1) * n / stretches, reach);
    if (k == 0 || next.margin() > found.margin()) found = next;
  }
  return found;
}

/// The same alignment over all of the time that both share, twice as much at a time: the line of the clock is known so
/// well that it does not go astray.
ClockMatch followed_to_ends(ClockMatch match, const ScannedChannels& channels, const ForceBalance& unbalanced) {
  const std::vector<double>&friction = channels.friction.time, &velocity = channels.velocity.time;
  const double width = channels.width;
  while (true) {
    const double from = std::max(friction.front(), match.clock.on_friction(velocity.front())),
                 to = std::min(friction.back(), match.clock.on_friction(velocity.back())),
                 more = 0.5 * (match.to - match.from);
    if (from > match.from - width && to < match.to + width) break;
    match.from = std::max(from, match.from - more), match.to = std::min(to, match.to + more);
    match.clock = follow_parts(unbalanced, match, 4 * width, width, kFoundInBin * width).clock;
  }
  match.cycles = static_cast<std::size_t>(std::count_if(channels.jumps.begin(), channels.jumps.end(), [&](double jump) {
    const double t = match.clock.on_friction(jump);
    return t >= match.from && t <= match.to;
  }));
  return match;
}

/// Says why two records were not joined.
[[noreturn]] void refuse(const Decision& found) {
  const ClockMatch& best = found.best;
  const std::string left = fmt::format(
      "at the best offset both share {} cycles and the motion leaves {} % of "
      "friction unbalanced, at another one {} cycles and {} %",
      best.cycles, fixed(100 * best.unbalanced, 1), found.other.cycles, fixed(100 * found.other.unbalanced, 1));
  throw InputError("the two records are not of one run, share too few cycles, or their cycles are too alike: " + left,
                   "give the two files of one run, or one file with both channels on one clock");
}

/// Friction around slips, where it shows the time: around so many of them that there are no more samples than are
/// searched.
TimedChannel around_slips(const std::vector<double>& time, const std::vector<double>& value, const Slips& slips,
                          const ClockLine& clock) {
  const double around = (kBeforeSlip + kAfterSlip) * slips.duration;
  const double samples = static_cast<double>(slips.jumps.size()) * around / typical_interval(time);
  const std::size_t every = 1 + static_cast<std::size_t>(samples / kSearched);
  TimedChannel out;
  std::size_t i = 0;
  for (std::size_t k = 0; k < slips.jumps.size(); k += every) {
    const double jump = clock.on_friction(slips.jumps[k]), from = jump - kBeforeSlip * slips.duration,
                 to = jump + kAfterSlip * slips.duration;
    for (; i < time.size() && time[i] < to; ++i) {
      if (time[i] >= from) out.time.push_back(time[i]), out.value.push_back(value[i]);
    }
  }
  return out;
}

}  // namespace
}  // namespace tribofit::kinematics

namespace tribofit {

ClockOffset estimate_clock_offset(const std::vector<double>& friction_time, const std::vector<double>& friction,
                                  const std::vector<double>& velocity_time, const std::vector<double>& velocity) {
  using namespace kinematics;
  const TimedChannel motion{velocity_time, velocity};
  const Slips slips = find_slips(motion);
  if (slips.jumps.size() < kFewestBreakAways) return {};
  const double step = typical_interval(friction_time), velocity_step = typical_interval(velocity_time);
  const double length = velocity_time.back() - velocity_time.front();
  const double width = std::max({step, velocity_step, slips.duration / kBinsOfSlip, length / kMostBins});
  const ScannedChannels channels{width, binned({friction_time, friction}, width), binned(motion, width), slips.jumps,
                                 slips.period};
  const ForceBalance coarse(channels.friction, channels.velocity, 1);
  const Decision found = find_alignment(channels, coarse, kMostBlur * slips.duration);
  if (!found.is_clear()) refuse(found);
  const ClockMatch match = followed_to_ends(found.best, channels, coarse);

  const TimedChannel force = around_slips(friction_time, friction, slips, match.clock);
  const auto half = static_cast<std::size_t>(std::max(1.0, kAccelerationOver * slips.duration / velocity_step));
  const PartsOfClock fine = follow_parts(ForceBalance(force, motion, half), match, 2 * width, width / 4,
                                         kFound * std::max(step, velocity_step));
  ClockOffset result;
  result.events = match.cycles;
  result.offset = fine.clock.offset;
  result.uncertainty = std::hypot(fine.offset_std_error, kBetweenSamples * step);
  result.drift = fine.clock.drift;
  result.drift_uncertainty = fine.drift_std_error;
  return result;
}

}  // namespace tribofit
