#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "find_zero.hpp"
#include "limits.hpp"
#include "simulation.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

// Slip: steps with error control that end where v_r is zero; and the slips of a law that acts in stick.

namespace tribofit {

/// Refuses what would take for ever.
void Simulation::count_step() {
  const double periods = setup_.natural_frequency / (2 * std::numbers::pi) * (time_ + options_.settle);
  if (static_cast<double>(++steps_) < std::min(kMostSteps, kFirstSteps + kStepsAPeriod * periods)) return;
  const Rig& rig = setup_.rig;
  throw InputError(
      fmt::format("the simulation needs too many steps: {} of them lead from t = {} to {} s of {} s, with a "
                  "mass of {} kg, a stiffness of {} N/m, a damping of {} N s/m, a load of {} N and {} m/s "
                  "under the block",
                  general(static_cast<double>(steps_)), general(-options_.settle), general(time_),
                  general(options_.duration), general(rig.mass), general(rig.stiffness), general(rig.damping),
                  general(setup_.load(time_)), general(setup_.disc_velocity(time_))),
      "check that these fit together, and that the effects have plausible parameters");
}

/// One step of length h from state_; false (and a shorter step_) when its error is too large.
bool Simulation::try_step(double h) {
  count_step();
  BlockState error;
  stepper_.do_step(std::cref(flow_), state_, derivative_, time_, next_state_, next_derivative_, h, error);
  scaled_error_ = 0;
  for (std::size_t k = 0; k < 2 + friction_.state_count(); ++k) {
    const double size = std::max(std::abs(state_[k]), std::abs(next_state_[k]));
    const double ratio = std::abs(error[k]) / (absolute_tolerance_ + options_.tolerance * size);
    if (!(ratio <= scaled_error_)) scaled_error_ = ratio;  // keeps a NaN
  }
  constexpr double kSafety = 0.9, kLeastChange = 0.2, kMostChange = 5;
  const double change = scaled_error_ > 0 ? kSafety * std::pow(scaled_error_, -0.2) : kMostChange;
  const bool accepted = scaled_error_ <= 1;
  if (!std::isfinite(scaled_error_)) {
    step_ = kLeastChange * h;
  } else if (!accepted || h >= step_) {  // a step cut short by the end of the record says nothing of longer ones
    step_ = std::min(most_step_, h * std::clamp(change, kLeastChange, kMostChange));
  }
  const bool advances = step_ > 1e-15 * std::max(1.0, std::abs(time_));
  if (!accepted && !advances) {
    throw InputError("the simulation does not get beyond t = " + general(time_) + " s",
                     "check that friction is finite and that its effects have plausible parameters");
  }
  return accepted;
}

/// The step, at most h, that ends at v_r = 0: Newton on the end of the step, guarded by bisection. A contact that
/// creeps in stick trembles about it, hardly faster than rounding: what is nothing beside the disc is zero.
double Simulation::land_on_zero_speed(double h) {
  const double nothing = 1e-13 * std::max(std::abs(setup_.disc_velocity(time_)), peak_speed_);
  double low = 0, high = h;
  for (int i = 0; i < 60; ++i) {
    const double speed = flow_.slip_speed(time_ + h, next_state_);
    if (std::abs(speed) <= nothing) break;
    const double slope = flow_.direction() * (setup_.disc_acceleration(time_ + h) - next_derivative_[1]);
    (speed < 0 ? high : low) = h;
    double next = h - speed / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - h) <= 1e-16 * std::abs(time_) + 1e-14 * h) break;
    h = next;
    BlockState error;
    stepper_.do_step(std::cref(flow_), state_, derivative_, time_, next_state_, next_derivative_, h, error);
  }
  return h;
}

void Simulation::slip(double until) {
  flow_(state_, derivative_, time_);
  bool fresh = flow_.slip_speed(time_, state_) == 0, turned = false;
  while (time_ < until && !sticking_) {
    double h = std::min(step_, until - time_);
    if (!try_step(h)) continue;
    bool crosses = flow_.slip_speed(time_ + h, next_state_) < 0;
    const bool rests = crosses && turned;  // it moves against either direction: by rounding alone
    if (rests) {
      next_state_[1] = setup_.disc_velocity(time_ + h);
      crosses = false;
    } else if (crosses && fresh) {  // friction after break-away is above that before it: it does not slip yet
      end_slip();
      turned = friction_.acts_in_stick();
      fresh = flow_.slip_speed(time_, state_) == 0 && !fresh;
      continue;
    }
    if (crosses) h = land_on_zero_speed(h);
    note_extremes(h);
    sample_slip(h);
    if (friction_.acts_in_stick()) watch_creep(h);
    time_ = until - time_ - h <= 0 ? until : time_ + h;
    state_ = next_state_;
    derivative_ = next_derivative_;
    fresh = crosses || rests;
    turned = false;
    if (!std::isnan(slow_again_)) end_creeping_slip(slow_again_);
    if (crosses) {
      state_[1] = setup_.disc_velocity(time_);
      end_slip();
    }
  }
}

