#include "tribofit/study/smoothed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "limits.hpp"
#include "oscillator/find_zero.hpp"
#include "oscillator/limits.hpp"
#include "oscillator/rodas.hpp"
#include "oscillator/simulation_checks.hpp"
#include "oscillator/slip_flow.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void check(const SmoothedLaw& law, const SmoothedOptions& options) {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0; };
  const auto not_negative = [](double x) { return std::isfinite(x) && x >= 0; };
  require(positive(law.mu_brk) && not_negative(law.mu_c), "mu_brk or mu_c is not positive",
          "give levels such as 0.6 and 0.1");
  require(not_negative(law.decay), "the decay factor of the law is negative", "give e.g. 0.05 s/mm");
  require(positive(law.sharpness), "the sharpness of the smoothed law is not positive", "give e.g. 500 s/mm");
  require(std::isfinite(law.viscous), "the viscous term of the law is not finite", "give zero or e.g. 0.001 s/mm");
  require(positive(options.tolerance), "the tolerance is not positive", "1e-9 is usual");
  require(options.stick_share >= 0 && options.stick_share < 1, "the share that counts as stuck is not within 0 and 1",
          "give e.g. 0.05, or 0 for the crest of the law");
}

/// One run of simulate_smoothed(): steps, and the events and samples within each.
class SmoothedSimulation {
 public:
  SmoothedSimulation(const Rig& rig, const Drive& drive, const SmoothedLaw& law, const SmoothedOptions& options)
      : law_(law),
        options_(options),
        crest_(law.crest()),
        setup_(rig, drive, FrictionModel(ExponentialLaw{})),
        // Speeds of a slip are about that of the block when the drop of friction is let go.
        absolute_tolerance_(0.1 * options.tolerance * drive.mean_load * law.mu_brk /
                            (rig.mass * rig.natural_frequency())),
        most_step_(2 * std::numbers::pi / rig.natural_frequency() / 8),
        state_{setup_.natural_frequency * options.start.displacement, options.start.velocity},
        time_(-options.settle),
        next_step_(kFirstStep * most_step_) {
    const double gap = relative_velocity(time_, state_);
    if (std::abs(gap) > threshold(time_)) begin_slip(kNaN, gap < 0 ? -1 : 1);
    stick_begin_ = time_;
    state_conditions(setup_, options.rate, options.settle > 0, motion_);
  }

  SimulatedMotion run() {
    if (options_.settle > 0) advance(0);
    slid_ = 0;
    last_lag_ = lag(0, state_);
    samples_ = static_cast<std::size_t>(std::llround(options_.duration * options_.rate));
    if (samples_ > 0) {
      write_sample(0, state_);
      next_sample_ = 1;
    }
    advance(options_.duration);
    if (slipping_) motion_.slips.back().peak_speed = peak_speed_;
    std::erase_if(motion_.slips, [](const SimulatedSlip& slip) { return slip.restick_time <= 0; });
    return std::move(motion_);
  }

 private:
  using Step = oscillator::RodasStep<double, 2>;
  using State = Step::State;  ///< sqrt(k/m) x and x' [m/s both]

  double relative_velocity(double t, const State& y) const { return setup_.disc_velocity(t) - y[1]; }
  /// |v_r| up to which the block counts as stuck.
  double threshold(double t) const {
    const double disc = std::abs(setup_.disc_velocity(t));
    return options_.stick_share > 0 ? options_.stick_share * disc : std::min(crest_, 0.5 * disc);
  }
  double acceleration(double t, const State& y) const {
    return (setup_.load(t) * law_.friction(relative_velocity(t, y)) - setup_.rig.damping * y[1]) / setup_.rig.mass -
           setup_.natural_frequency * y[0];
  }
  /// dN/dt by a central difference over a small part of a period [N/s].
  double load_rate(double t) const {
    if (!setup_.drive.load) return 0;
    const double h = 1e-4 / setup_.natural_frequency;
    return (setup_.drive.load(t + h) - setup_.drive.load(t - h)) / (2 * h);
  }
  /// Way of the disc less that of the block.
  double lag(double t, const State& y) const { return setup_.disc_travel(t) - y[0] / setup_.natural_frequency; }
  /// Within the step just made.
  State state_at(double t) const { return t < time_ ? step_.at((t - begin_) / (time_ - begin_)) : state_; }

