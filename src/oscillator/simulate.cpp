#include "tribofit/oscillator/simulate.hpp"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>

#include "find_zero.hpp"
#include "normal_stream.hpp"
#include "simulation_checks.hpp"
#include "slip_flow.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

class Simulation {
 public:
  Simulation(const Rig& rig, const Drive& drive, const FrictionModel& model, std::span<const double> p,
             const SimulationOptions& options);
  SimulatedMotion run();

 private:
  using Stepper = boost::numeric::odeint::runge_kutta_dopri5<BlockState>;

  void begin_in_slip(int direction);
  void advance(double until);
  void stick(double until);
  void slip(double until);
  bool try_step(double h);
  double land_on_zero_speed(double h);
  void end_slip();
  void count_step();
  void turn_round();
  void confirm_creeping_slip(double restick_time);
  void note_extremes(double h);
  void watch_creep(double h);
  void end_creeping_slip(double restick_time);

  double spring_pull(double x, double t) const;
  double gap_to_break_away(double t);
  double stuck_position(double t) const { return stick_position_ + setup_.disc_travel(t) - stick_travel_; }
  void begin_stick();
  void break_away();
  BlockState dense(double t, double h) const;
  void reserve_samples();
  void sample_stick(double until);
  void sample_slip(double h);
  void write_sample(double t, double x, double v, double friction, bool sticks);

  const SimulationOptions options_;
  Setup setup_;
  FrictionDynamics friction_;
  SlipFlow flow_;
  CorrelatedStream scatter_;
  mutable Stepper stepper_;
  SimulatedMotion motion_;

  double time_ = 0;
  bool sticking_ = true;
  double slid_ = 0;        ///< up to the last event [m]
  double peak_speed_ = 0;  ///< since the slip began [m/s]
  std::size_t next_sample_ = 0, samples_ = 0, steps_ = 0;

  // In rigid stick.
  double stick_begin_ = 0, stick_position_ = 0, stick_travel_ = 0, march_ = 0;
  double earliest_break_away_ = -std::numeric_limits<double>::infinity();

  // In slip: the last accepted state with its derivative, and what try_step() made of it.
  BlockState state_{}, derivative_{}, next_state_{}, next_derivative_{};
  double step_ = 0, most_step_ = 0, absolute_tolerance_ = 0, scaled_error_ = 0;

  // Where the law acts in stick: from the last reversal.
  double reversal_time_ = 0, slid_at_reversal_ = 0, creep_end_ = 0, friction_at_creep_end_ = 0, least_slip_ = 0;
  double slow_again_ = kNaN;  ///< when |v_r| fell below half the disc's speed, where nothing but that ends a slip
};

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
  const double speed = drive.mean_load * p[0] / (rig.mass * setup_.natural_frequency);
  absolute_tolerance_ = 0.1 * options_.tolerance * speed;
  least_slip_ = 0.1 * drive.mean_load * p[0] / rig.stiffness;
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
  motion_.rate = options_.rate;
  motion_.settled = options_.settle > 0;
  motion_.radius = drive.radius;
  motion_.stated_speed = drive.speed.constant ? drive.speed.speed(0) : kNaN;
  motion_.mean_load = drive.mean_load;
  motion_.mean_temperature = drive.mean_temperature;
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
  while (time_ < until) sticking_ ? stick(until) : slip(until);
}

// ---- rigid stick

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
  const SlidingState<double> at = {.velocity = 0,
                                   .direction = direction,
                                   .acceleration = setup_.disc_acceleration(t),
                                   .time = std::max(t, 0.0),
                                   .angle = setup_.drive.speed.angle(t),
                                   .distance = t > 0 ? slid_ : 0,
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
                           .break_away_friction = std::abs(pull) / setup_.load(time_)});
  peak_speed_ = 0;
}

// ---- slip

/// Refuses what would take for ever: normal simulations need a few thousand steps a second, the stiffest bristles 2e5.
void Simulation::count_step() {
  constexpr double kMostSteps = 5e5, kMostStepsASecond = 3e5;
  if (static_cast<double>(++steps_) < kMostSteps + kMostStepsASecond * (time_ + options_.settle)) return;
  throw InputError("the simulation needs too many steps: after " + std::to_string(steps_) +
                       " it is at t = " + std::to_string(time_) + " s",
                   "check that load, mass, stiffness and damping fit together, and that the effects have plausible "
                   "parameters");
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
    throw InputError("the simulation does not get beyond t = " + std::to_string(time_) + " s",
                     "check that friction is finite and that its effects have plausible parameters");
  }
  return accepted;
}

