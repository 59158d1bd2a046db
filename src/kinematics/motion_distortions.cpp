#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "limits.hpp"
#include "motion_stages.hpp"
#include "net_displacement.hpp"
#include "static_responses.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/output/digits.hpp"
#include "undo_low_pass.hpp"

// The stages of a motion that undo what its channels did to their readings.

namespace tribofit::kinematics {

void MotionStages::undo_distortions() {
  if (is_block() && search_.sticks && speed_is_constant()) {
    samples_->add_standstill(search_, final_level(search_.plateaus), trace_);
  }
  if (options_.friction_low_pass) {
    motion_.friction_low_pass = *options_.friction_low_pass;
    motion_.friction_filter_source = FilterSource::other_runs;
  }
  if (!trace_.velocity_std_error.empty()) return compare_channels();  // the velocity was made from another channel
  if (samples_->velocity_is_slew_limited()) return;  // nothing of this brings back what an amplifier did not follow
  undo_zero_drift();
  find_zero();
  undo_zero();
  if (search_.sticks && !samples_->velocity_repeats()) samples_->find_lost(trace_, search_, disc_);
  // What was lost of slips is missing in the way of the block.
  if (!samples_->lost().are_significant(search_.plateaus.runs.size()) && options_.undo_distortions) {
    undo_velocity_response();
    undo_friction_response();
  }
  undo_low_pass();
  undo_clock_drift();
  find_friction_filter();
}

void MotionStages::undo_zero_drift() {
  const bool asked = options_.undo_distortions && motion_.high_pass == 0 && !samples_->any();
  if (!asked || !is_block() || !search_.sticks || !speed_is_constant()) return;
  if (positions_.time.empty()) positions_ = positions_in_plateaus(trace_.time, trace_.velocity, search_, threads_);
  zero_drift_ = find_zero_drift(trace_, search_, positions_, samples_->velocity_step());
  if (zero_drift_.value == 0) return;
  const double middle = 0.5 * (trace_.time.front() + trace_.time.back());
  for (std::size_t i = 0; i < trace_.size(); ++i) trace_.velocity[i] -= zero_drift_.value * (trace_.time[i] - middle);
  motion_.notes.push_back(fmt::format("velocity: its zero drifted by {} mm/s over the record, taken off",
                                      general(1e3 * zero_drift_.value * trace_.duration(), 4)));
  find_plateau();
  positions_ = {};
}

/// A block on a spring goes nowhere: what v_b is on average is an error of the reading.
void MotionStages::find_zero() {
  if (motion_.high_pass > 0 || samples_->any()) return;
  if (is_block() && search_.sticks) {
    if (positions_.time.empty()) positions_ = positions_in_plateaus(trace_.time, trace_.velocity, search_, threads_);
    zero_ = kinematics::find_zero(search_, disc_, positions_, samples_->velocity_step());
  }
  const bool rests_nowhere = trace_.velocity_kind == VelocityKind::relative && !search_.sticks;
  if (rests_nowhere && speed_is_constant()) zero_ = find_zero_of_relative(trace_, search_, disc_);
}

void MotionStages::undo_zero() {
  if (zero_.kind != BlockZero::Kind::zero || !options_.undo_distortions) return;
  motion_.velocity_zero = {zero_.mean.value, zero_.mean.std_error};
  for (double& v : trace_.velocity) v -= zero_.mean.value;
  motion_.notes.push_back(
      fmt::format("velocity: its zero was off by {} mm/s, taken off", general(1e3 * zero_.mean.value, 4)));
  find_plateau();
}

void MotionStages::undo_velocity_response() {
  if (zero_.kind != BlockZero::Kind::uneven || !disc_.known || !speed_is_constant() ||
      samples_->clips_slips(search_.plateaus))
    return;
  if (std::abs(final_level(search_.plateaus) - disc_.constant) > kPlateauHolds * std::abs(zero_.mean.value)) return;
  motion_.velocity_response = find_velocity_response(trace_, search_, zero_.mean);
  const StaticResponse& found = motion_.velocity_response.response;
  if (!found.any()) return;
  for (double& v : trace_.velocity) v = found.undone(v);
  const bool one_sided = found.form == StaticResponse::Form::one_sided;
  motion_.notes.push_back(fmt::format("velocity: its gain is {} % {} {}; corrected",
                                      general(100 * std::abs(found.part), 3), found.part > 0 ? "less" : "more",
                                      one_sided ? "against the disc" : "at the highest speed"));
  find_plateau();
}

void MotionStages::undo_friction_response() {
  if (!is_block() || !search_.sticks) return;
  motion_.friction_response = find_friction_response(trace_, search_);
  const StaticResponse& found = motion_.friction_response.response;
  if (!found.any()) return;
  for (double& mu : trace_.friction) mu = found.undone(mu);
  motion_.notes.push_back(
      fmt::format("friction: its gain is {} % less at the highest reading; corrected", general(100 * found.part, 3)));
}

/// One that the user states is undone whether it shows or not.
void MotionStages::undo_stated_low_pass() {
  const std::optional<Declared>& stated = instruments_.vibrometer.low_pass;
  if (!stated || trace_.velocity_kind == VelocityKind::fixed_block) return;
  const double tau = 1 / (2 * std::numbers::pi * stated->value);
  const double fastest = search_.sticks ? search_.plateaus.depth : largest_of(trace_.velocity);
  kinematics::undo_low_pass(trace_.velocity, tau, motion_.step, search_.noise, fastest);
  motion_.notes.push_back(
      fmt::format("velocity: the declared low-pass at {}; corrected", frequency_text(stated->value)));
  find_plateau();
}

void MotionStages::undo_low_pass() {
  undo_stated_low_pass();
  if (!search_.sticks || trace_.velocity_kind == VelocityKind::fixed_block) return;
  std::vector<double> relative;  // to a disc whose speed varies
  if (!speed_is_constant() && is_block()) {
    relative = trace_.velocity;
    for (std::size_t i = 0; i < relative.size(); ++i) relative[i] -= disc_.varying[i];
  }
  low_pass_ =
      find_low_pass(relative.empty() ? trace_.velocity : relative, search_.plateaus.level,
                    std::max(search_.noise, samples_->velocity_step() / std::sqrt(12.0)), motion_.step, threads_);
  const bool asked = options_.undo_distortions && !instruments_.vibrometer.low_pass;
  if (!low_pass_.is_first_order || !asked) return;
  motion_.velocity_low_pass = {low_pass_.tau, low_pass_.std_error};
  const std::size_t smeared = 1 + kinematics::undo_low_pass(trace_.velocity, low_pass_.tau, motion_.step, search_.noise,
                                                            search_.plateaus.depth);
  for (const double at : low_pass_.resticks) {
    const auto first = static_cast<std::size_t>(std::max(0.0, std::ceil(at - static_cast<double>(smeared))));
    const auto end = static_cast<std::size_t>(std::max(0.0, std::floor(at + static_cast<double>(smeared)) + 1));
    samples_->add_unsure({{std::min(first, trace_.size()), std::min(end, trace_.size())}});
  }
  motion_.notes.push_back(
      fmt::format("velocity: a low-pass at {}; corrected", frequency_text(1 / (2 * std::numbers::pi * low_pass_.tau))));
  find_plateau();
}

/// A velocity that was made is what its window left of it: its re-sticks say when they are, and no more.
void MotionStages::compare_channels() {
  if (!search_.sticks) return;
  const std::vector<double> resticks =
      find_low_pass(trace_.velocity, search_.plateaus.level, search_.noise, motion_.step, threads_).resticks;
  clocks_ = find_clock_drift(trace_.friction, resticks);
  motion_.restick_delay = clocks_.at_start * motion_.step;
}

void MotionStages::undo_clock_drift() {
  if (trace_.velocity_kind == VelocityKind::fixed_block) return;
  clocks_ = find_clock_drift(trace_.friction, low_pass_.resticks);
  motion_.restick_delay = clocks_.at_start * motion_.step;
  // A filter that holds its input for a sample is half of one early or late: friction, where it jumps, shows it.
  const bool holds = motion_.velocity_low_pass.any() && !clocks_.drift.any() && clocks_.slips > 0;
  if (holds && std::abs(clocks_.at_start) < kHeldInput && clocks_.is_sharp) {
    follow_clock(trace_.velocity, 0, clocks_.at_start, low_pass_.resticks);
    motion_.restick_delay = 0;
  }
  if (!clocks_.drift.any() || !options_.undo_distortions) return;
  motion_.clock_drift = clocks_.drift;
  // Where the offset of two files was estimated it is that of the middle of the record; else both begin together.
  const bool joined = motion_.clock_offset_std_error != 0;
  const Ends ends =
      follow_clock(trace_.velocity, clocks_.drift.value, joined ? clocks_.at_start : 0, low_pass_.resticks);
  if (joined) motion_.restick_delay = 0;
  if (joined) motion_.clock_offset_std_error = 0.5 * trace_.duration() * clocks_.drift.std_error;
  lost_ = {std::max(lost_.head, ends.head), std::max(lost_.tail, ends.tail)};
  motion_.notes.push_back(fmt::format("velocity: moved by {} ppm of the time, to the clock of friction",
                                      general(1e6 * clocks_.drift.value, 3)));
  find_plateau();
}

void MotionStages::find_friction_filter() {
  // Behind a filter of the velocity that is not undone re-stick is somewhere else, where the contact creeps friction
  // goes on to change as the contact does, however little that is.
  const bool rests = low_pass_.rise < kRestickCreeps * kRestickSeen;
  const bool is_known = rests && (!low_pass_.is_filter || motion_.velocity_low_pass.any());
  if (!options_.undo_distortions || !is_known || instruments_.force_sensor.bandwidth) return;
  const FrictionLowPass found = find_friction_low_pass(trace_.friction, low_pass_.resticks, motion_.step, threads_);
  friction_fall_ = found.fall;
  if (options_.friction_low_pass) return;
  motion_.friction_filter_source = found.is_known ? FilterSource::this_record : FilterSource::unknown;
  const std::optional<Declared>& at_least = instruments_.force_sensor.bandwidth_at_least;
  if (at_least && 2 * std::numbers::pi * found.tau.value * at_least->value > 1) return;  // declared not to be there
  motion_.friction_low_pass = found.tau;
  // A filter that holds its input for a sample is half of one early.
  const bool holds = found.tau.any() && std::abs(found.early) < kHeldInput;
  if (holds) follow_clock(trace_.velocity, 0, -found.early, low_pass_.resticks);
}

}  // namespace tribofit::kinematics
