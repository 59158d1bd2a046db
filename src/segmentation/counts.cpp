#include "counts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "limits.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

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

namespace segmentation {

double branch_difference(std::span<const double> velocity, std::span<const double> friction, int direction) {
  constexpr std::size_t bins = 10;
  const auto speed = [&](std::size_t i) { return direction * velocity[i]; };
  std::size_t top = 0;
  for (std::size_t i = 1; i < velocity.size(); ++i) {
    if (speed(i) > speed(top)) top = i;
  }
  if (velocity.empty() || !(speed(top) > 0)) return std::nan("");
  struct Bin {
    double sum = 0, count = 0;
  };
  std::array<Bin, bins> up{}, down{};
  for (std::size_t i = 0; i < velocity.size(); ++i) {
    const double place = (speed(i) / speed(top) - 0.25) / 0.5;  // 0 at a quarter of the peak, 1 at three quarters
    if (!(place >= 0 && place < 1)) continue;
    Bin& bin = (i < top ? up : down)[static_cast<std::size_t>(place * bins)];
    bin.sum += direction * friction[i];
    bin.count += 1;
  }
  double difference = 0, compared = 0;
  for (std::size_t k = 0; k < bins; ++k) {
    if (up[k].count == 0 || down[k].count == 0) continue;
    difference += up[k].sum / up[k].count - down[k].sum / down[k].count;
    compared += 1;
  }
  return compared > 0 ? difference / compared : std::nan("");
}

Estimate frequency_of(const std::vector<double>& periods) {
  std::vector<double> known = periods;
  std::erase_if(known, [](double p) { return std::isnan(p); });
  if (known.size() < 2) return {std::nan(""), std::nan("")};
  const double centre = median(known);
  const double limit = std::max(3 * kSigmaPerMad * median_absolute_deviation(known, centre), 0.02 * centre);
  std::erase_if(known, [&](double p) { return std::abs(p - centre) > limit; });
  const Estimate period = mean_with_error(std::move(known));
  return {1 / period.value, period.std_error / (period.value * period.value), period.degrees_of_freedom};
}

Estimate mean_over_slips(std::vector<double> values) {
  std::erase_if(values, [](double x) { return std::isnan(x); });
  const bool few = values.size() >= 3 && values.size() < kManySlips;
  return few ? mean_of_independent(values) : mean_with_error(std::move(values));
}

}  // namespace segmentation

}  // namespace tribofit
