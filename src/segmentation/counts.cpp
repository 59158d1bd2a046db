#include "counts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

Interval interval_of(const Estimate& estimate) {
  const double half = t_quantile_95(estimate.degrees_of_freedom) * estimate.std_error;
  return {estimate.value - half, estimate.value + half};
}

LongSticks long_sticks(const Segmentation& segmentation) {
  LongSticks out{0, std::nan("")};
  for (const Cycle& cycle : segmentation.cycles) {
    if (!(cycle.stick_time > 0)) continue;
    if (cycle.stick_time > 1) ++out.count;
    if (!(out.longest >= cycle.stick_time)) out.longest = cycle.stick_time;
  }
  return out;
}

bool has_uneven_sticks(const Segmentation& segmentation) {
  return long_sticks(segmentation).longest > segmentation::kUnevenSticks * segmentation.stick_time.value;
}

bool follows_drive(const Motion& motion, const Segmentation& segmentation) {
  return segmentation.rms_velocity < segmentation::kSwings * std::abs(motion.constant_disc_velocity);
}

PullLevels pull_levels(const Segmentation& segmentation) {
  std::vector<double> levels, drops;
  for (const Cycle& c : segmentation.cycles) {
    if (!std::isfinite(c.break_away_friction)) continue;
    levels.push_back(c.break_away_friction);
    if (c.slip_complete) drops.push_back(c.break_away_friction - c.slip_minimum);
  }
  return {mean_with_error(std::move(levels)), mean_with_error(std::move(drops))};
}

std::optional<LevelDifference> difference_of(const FrictionLevels& levels) {
  if (levels.levels.size() < 2) return std::nullopt;
  const Estimate &small = levels.levels[0].friction, &large = levels.levels[1].friction;
  LevelDifference out;
  out.value.value = large.value - small.value;
  out.value.std_error = std::hypot(small.std_error, large.std_error);
  if (!std::isfinite(out.value.std_error)) return std::nullopt;
  const double alike = std::max(2 * out.value.std_error, segmentation::kAlikeLevels * std::abs(small.value));
  out.agree = std::abs(out.value.value) < alike;
  return out;
}

std::size_t count_of_cycles(const Segmentation& segmentation) {
  return static_cast<std::size_t>(
      std::count_if(segmentation.cycles.begin(), segmentation.cycles.end(),
                    [](const Cycle& c) { return c.stick.size() > 0 && c.slip.size() > 0; }));
}

std::vector<bool> slipping_samples(const Motion& motion, const Segmentation& segmentation) {
  std::vector<bool> slips(motion.size());
  for (std::size_t i = 0; i < slips.size(); ++i) {
    slips[i] = std::abs(motion.relative_velocity[i]) > segmentation.slip_threshold;
  }
  const auto mark = [&](const SampleRange& samples, bool value) {
    for (std::size_t i = samples.begin; i < std::min(samples.end, slips.size()); ++i) slips[i] = value;
  };
  for (const Cycle& cycle : segmentation.cycles) mark(cycle.stick, false);
  for (const Cycle& cycle : segmentation.cycles) mark(cycle.slip, true);
  return slips;
}

}  // namespace tribofit