/// The step, at most h, that ends at v_r = 0: Newton on the end of the step, guarded by bisection.
double Simulation::land_on_zero_speed(double h) {
  double low = 0, high = h;
  for (int i = 0; i < 60; ++i) {
    const double speed = flow_.slip_speed(time_ + h, next_state_);
    const double slope = flow_.direction() * (setup_.disc_acceleration(time_ + h) - next_derivative_[1]);
    (speed < 0 ? high : low) = h;
    double next = h - speed / slope;
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - h) <= 1e-16 * std::abs(time_) + 1e-14 * h || speed == 0) break;
    h = next;
    BlockState error;
    stepper_.do_step(std::cref(flow_), state_, derivative_, time_, next_state_, next_derivative_, h, error);
  }
  return h;
}

void Simulation::slip(double until) {
  flow_(state_, derivative_, time_);
  bool fresh = flow_.slip_speed(time_, state_) == 0;
  while (time_ < until && !sticking_) {
    double h = std::min(step_, until - time_);
    if (!try_step(h)) continue;
    const bool crosses = flow_.slip_speed(time_ + h, next_state_) < 0;
    if (crosses && fresh) {  // friction after break-away is above that before it: it does not slip yet
      end_slip();
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
    fresh = crosses;
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
  const bool has_memory = friction_.state_count() > 0;
  if (!has_memory && before >= 0 && after < 0) {
    slow_again_ = find_zero([&](double t) { return excess(t, dense(t, h)); }, time_, time_ + h, before, after);
  }
  const bool still_creeping = !has_memory || flow_.slid(time_, state_) - slid_at_reversal_ < least_slip_;
  if (!(before < 0 && after >= 0 && still_creeping)) return;
  if (!has_memory) slid_at_reversal_ = flow_.slid(time_, state_);
  creep_end_ = find_zero([&](double t) { return excess(t, dense(t, h)); }, time_, time_ + h, before, after);
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
                           .peak_speed = peak_speed_});
}

// ---- samples

/// State within the step of length h just made, by its fourth-order interpolant.
BlockState Simulation::dense(double t, double h) const {
  BlockState y{};
  stepper_.calc_state(t, y, state_, derivative_, time_, next_state_, next_derivative_, time_ + h);
  return y;
}

/// From here on samples are taken.
void Simulation::reserve_samples() {
  samples_ = static_cast<std::size_t>(std::llround(options_.duration * options_.rate));
  for (auto* channel :
       {&motion_.time, &motion_.displacement, &motion_.velocity, &motion_.acceleration, &motion_.relative_velocity,
        &motion_.friction, &motion_.disc_speed, &motion_.disc_angle, &motion_.distance}) {
    channel->reserve(samples_);
  }
  motion_.sticks.reserve(samples_);
}

void Simulation::sample_stick(double until) {
  for (; next_sample_ < samples_; ++next_sample_) {
    const double t = static_cast<double>(next_sample_) / options_.rate;
    if (t > until) return;
    const double x = stuck_position(t);
    write_sample(t, x, setup_.disc_velocity(t), spring_pull(x, t) / setup_.load(t), true);
    motion_.distance.push_back(slid_);
  }
}

void Simulation::sample_slip(double h) {
  for (; next_sample_ < samples_; ++next_sample_) {
    const double t = static_cast<double>(next_sample_) / options_.rate;
    if (t > time_ + h) return;
    const BlockState y = dense(t, h);
    write_sample(t, y[0] / setup_.natural_frequency, y[1], flow_.friction(t, y), false);
    motion_.distance.push_back(flow_.slid(t, y));
  }
}

void Simulation::write_sample(double t, double x, double v, double friction, bool sticks) {
  const Rig& rig = setup_.rig;
  const double load = setup_.load(t);
  motion_.time.push_back(t);
  motion_.displacement.push_back(x);
  motion_.velocity.push_back(v);
  motion_.acceleration.push_back((load * friction - rig.damping * v - rig.stiffness * x) / rig.mass);
  motion_.relative_velocity.push_back(sticks ? 0 : setup_.disc_velocity(t) - v);
  motion_.friction.push_back(friction);
  motion_.disc_speed.push_back(setup_.drive.speed.speed(t));
  motion_.disc_angle.push_back(setup_.drive.speed.angle(t));
  if (setup_.drive.load) motion_.load.push_back(load);
  if (setup_.drive.temperature) motion_.temperature.push_back(setup_.temperature(t));
  motion_.sticks.push_back(sticks || friction_.acts_in_stick() ? 1 : 0);
}

}  // namespace

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
  const double winding = disc > 0 ? 2 * p[0] * drive.mean_load / (rig.stiffness * disc) : 0;
  return 5 * winding + 10 * 2 * std::numbers::pi / rig.natural_frequency();
}

}  // namespace tribofit