  void advance(double until) {
    const double least = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(until), most_step_);
    while (time_ < until) {
      if (!resolves_creep()) give_up("doubles do not resolve the creep of so sharp a law");
      const double periods = setup_.natural_frequency / (2 * std::numbers::pi) * (time_ + options_.settle);
      if (++steps_ > static_cast<std::size_t>(kFirstSteps + kStepsAPeriod * periods)) give_up("too many steps");
      const double h = std::min(next_step_, until - time_), error = try_step(h);
      const double change = oscillator::next_step_over_this(error);
      // A step cut short by the end says nothing of longer ones.
      const bool was_cut = error <= 1 && h < next_step_;
      next_step_ = std::min(most_step_, was_cut ? std::max(next_step_, change * h) : change * h);
      if (!(error <= 1)) {
        if (next_step_ < least) give_up("the error stays too large down to steps of " + general(next_step_, 2) + " s");
        continue;
      }
      begin_ = std::exchange(time_, until - time_ - h <= least ? until : time_ + h);
      state_ = step_.after;
      find_events();
      sample();
    }
  }

  /// A step of length h from the present state; root mean square of its error over what is allowed.
  double try_step(double h) {
    const double frequency = setup_.natural_frequency, mass = setup_.rig.mass;
    const double v = relative_velocity(time_, state_), slope = setup_.load(time_) * law_.slope(v);
    const double by_time = (slope * setup_.disc_acceleration(time_) + load_rate(time_) * law_.friction(v)) / mass;
    const auto rates = [&](std::size_t stage, const State& y) -> State {
      const double t = time_ + Step::place[stage] * h;
      return {frequency * y[1], acceleration(t, y) + Step::by_time[stage] * h * by_time};
    };
    // I/(gamma h) - df/dy = ((d, -frequency), (frequency, d + damped)).
    const double d = 1 / (Step::gamma * h), damped = (slope + setup_.rig.damping) / mass;
    const double determinant = d * (d + damped) + frequency * frequency;
    const auto solve = [&](const State& r) -> State {
      return {((d + damped) * r[0] + frequency * r[1]) / determinant, (d * r[1] - frequency * r[0]) / determinant};
    };
    step_.take(state_, h, rates(0, state_), rates, solve);
    double squares = 0;
    for (std::size_t k = 0; k < state_.size(); ++k) {
      const double size = std::max(std::abs(state_[k]), std::abs(step_.after[k]));
      squares += std::pow(step_.error()[k] / (absolute_tolerance_ + options_.tolerance * size), 2) / 2;
    }
    return std::sqrt(squares);
  }

  /// v_r of a stick is the small difference of two speeds; its rounding must not move the friction.
  bool resolves_creep() const {
    const double rounding = std::numeric_limits<double>::epsilon() * std::abs(setup_.disc_velocity(time_));
    return 2 / std::numbers::pi * law_.sharpness * rounding <= kMostRounding;
  }

  [[noreturn]] void give_up(const std::string& reason) const {
    throw InputError(
        fmt::format("the smoothed law cannot be integrated beyond t = {} s: {}; v_r = {} mm/s after {} steps",
                    general(time_), reason, general(1e3 * relative_velocity(time_, state_), 3), steps_),
        "lower the sharpness, or use the law with located events");
  }

  /// Where a value changes its sign within the step just made.
  template <class Value>
  std::optional<double> crossing(Value&& value) const {
    const double at_begin = value(begin_, step_.before), at_end = value(time_, state_);
    if (!(at_begin * at_end < 0)) return std::nullopt;
    return find_zero([&](double t) { return value(t, state_at(t)); }, begin_, time_, at_begin, at_end);
  }

  /// Events within the step just made.
  void find_events() {
    const auto speed = [this](double t, const State& y) { return std::abs(relative_velocity(t, y)); };
    if (const auto t = crossing([](double, const State& y) { return y[1]; }); t && *t >= 0) {
      motion_.turning_points.push_back({*t, state_at(*t)[0] / setup_.natural_frequency, step_.before[1] > 0});
    }
    if (slipping_) {
      const auto gain = [this](double t, const State& y) { return setup_.disc_acceleration(t) - acceleration(t, y); };
      peak_speed_ = std::max({peak_speed_, speed(begin_, step_.before), speed(time_, state_)});
      if (const auto t = crossing(gain)) peak_speed_ = std::max(peak_speed_, speed(*t, state_at(*t)));
    }
    if (const auto t = crossing([&](double at, const State& y) { return speed(at, y) - threshold(at); })) {
      slipping_ ? end_slip(*t) : begin_slip(*t, relative_velocity(time_, state_) < 0 ? -1 : 1);
    }
  }

  void begin_slip(double t, int direction) {
    slipping_ = true;
    peak_speed_ = 0;
    SimulatedSlip slip{.break_away_time = t, .restick_time = kNaN, .direction = direction};
    if (!std::isnan(t)) {
      slip.stick_time = t - stick_begin_;
      slip.break_away_friction = std::abs(law_.friction(relative_velocity(t, state_at(t))));
    }
    motion_.slips.push_back(std::move(slip));
  }

  void end_slip(double t) {
    slipping_ = false;
    stick_begin_ = t;
    motion_.slips.back().restick_time = t;
    motion_.slips.back().peak_speed = peak_speed_;
  }

  /// Adds what was slid since the last call; v_r keeps its sign in between, but for the creep of a stick.
  void slide(double t, const State& y) {
    const double now = lag(t, y);
    slid_ += std::abs(now - std::exchange(last_lag_, now));
  }

  /// Samples within the step just made.
  void sample() {
    for (; next_sample_ < samples_; ++next_sample_) {
      const double t = static_cast<double>(next_sample_) / options_.rate;
      if (t > time_) break;
      const State y = state_at(t);
      slide(t, y);
      write_sample(t, y);
    }
    slide(time_, state_);
  }

  void write_sample(double t, const State& y) {
    const double v = relative_velocity(t, y);
    motion_.time.push_back(t);
    motion_.displacement.push_back(y[0] / setup_.natural_frequency);
    motion_.velocity.push_back(y[1]);
    motion_.acceleration.push_back(acceleration(t, y));
    motion_.relative_velocity.push_back(v);
    motion_.friction.push_back(law_.friction(v));
    motion_.distance.push_back(slid_);
    motion_.sticks.push_back(std::abs(v) <= threshold(t) ? 1 : 0);
    write_conditions(setup_, t, true, motion_);
  }

  const SmoothedLaw law_;
  const SmoothedOptions options_;
  const double crest_;
  Setup setup_;
  const double absolute_tolerance_, most_step_;
  bool slipping_ = false;
  double stick_begin_ = 0, peak_speed_ = 0, slid_ = 0, last_lag_ = 0;
  std::size_t next_sample_ = 0, samples_ = 0, steps_ = 0;
  SimulatedMotion motion_;
  State state_;
  double begin_ = 0, time_ = 0;  ///< of the step just made, and its end
  double next_step_;
  Step step_;
};

}  // namespace