/// Turning points and the largest speed within the step of length h just made.
void Simulation::note_extremes(double h) {
  if (time_ >= 0 && state_[1] * next_state_[1] < 0) {
    const auto velocity = [&](double t) { return dense(t, h)[1]; };
    const double t = find_zero(velocity, time_, time_ + h, state_[1], next_state_[1]);
    motion_.turning_points.push_back({t, dense(t, h)[0] / setup_.natural_frequency, state_[1] > 0});
  }
  const auto gain = [&](double t, const BlockState& dy) {  // of speed
    return flow_.direction() * (setup_.disc_acceleration(t) - dy[1]);
  };
  const double before = gain(time_, derivative_), after = gain(time_ + h, next_derivative_);
  double speed = flow_.slip_speed(time_ + h, next_state_);
  if (before > 0 && after < 0) {
    const auto inside = [&](double t) {
      BlockState dy;
      flow_(dense(t, h), dy, t);
      return gain(t, dy);
    };
    // Bracketed anew: the interpolant meets the ends of the step within its own error only.
    const double low = inside(time_), high = inside(time_ + h);
    const double t = low > 0 && high < 0 ? find_zero(inside, time_, time_ + h, low, high) : time_ + h;
    speed = std::max(speed, flow_.slip_speed(t, dense(t, h)));
  }
  peak_speed_ = std::max(peak_speed_, speed);
}

/// At v_r = 0: stick if the spring is within the static limit, else motion turns round.
void Simulation::end_slip() {
  slid_ = flow_.slid(time_, state_);
  if (friction_.acts_in_stick()) {
    turn_round();
    return;
  }
  SimulatedSlip& slip = motion_.slips.back();
  if (time_ <= slip.break_away_time) {  // it never moved: the stick goes on
    motion_.slips.pop_back();
    earliest_break_away_ = time_ + march_;
    sticking_ = true;
    return;
  }
  slip.restick_time = time_;
  slip.peak_speed = peak_speed_;
  scatter_.next();
  begin_stick();
}

/// State within the step of length h just made, by its fourth-order interpolant.
BlockState Simulation::dense(double t, double h) const {
  BlockState y{};
  stepper_.calc_state(t, y, state_, derivative_, time_, next_state_, next_derivative_, time_ + h);
  return y;
}

/// Where the law acts in stick nothing ends at v_r = 0 but the direction.
void Simulation::turn_round() {
  const double slipped = slid_ - slid_at_reversal_;
  confirm_creeping_slip(time_);
  const double direction = -flow_.direction();
  if (slipped > least_slip_) {
    scatter_.next();
    friction_.begin_slip(creep_end_ - reversal_time_, direction, scatter_.value());
    reversal_time_ = time_;
  }
  creep_end_ = time_;
  slid_at_reversal_ = slid_;
  peak_speed_ = 0;
  flow_.begin(time_, state_, direction, 0, slid_);
  flow_(state_, derivative_, time_);
}

/// Break-away of a creeping stick: where |v_r| last rises above half the disc's speed.
void Simulation::watch_creep(double h) {
  const auto excess = [&](double t, const BlockState& y) {
    return flow_.slip_speed(t, y) - 0.5 * std::abs(setup_.disc_velocity(t));
  };
  const double before = excess(time_, state_), after = excess(time_ + h, next_state_);
  const auto crossing = [&] {
    return find_zero([&](double t) { return excess(t, dense(t, h)); }, time_, time_ + h, before, after);
  };
  const bool has_memory = friction_.state_count() > 0;
  if (!has_memory && before >= 0 && after < 0) slow_again_ = crossing();
  const bool still_creeping = !has_memory || flow_.slid(time_, state_) - slid_at_reversal_ < least_slip_;
  if (!(before < 0 && after >= 0 && still_creeping)) return;
  if (!has_memory) slid_at_reversal_ = flow_.slid(time_, state_);
  creep_end_ = crossing();
  friction_at_creep_end_ = flow_.friction(creep_end_, dense(creep_end_, h));
}

/// A contact without memory need not turn round after a slip: it goes over into forward creep.
void Simulation::end_creeping_slip(double restick_time) {
  slow_again_ = kNaN;
  slid_ = flow_.slid(time_, state_);
  if (slid_ - slid_at_reversal_ <= least_slip_) return;
  confirm_creeping_slip(restick_time);
  scatter_.next();
  friction_.begin_slip(creep_end_ - reversal_time_, flow_.direction(), scatter_.value());
  reversal_time_ = creep_end_ = restick_time;
  slid_at_reversal_ = slid_;
  peak_speed_ = 0;
  flow_(state_, derivative_, time_);
}

/// Records the motion since the last reversal as a slip when it went far enough.
void Simulation::confirm_creeping_slip(double restick_time) {
  const double slid = std::isnan(restick_time) ? flow_.slid(time_, state_) : slid_;
  if (slid - slid_at_reversal_ <= least_slip_) return;
  motion_.slips.push_back({.break_away_time = creep_end_,
                           .restick_time = restick_time,
                           .stick_time = creep_end_ - reversal_time_,
                           .direction = flow_.direction() < 0 ? -1 : 1,
                           .mu_s_offset = scatter_.value(),
                           .break_away_friction = std::abs(friction_at_creep_end_),
                           .peak_speed = peak_speed_,
                           .earlier_strokes = earlier_strokes()});
}

}  // namespace tribofit
