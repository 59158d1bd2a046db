#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "health_checks.hpp"
#include "limits.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

// How friction and velocity lie beside each other in time.

namespace tribofit::kinematics {
namespace {

using Status = HealthItem::Status;

/// Samples beside re-stick among which its jump of friction is.
std::size_t delay_window(const Plateaus& plateaus, std::size_t factor, double step) {
  std::vector<double> sticks, slips;
  for (std::size_t k = 0; k < plateaus.runs.size(); ++k) {
    sticks.push_back(static_cast<double>(plateaus.runs[k].size()));
    if (k > 0) slips.push_back(static_cast<double>(plateaus.runs[k].begin - plateaus.runs[k - 1].end));
  }
  if (slips.empty()) return static_cast<std::size_t>(kShortestDelay);
  const double shorter = std::min(median(std::move(sticks)), median(std::move(slips))) * static_cast<double>(factor);
  return static_cast<std::size_t>(
      std::clamp(std::min(kDelayReach * shorter, kLongestWindow / step), kShortestDelay, kLongestDelay));
}

/// How much later friction jumps in the last third of the slips than in the first, beside the velocity.
struct ClockDrift {
  double gained = 0, std_error = 0, time = 1;  // [s]
};

ClockDrift clock_drift(const std::vector<double>& times, const std::vector<double>& delays) {
  const std::size_t third = delays.size() / 3;
  if (third < kFewestPeriods) return {};
  const auto part = [&](const std::vector<double>& values, std::size_t begin) {
    return std::vector<double>(values.begin() + static_cast<std::ptrdiff_t>(begin),
                               values.begin() + static_cast<std::ptrdiff_t>(begin + third));
  };
  const std::size_t last = delays.size() - third;
  const double before = median(part(delays, 0)), after = median(part(delays, last));
  std::vector<double> off;
  for (std::size_t k = 0; k < third; ++k) {
    off.push_back(std::abs(delays[k] - before));
    off.push_back(std::abs(delays[last + k] - after));
  }
  const double scatter = kSigmaPerMad * median(std::move(off));
  return {after - before, 2 * scatter / std::sqrt(static_cast<double>(third)),
          median(part(times, last)) - median(part(times, 0))};
}

/// Changes of friction from sample to sample about re-stick, in the direction of the slip.
struct RestickJumps {
  std::vector<double> sum;            ///< over the slips, half of them before re-stick
  std::vector<double> times, delays;  ///< of single slips [s]
};

/// Where the velocity comes to rest before a plateau.
struct RestickSample {
  std::size_t sample = 0;
  double direction = 0;  ///< of the slip
};

/// The velocity is followed from the plateau back to the edge of rest, and from there along a straight line to rest.
/// Nothing where there are fewer than `beside` samples on either side.
std::optional<RestickSample> restick_before(const Motion& motion, std::size_t plateau, double edge,
                                            std::size_t beside) {
  const std::span<const double> v(motion.relative_velocity);
  std::size_t i = std::min(plateau, v.size() - 1);
  while (i > 0 && std::abs(v[i] - motion.plateau_velocity) < edge) --i;
  if (i < beside || i + beside >= v.size()) return std::nullopt;
  const double above = v[i] - motion.plateau_velocity, direction = above > 0 ? 1 : -1;
  const double slope = (v[i - 1] - v[i + 1]) / 2 * direction;
  const double furthest = kDelayReach * std::clamp(kLongestWindow / motion.step, kShortestDelay, kLongestDelay);
  const double rest = slope > 0 ? std::min(std::abs(above) / slope, furthest) : 0;
  const std::size_t sample = i + static_cast<std::size_t>(rest + 0.5);
  if (sample + beside >= v.size()) return std::nullopt;
  return RestickSample{sample, direction};
}

RestickJumps jumps_at_restick(const Motion& motion, const Plateaus& plateaus, std::size_t factor) {
  RestickJumps out;
  const std::size_t half = delay_window(plateaus, factor, motion.step);
  std::vector<double> single(2 * half);
  out.sum.assign(2 * half, 0.0);
  for (const StickPlateau& run : plateaus.runs) {
    if (out.delays.size() >= kMostDelays) break;
    const auto restick = restick_before(motion, run.inner_begin() * factor, kEdgeOfRest * plateaus.depth, half + 1);
    if (!restick) continue;
    const double* mu = motion.friction.data() + (restick->sample - half);
    for (std::size_t k = 0; k < single.size(); ++k) {
      single[k] = restick->direction * (mu[k + 1] - mu[k]);
      out.sum[k] += single[k];
    }
    const auto largest = std::min_element(single.begin(), single.end()) - single.begin();
    out.times.push_back(motion.time[restick->sample]);
    out.delays.push_back(motion.step * static_cast<double>(largest));
  }
  return out;
}

/// Time from re-stick to the jump of friction [s]; nothing where the change of one sample does not stand out.
std::optional<double> delay_of(const RestickJumps& jumps, double step) {
  const auto sharpest = std::min_element(jumps.sum.begin(), jumps.sum.end());
  double squares = 0;
  for (const double j : jumps.sum) squares += j * j;
  squares -= *sharpest * *sharpest;
  const double spread = std::sqrt(squares / static_cast<double>(jumps.sum.size() - 1));
  if (-*sharpest < kClearJump * spread) return std::nullopt;
  const double half = static_cast<double>(jumps.sum.size() / 2);
  return step * (static_cast<double>(sharpest - jumps.sum.begin()) - half + 0.5);
}

}  // namespace

HealthItem check_channel_delay(const Motion& motion, const Plateaus& plateaus, std::size_t factor) {
  HealthItem item{health_check::kChannelDelay, Status::ok,
                  health_check::not_checked("no re-stick to compare the channels at")};
  const RestickJumps jumps = jumps_at_restick(motion, plateaus, factor);
  const std::size_t slips = jumps.delays.size();
  if (slips < kFewestForMedian) return item;
  const ClockDrift drift = clock_drift(jumps.times, jumps.delays);
  if (std::abs(drift.gained) > std::max(kDriftSamples * motion.step, kSignificance * drift.std_error)) {
    item.status = Status::problem;
    item.message = fmt::format(
        "friction falls behind the velocity by {} ms from the first third of the record to the last ({} ppm, "
        "{} slips): their clocks drift apart; mu_k and the law's decay (alpha) are unreliable",
        fixed(1e3 * drift.gained, 2), fixed(1e6 * drift.gained / drift.time, 0), slips);
    return item;
  }
  const std::optional<double> delay = delay_of(jumps, motion.step);
  if (!delay) {
    item.message = fmt::format("{}friction does not jump at re-stick ({} slips)", health_check::kNotChecked, slips);
    return item;
  }
  item.message = fmt::format("friction jumps about {} ms {} the velocity reaches re-stick ({} slips)",
                             fixed(1e3 * std::abs(*delay), 2), *delay >= 0 ? "after" : "before", slips);
  if (std::abs(*delay) > std::max(kDelayWarned, kDelayWarnedSamples * motion.step)) item.status = Status::warning;
  return item;
}

}  // namespace tribofit::kinematics