double SmoothedLaw::friction(double relative_velocity) const {
  const double arctangent = 2 / std::numbers::pi * std::atan(sharpness * relative_velocity);
  const double drop = (mu_brk - mu_c) * std::exp(-decay * std::abs(relative_velocity));
  const double kinetic = reading == ArctangentReading::smooth ? mu_c * arctangent : mu_c;
  return kinetic + drop * arctangent + viscous * relative_velocity;
}

double SmoothedLaw::slope(double relative_velocity) const {
  const double reduced = sharpness * relative_velocity;
  const double arctangent = 2 / std::numbers::pi * std::atan(reduced);
  const double rise = 2 / std::numbers::pi * sharpness / (1 + reduced * reduced);
  const double drop = (mu_brk - mu_c) * std::exp(-decay * std::abs(relative_velocity));
  const double kinetic = reading == ArctangentReading::smooth ? mu_c * rise : 0;
  return kinetic + drop * (rise - decay * std::abs(arctangent)) + viscous;
}

double SmoothedLaw::crest() const {
  // The arctangent has done its work at a few 1/s; within the decay of the exponential friction has fallen, or never
  // does.
  const double last = 100 / sharpness + (decay > 0 ? 100 / decay : 0);
  double low = 0, high = 0.01 / sharpness;
  while (slope(high) > 0) {
    if (high > last) return std::numeric_limits<double>::infinity();
    low = high;
    high *= 1.1;
  }
  for (int i = 0; i < 100 && high - low > 1e-15 * high; ++i) {
    const double middle = 0.5 * (low + high);
    (slope(middle) > 0 ? low : high) = middle;
  }
  return high;
}

SmoothedLaw smoothed_law(const FrictionModel& model, std::span<const double> p, double sharpness) {
  const std::string term = describe(effect_with(&EffectInfo::proportional_to_speed)).key;
  const std::size_t viscous = model.offset_of(term);
  const bool is_viscous = viscous < model.parameters().size();
  if (model.law() != Law(ExponentialLaw{}) || model.effects().size() != (is_viscous ? 1U : 0U)) {
    throw InputError(
        "the smoothed law is that of the exponential law, alone or with '" + term + "', not of " + model.name(),
        "take the exponential law, or leave the effects out");
  }
  SmoothedLaw made{.mu_brk = p[0], .mu_c = p[1], .decay = p[2], .sharpness = sharpness};
  if (is_viscous) made.viscous = p[viscous];
  return made;
}

SimulatedMotion simulate_smoothed(const Rig& rig, const Drive& drive, const SmoothedLaw& law,
                                  const SmoothedOptions& options) {
  check_rig_and_drive(rig, drive);
  check_record(options.duration, options.rate, options.settle, options.start);
  check(law, options);
  return SmoothedSimulation(rig, drive, law, options).run();
}

}  // namespace tribofit
