#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "limits.hpp"
#include "motion_stages.hpp"
#include "resolution.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/kinematics/health.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/quantiles.hpp"

// The stages of a motion that say what its channels are worth.

namespace tribofit::kinematics {

void MotionStages::check_clipping() {
  recorded_ = kinematics::recorded_plateau(search_, disc_, trace_.velocity_kind);
  clipping_ = samples_->check_clipping(trace_, instruments_, {plateau_as_recorded(), is_block() && search_.sticks});
  drop_outs_ = samples_->check_drop_outs(trace_, search_.plateaus.runs.size());
  motion_.faults = samples_->take();
}

/// Where the velocity as recorded repeats in stick when there is no noise, and gathers when there is.
std::optional<LevelRange> MotionStages::plateau_as_recorded() const {
  LevelRange levels;  // of v_r
  if (is_block()) {
    const bool unknown =
        speed_is_constant() ? !search_.sticks || (is_reversed_ && !speed_was_stated_) : !recorded_.has_value();
    if (unknown) return std::nullopt;
    // Where radius, speed or gain are not as stated the block rests beside omega r.
    const Extremes rest = speed_is_constant()
                              ? Extremes{std::min(disc_.constant, plateau_), std::max(disc_.constant, plateau_)}
                              : extremes(disc_.varying);
    levels = {rest.low + motion_.velocity_zero.value, rest.high + motion_.velocity_zero.value};
  }
  const auto& vibrometer = instruments_.vibrometer;
  const double reading = vibrometer.sign * (vibrometer.gain ? vibrometer.gain->value : 1) * (is_reversed_ ? -1 : 1);
  return reading > 0 ? LevelRange{reading * levels.low, reading * levels.high}
                     : LevelRange{reading * levels.high, reading * levels.low};
}

void MotionStages::check_health() {
  motion_.health = {std::move(clipping_), std::move(drop_outs_)};
  const std::function<HealthItem()> checks[] = {
      [&] { return kinematics::check_sagging(rest_, declared_high_pass_, motion_.high_pass > 0, search_.sticks); },
      [&] { return check_band(); },
      [&] { return check_delay(); },
      [&] { return kinematics::check_revolutions(motion_); },
      [&] { return kinematics::check_speed_ripple(motion_, disc_at_rest_); },
      [&] { return kinematics::check_run_up(motion_, options_.trim, run_up_); },
      [&] { return check_level(); },
      [&] { return samples_->check_resolution(motion_.friction_kind, search_.noise); },
      [&] { return kinematics::check_friction_zero(motion_); },
  };
  std::vector<HealthItem> found(std::size(checks));
  run_tasks(found.size(), threads_, [&](std::size_t k) { found[k] = checks[k](); });
  for (HealthItem& item : found) motion_.health.push_back(std::move(item));
}

HealthItem MotionStages::check_band() const {
  if (motion_.kind == RecordKind::motion_only)
    return {health_check::kBandwidth, HealthItem::Status::ok, "friction and velocity were smoothed alike"};
  const bool velocity_was_measured =
      motion_.velocity_kind != VelocityKind::fixed_block && motion_.velocity_std_error.empty();
  const std::span<const double> velocity =
      velocity_was_measured ? std::span<const double>(motion_.relative_velocity) : std::span<const double>();
  HealthItem item = kinematics::check_bandwidth(motion_, velocity, low_pass_);
  if (samples_->friction_repeats() || samples_->velocity_repeats()) {
    item.status = HealthItem::Status::problem;
    item.message += fmt::format(
        "; {} at uneven places, as behind a running median or from a recorder with a slower clock: break-away and "
        "re-stick are cut off or late, mu_s and the law's decay (alpha) are unreliable; record without it",
        !samples_->friction_repeats()  ? "the velocity repeats values"
        : samples_->velocity_repeats() ? "friction and velocity repeat values"
                                       : "friction repeats values");
  }
  if (friction_fall_ > 0) {
    item.status = std::max(item.status, HealthItem::Status::warning);
    item.message += fmt::format(
        "; friction takes {} ms to fall at re-stick: behind a low-pass at about {}, or from a contact that yields; "
        "what a filter of higher order rounds off (mu_s, alpha) is not corrected but for its delay",
        general(1e3 * friction_fall_, 2), frequency_text(kRiseOfLowPass / friction_fall_));
  }
  const std::vector<StickPlateau>& runs = search_.plateaus.runs;
  std::vector<double> slips;
  for (std::size_t k = 1; k < runs.size(); ++k)
    slips.push_back(static_cast<double>((runs[k].begin - runs[k - 1].end) * search_.blocks.length));
  // A stick that is interrupted makes gaps that are no slips: they are the shorter ones.
  const double samples = slips.empty() ? kFewSlipSamples : quantile(std::move(slips), 0.9);
  if (samples >= kFewSlipSamples) return item;
  item.status = std::max(item.status, HealthItem::Status::warning);
  item.message += fmt::format(
      "; a slip has only {} samples: where each is a mean over its interval, mu_k and the law's decay (alpha) are "
      "unreliable",
      fixed(samples, 0));
  return item;
}

HealthItem MotionStages::check_delay() const {
  HealthItem item{health_check::kChannelDelay, HealthItem::Status::ok,
                  health_check::not_checked("no re-stick to compare the channels at")};
  if (clocks_.slips == 0) return item;
  const Estimate& drift = clocks_.drift;
  const std::string slips = fmt::format("{} slips", clocks_.slips);
  if (!clocks_.is_sharp && !drift.any()) {
    item.message = health_check::not_checked(fmt::format("friction does not jump at re-stick ({})", slips));
    return item;
  }
  const double delay = motion_.restick_delay;
  item.message = fmt::format("friction jumps about {} ms {} the velocity reaches re-stick ({})",
                             fixed(1e3 * std::abs(delay), 2), delay >= 0 ? "after" : "before", slips);
  if (std::abs(delay) > std::max(kDelayWarned, kDelayWarnedSamples * motion_.step))
    item.status = HealthItem::Status::warning;
  if (!drift.any()) return item;
  const bool corrected = motion_.clock_drift.any();
  item.status = corrected ? std::max(item.status, HealthItem::Status::warning) : HealthItem::Status::problem;
  item.message +=
      fmt::format("; friction falls behind the velocity by {} +/- {} ppm of the time, their clocks drift apart; {}",
                  fixed(1e6 * drift.value, 2), fixed(1e6 * drift.std_error, 2),
                  corrected ? "corrected" : "mu_k and the law's decay (alpha) are unreliable");
  return item;
}

HealthItem MotionStages::check_level() const {
  const bool can_be_held = motion_.sticks || motion_.constant_disc_velocity != 0;
  if (motion_.velocity_kind == VelocityKind::relative && can_be_held) {
    HealthItem item = kinematics::check_measured_velocity(motion_, plateaus_in_motion(), search_.blocks.length);
    kinematics::add_zero(zero_, true, {}, item);
    return item;
  }
  const double stated = speed_was_stated_ ? disc_.constant : 0;
  if (!speed_levels_.empty()) return kinematics::check_speed_steps(motion_, speed_levels_, search_.blocks, stated);
  HealthItem item = kinematics::check_plateau_speed(motion_, plateau_, speed_was_stated_,
                                                    motion_.conditions.radius.known(), recorded_);
  kinematics::add_zero(zero_, speed_was_stated_, motion_.velocity_response, item);
  if (zero_drift_.value == 0) return item;
  item.status = std::max(item.status, HealthItem::Status::warning);
  item.message += fmt::format("; the zero of the velocity drifts by {} mm/s over the record; corrected",
                              general(1e3 * zero_drift_.value * motion_.step * static_cast<double>(motion_.size()), 3));
  return item;
}

void MotionStages::compare_plateau() {
  // What moves a velocity that is nonlinear from omega r is neither radius nor gain.
  const bool is_nonlinear = samples_->velocity_is_slew_limited() ||
                            (zero_.kind == BlockZero::Kind::uneven && !motion_.velocity_response.any());
  if (ratio_.value == 0 || is_nonlinear) return;
  const double rounding = kinematics::rounding_of_level(samples_->velocity_step(), search_.noise) / disc_.largest;
  const double zero = motion_.velocity_zero.std_error / disc_.largest;
  motion_.plateau_ratio_in_motion = motion_.plateau_ratio = ratio_.value;
  motion_.plateau_ratio_std_error = std::hypot(std::hypot(ratio_.std_error, rounding), zero);
  if (motion_.high_pass > 0) {
    motion_.plateau_ratio -= net_velocity_.value / disc_.largest;
    motion_.plateau_ratio_std_error =
        std::hypot(motion_.plateau_ratio_std_error, net_velocity_.std_error / disc_.largest, kErrorAfterHighPass);
  }
  correct_plateau(motion_, options_.plateau);
}

}  // namespace tribofit::kinematics
