#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "health_checks.hpp"
#include "limits.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"

// A v_r that was measured must be zero in stick, and omega r on average: the block goes nowhere.

namespace tribofit::kinematics {
namespace {

/// Means from the middle of the first plateau to that of the last [m/s].
struct MeanVelocity {
  double relative = 0, disc = 0;
};

MeanVelocity mean_velocity(const Motion& motion, const Plateaus& plateaus, std::size_t factor) {
  const auto middle = [&](const StickPlateau& run) {
    return std::min((run.begin + run.end) / 2 * factor, motion.size());
  };
  const std::size_t begin = middle(plateaus.runs.front()), end = middle(plateaus.runs.back());
  MeanVelocity mean;
  for (std::size_t i = begin; i < end; ++i) {
    mean.relative += motion.relative_velocity[i];
    mean.disc += motion.disc_velocity_at(i);
  }
  const auto n = static_cast<double>(std::max<std::size_t>(1, end - begin));
  return {mean.relative / n, mean.disc / n};
}

}  // namespace

namespace {

/// Where nothing seems to stick, which is what a wrong zero makes of stick, the mean alone is held against omega r.
HealthItem check_mean(const Motion& motion) {
  const double mean = mean_of(motion.relative_velocity), disc = motion.constant_disc_velocity;
  HealthItem item{
      health_check::kPlateauSpeed, HealthItem::Status::ok,
      fmt::format("v_r is {} mm/s on average, omega r is {} mm/s", general(1e3 * mean, 4), general(1e3 * disc, 4))};
  if (std::abs(mean / disc - 1) < kGainOff) return item;
  item.status = HealthItem::Status::problem;
  item.message += std::abs(mean / disc) < kGainOff
                      ? ": this is the velocity of the block; name the column v_b"
                      : ": zero or gain of v_r, or radius or speed, are wrong; the law's decay (alpha) is unreliable";
  return item;
}

}  // namespace

HealthItem check_measured_velocity(const Motion& motion, const Plateaus& plateaus, std::size_t factor) {
  using Status = HealthItem::Status;
  if (!motion.sticks) return check_mean(motion);
  const double rest = motion.plateau_velocity;
  HealthItem item{health_check::kPlateauSpeed, Status::ok,
                  fmt::format("v_r rests at {} mm/s in stick", general(1e3 * rest, 3))};
  const bool is_off = std::abs(rest) > std::max(kRestNoise * motion.velocity_noise / 2, kZeroPart * plateaus.depth);
  if (is_off) item.status = Status::problem;
  if (plateaus.runs.size() < kFewestPeriods) return item;
  const MeanVelocity mean = mean_velocity(motion, plateaus, factor);
  if (mean.disc == 0) {
    if (is_off) item.message += ": its zero is off, and the law's decay (alpha) with it";
    return item;
  }
  const double gain = (mean.relative - rest) / mean.disc;
  const bool looks_like_block = is_off && std::abs(gain + 1) < kGainOff;
  item.message += fmt::format(" and is {} mm/s on average, omega r is {} mm/s", general(1e3 * mean.relative, 4),
                              general(1e3 * mean.disc, 4));
  if (looks_like_block) {
    item.message += ": this is the velocity of the block; name the column v_b";
  } else if (std::abs(gain - 1) > kGainOff) {
    item.status = Status::problem;
    item.message += fmt::format(
        ": v_r reads {} times the truth, or radius or speed are wrong; the law's decay (alpha) is "
        "unreliable",
        general(gain, 3));
  } else if (is_off) {
    item.message += ": its zero is off, and the law's decay (alpha) with it";
  } else if (std::abs(gain - 1) > kGainWarned) {
    item.status = Status::warning;
    item.message += fmt::format(
        ": v_r may read {} times the truth, and the law's decay (alpha) with it, or radius or speed are "
        "off",
        general(gain, 3));
  }
  return item;
}

}  // namespace tribofit::kinematics
