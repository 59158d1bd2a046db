#include "tribofit/oscillator/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "find_zero.hpp"
#include "simulation.hpp"
#include "simulation_checks.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

/// Normal force as the drive begins [N], which scales the motion; N0 is what parameters refer to.
double load_at_start(const Drive& drive) {
  return drive.load ? drive.load(0) : drive.mean_load;
}

}  // namespace

Simulation::Simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                       const SimulationOptions& options)
    : options_((check_simulation(rig, drive, model, p, options), options)),
      setup_(rig, true_drive(drive, model, p), model),
      friction_(model, {p.begin(), p.end()}),
      flow_(setup_, friction_),
      scatter_(options.scatter.deviation, options.scatter.wander, options.seed, NormalStream::Purpose::scatter) {
  const double period = 2 * std::numbers::pi / setup_.natural_frequency;
  most_step_ = options_.max_step > 0 ? options_.max_step : period / 8;
  march_ = period / 16;
  // Speeds of a slip are about that of the block when the drop of friction is let go.
  const double speed = load_at_start(drive) * p[0] / (rig.mass * setup_.natural_frequency);
  absolute_tolerance_ = 0.1 * options_.tolerance * speed;
  least_slip_ = 0.1 * load_at_start(drive) * p[0] / rig.stiffness;
  time_ = -options_.settle;
  state_[1] = setup_.disc_velocity(time_);
  if (options_.start) {
    state_[0] = setup_.natural_frequency * options_.start->displacement;
    state_[1] = options_.start->velocity;
  }
  const double gap = setup_.disc_velocity(time_) - state_[1];
  if (friction_.acts_in_stick() || gap != 0) {
    begin_in_slip(gap < 0 ? -1 : 1);
  } else {
    begin_stick();
  }
  state_conditions(Setup(rig, drive, model), options_.rate, options_.settle > 0, motion_);
}

/// Starts moving, or creeping, in the direction of v_r given.
void Simulation::begin_in_slip(int direction) {
  sticking_ = false;
  friction_.begin_slip(0, direction, scatter_.value());
  flow_.begin(time_, state_, direction, 0, 0);
  step_ = most_step_ * 1e-3;
  reversal_time_ = creep_end_ = time_;
  if (options_.start && flow_.slip_speed(time_, state_) > 0) flow_.steady_memories(time_, state_);
  if (friction_.acts_in_stick()) return;
  motion_.slips.push_back({.break_away_time = kNaN, .restick_time = kNaN, .direction = direction});
}

SimulatedMotion Simulation::run() {
  if (time_ < 0) {
    advance(0);
    // Distances count from here.
    flow_.count_strokes_from(sticking_ ? slid_ : flow_.slid(0, state_));
    if (!sticking_) {
      slid_at_reversal_ -= flow_.slid(0, state_);
      flow_.begin(0, state_, flow_.direction(), flow_.stick_time(), 0);
    }
    slid_ = 0;
  }
  reserve_samples();
  advance(options_.duration);
  if (friction_.acts_in_stick()) {
    confirm_creeping_slip(kNaN);
    std::size_t i = 0;
    for (const SimulatedSlip& slip : motion_.slips) {
      for (; i < motion_.size() && motion_.time[i] < slip.break_away_time; ++i) motion_.sticks[i] = 1;
      for (; i < motion_.size() && !(motion_.time[i] >= slip.restick_time); ++i) motion_.sticks[i] = 0;
    }
  }
  if (!friction_.acts_in_stick() && !sticking_) motion_.slips.back().peak_speed = peak_speed_;
  std::erase_if(motion_.slips, [](const SimulatedSlip& slip) { return slip.restick_time <= 0; });
  return std::move(motion_);
}

void Simulation::advance(double until) {
  while (time_ < until) {
    stop_point();
    sticking_ ? stick(until) : slip(until);
  }
}

// Rigid stick: the block moves with the disc until the spring pulls harder than static friction holds.

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
  SlidingState<double> at = surroundings(setup_, t, direction, stick_time, slid_, strokes);
  at.acceleration = setup_.disc_acceleration(t);
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

// Samples.

void Simulation::reserve_samples() {
  samples_ = static_cast<std::size_t>(std::llround(options_.duration * options_.rate));
  for (auto* channel : {&motion_.time, &motion_.velocity, &motion_.friction}) channel->reserve(samples_);
  const SimulatedChannels& kept = options_.channels;
  if (kept.relative_velocity) motion_.relative_velocity.reserve(samples_);
  if (kept.displacement) motion_.displacement.reserve(samples_);
  if (kept.acceleration) motion_.acceleration.reserve(samples_);
  if (kept.disc) motion_.disc_speed.reserve(samples_), motion_.disc_angle.reserve(samples_);
  if (kept.distance) motion_.distance.reserve(samples_);
  motion_.sticks.reserve(samples_);
}

void Simulation::sample_stick(double until) {
  for (; next_sample_ < samples_; ++next_sample_) {
    const double t = static_cast<double>(next_sample_) / options_.rate;
    if (t > until) return;
    const double x = stuck_position(t);
    write_sample(t, x, setup_.disc_velocity(t), spring_pull(x, t) / setup_.load(t), true);
    write_distance(slid_);
  }
}

void Simulation::sample_slip(double h) {
  for (; next_sample_ < samples_; ++next_sample_) {
    const double t = static_cast<double>(next_sample_) / options_.rate;
    if (t > time_ + h) return;
    const BlockState y = dense(t, h);
    write_sample(t, y[0] / setup_.natural_frequency, y[1], flow_.friction(t, y), false);
    write_distance(flow_.slid(t, y));
  }
}

void Simulation::write_distance(double slid) {
  if (options_.channels.distance) motion_.distance.push_back(slid);
  if (setup_.needs_strokes) motion_.reversal_distance.push_back(flow_.strokes().gone(slid));
}

void Simulation::write_sample(double t, double x, double v, double friction, bool sticks) {
  const Rig& rig = setup_.rig;
  const double load = setup_.load(t);
  motion_.time.push_back(t);
  const SimulatedChannels& kept = options_.channels;
  if (kept.displacement) motion_.displacement.push_back(x);
  motion_.velocity.push_back(v);
  if (kept.acceleration)
    motion_.acceleration.push_back((load * friction - rig.damping * v - rig.stiffness * x) / rig.mass);
  if (kept.relative_velocity) motion_.relative_velocity.push_back(sticks ? 0 : setup_.disc_velocity(t) - v);
  motion_.friction.push_back(friction);
  write_conditions(setup_, t, kept.disc, motion_);
  motion_.sticks.push_back(sticks || friction_.acts_in_stick() ? 1 : 0);
}

std::size_t SimulatedMotion::break_away_count() const {
  return static_cast<std::size_t>(
      std::count_if(slips.begin(), slips.end(), [](const SimulatedSlip& s) { return s.break_away_time >= 0; }));
}

SimulatedMotion simulate(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
                         const SimulationOptions& options) {
  return Simulation(rig, drive, model, p, options).run();
}

double settling_time(const Rig& rig, const Drive& drive, std::span<const double> p) {
  const double disc = std::abs(drive.radius * drive.speed.speed(0));
  const double winding = disc > 0 ? 2 * p[0] * load_at_start(drive) / (rig.stiffness * disc) : 0;
  return 5 * winding + 10 * 2 * std::numbers::pi / rig.natural_frequency();
}

}  // namespace tribofit
