#include <algorithm>
#include <cmath>
#include <string>

#include "find_zero.hpp"
#include "simulation.hpp"
#include "tribofit/ingest/input_error.hpp"

// Rigid stick: the block moves with the disc until the spring pulls harder than static friction holds.

namespace tribofit {

void Simulation::begin_stick() {
  sticking_ = true;
  stick_begin_ = time_;
  stick_position_ = state_[0] / setup_.natural_frequency;
  stick_travel_ = setup_.disc_travel(time_);
  friction_.begin_stick(std::span<const double>(state_.data() + 2, friction_.state_count()));
}

/// Force that the contact must carry for the block to keep up with the disc [N].
double Simulation::spring_pull(double x, double t) const {
  const Rig& rig = setup_.rig;
  return rig.stiffness * x + rig.damping * setup_.disc_velocity(t) + rig.mass * setup_.disc_acceleration(t);
}

/// |pull| less the force of break-away [N]; leaves the law set up for a slip that begins at t.
double Simulation::gap_to_break_away(double t) {
  const double pull = spring_pull(stuck_position(t), t);
  const double stick_time = t - stick_begin_;
  const double direction = pull < 0 ? -1 : 1;
  friction_.begin_slip(stick_time, direction, scatter_.value());
  StrokesSoFar strokes;
  if (setup_.needs_strokes) {
    strokes = flow_.strokes();
    strokes.go(direction, slid_);
  }
  const SlidingState<double> at = {.velocity = 0,
                                   .direction = direction,
                                   .acceleration = setup_.disc_acceleration(t),
                                   .time = std::max(t, 0.0),
                                   .angle = setup_.drive.speed.angle(t),
                                   .distance = t > 0 ? slid_ : 0,
                                   .reversal_distance = strokes.gone(slid_),
                                   .earlier_strokes = strokes.earlier(),
                                   .stick_time = stick_time,
                                   .load = setup_.load(t),
                                   .mean_load = setup_.drive.mean_load,
                                   .temperature = setup_.temperature(t),
                                   .mean_temperature = setup_.drive.mean_temperature,
                                   .disc_speed = setup_.drive.speed.speed(t)};
  const double limit = at.load * friction_.break_away_friction(at);
  if (!(at.load > 0) || !std::isfinite(limit)) {
    throw InputError((at.load > 0 ? "friction is not finite at t = " : "the load is not positive at t = ") +
                         std::to_string(t) + " s",
                     "check the load, the parameters of the law and its effects");
  }
  std::span<double> memories(state_.data() + 2, friction_.state_count());
  friction_.states_at_break_away(memories);
  return std::abs(pull) - limit;
}

void Simulation::stick(double until) {
  const auto gap = [this](double t) { return gap_to_break_away(t); };
  double low = std::max(time_, earliest_break_away_);
  bool breaks = false;
  double end = until;
  if (low < until) {
    double at_low = gap(low);
    breaks = at_low >= 0;
    if (breaks) end = low;
    while (!breaks && low < until) {
      count_step();
      const double high = std::min(low + march_, until);
      const double at_high = gap(high);
      breaks = at_high >= 0;
      if (breaks) end = find_zero(gap, low, high, at_low, at_high);
      low = high;
      at_low = at_high;
    }
  }
  sample_stick(end);
  time_ = end;
  if (breaks) break_away();
}

void Simulation::break_away() {
  const double stick_time = time_ - stick_begin_;
  gap_to_break_away(time_);  // sets the law and its memories for this slip
  const double x = stuck_position(time_);
  const double pull = spring_pull(x, time_);
  const int direction = pull < 0 ? -1 : 1;
  state_[0] = setup_.natural_frequency * x;
  state_[1] = setup_.disc_velocity(time_);
  sticking_ = false;
  flow_.begin(time_, state_, direction, stick_time, slid_);
  step_ = 1e-3 * most_step_;
  motion_.slips.push_back({.break_away_time = time_,
                           .restick_time = kNaN,
                           .stick_time = stick_time,
                           .direction = direction,
                           .mu_s_offset = scatter_.value(),
                           .break_away_friction = std::abs(pull) / setup_.load(time_),
                           .earlier_strokes = earlier_strokes()});
  peak_speed_ = 0;
}

}  // namespace tribofit
