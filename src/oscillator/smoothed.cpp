#include "tribofit/oscillator/smoothed.hpp"
#include "limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>

#include "find_zero.hpp"
#include "simulation_checks.hpp"
#include "slip_flow.hpp"
#include "stiff_integrator.hpp"
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

class SmoothedSimulation {
 public:
  SmoothedSimulation(const Rig& rig, const Drive& drive, const SmoothedLaw& law, const SmoothedOptions& options);
  SimulatedMotion run();

 private:
  using State = StiffIntegrator::State;  ///< sqrt(k/m) x and x' [m/s both]

  StiffIntegrator::Problem problem();
  State initial_state() const;
  void advance(double until);
  void find_events(double begin, const State& before);
  void begin_slip(double t, int direction);
  void end_slip(double t);
  void sample(double until);
  void write_sample(double t, const State& y);
  bool resolves_creep() const;
  std::size_t most_steps() const;
  [[noreturn]] void give_up(const std::string& reason) const;

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
  double load_rate(double t) const;
  /// Adds what was slid since the last call; v_r keeps its sign in between, but for the creep of a stick.
  void slide(double t, const State& y);

  const SmoothedLaw law_;
  const SmoothedOptions options_;
  const double crest_;
  Setup setup_;
  bool slipping_ = false;
  double stick_begin_ = 0, peak_speed_ = 0, slid_ = 0, last_lag_ = 0;
  std::size_t next_sample_ = 0, samples_ = 0, steps_ = 0;
  SimulatedMotion motion_;
  StiffIntegrator integrator_;
};

SmoothedSimulation::SmoothedSimulation(const Rig& rig, const Drive& drive, const SmoothedLaw& law,
                                       const SmoothedOptions& options)
    : law_(law),
      options_(options),
      crest_(law.crest()),
      setup_(rig, drive, FrictionModel(ExponentialLaw{})),
      integrator_(problem(), 0 - options.settle, initial_state(),
                  {.relative_tolerance = options.tolerance,
                   // Speeds of a slip are about that of the block when the drop of friction is let go.
                   .absolute_tolerance =
                       0.1 * options.tolerance * drive.mean_load * law.mu_brk / (rig.mass * rig.natural_frequency()),
                   .max_step = 2 * std::numbers::pi / rig.natural_frequency() / 8}) {
  const double begin = -options.settle;
  const double gap = relative_velocity(begin, integrator_.state());
  if (std::abs(gap) > threshold(begin)) begin_slip(kNaN, gap < 0 ? -1 : 1);
  stick_begin_ = begin;
  motion_.rate = options.rate;
  motion_.settled = options.settle > 0;
  motion_.radius = drive.radius;
  motion_.stated_speed = drive.speed.constant ? drive.speed.speed(0) : kNaN;
  motion_.mean_load = drive.mean_load;
  motion_.mean_temperature = drive.mean_temperature;
}

SmoothedSimulation::State SmoothedSimulation::initial_state() const {
  return {setup_.natural_frequency * options_.start.displacement, options_.start.velocity};
}

StiffIntegrator::Problem SmoothedSimulation::problem() {
  return {.rates = [this](double t, const State& y) -> State {
            return {setup_.natural_frequency * y[1], acceleration(t, y)};
          },
          .derivatives = [this](double t, const State& y) -> StiffIntegrator::Derivatives {
            const double frequency = setup_.natural_frequency, mass = setup_.rig.mass;
            const double v = relative_velocity(t, y), slope = setup_.load(t) * law_.slope(v);
            const double by_time = slope * setup_.disc_acceleration(t) + load_rate(t) * law_.friction(v);
            return {.by_state = {{{0, frequency}, {-frequency, -(slope + setup_.rig.damping) / mass}}},
                    .by_time = {0, by_time / mass}};
          }};
}

/// dN/dt by a central difference over a small part of a period [N/s].
double SmoothedSimulation::load_rate(double t) const {
  if (!setup_.drive.load) return 0;
  const double h = 1e-4 / setup_.natural_frequency;
  return (setup_.drive.load(t + h) - setup_.drive.load(t - h)) / (2 * h);
}

SimulatedMotion SmoothedSimulation::run() {
  if (options_.settle > 0) advance(0);
  slid_ = 0;
  last_lag_ = setup_.disc_travel(0) - integrator_.state()[0] / setup_.natural_frequency;
  samples_ = static_cast<std::size_t>(std::llround(options_.duration * options_.rate));
  if (samples_ > 0) {
    write_sample(0, integrator_.state());
    next_sample_ = 1;
  }
  advance(options_.duration);
  if (slipping_) motion_.slips.back().peak_speed = peak_speed_;
  std::erase_if(motion_.slips, [](const SimulatedSlip& slip) { return slip.restick_time <= 0; });
  return std::move(motion_);
}

void SmoothedSimulation::advance(double until) {
  while (integrator_.time() < until) {
    const double begin = integrator_.time();
    const State before = integrator_.state();
    if (!resolves_creep()) give_up("doubles do not resolve the creep of so sharp a law");
    if (!integrator_.step(until)) give_up(integrator_.failure());
    if (++steps_ > most_steps()) give_up("too many steps");
    find_events(begin, before);
    sample(integrator_.time());
  }
}

/// v_r of a stick is the small difference of two speeds; its rounding must not move the friction.
bool SmoothedSimulation::resolves_creep() const {
  const double rounding = std::numeric_limits<double>::epsilon() * std::abs(setup_.disc_velocity(integrator_.time()));
  return 2 / std::numbers::pi * law_.sharpness * rounding <= kMostRounding;
}

std::size_t SmoothedSimulation::most_steps() const {
  const double periods = setup_.natural_frequency / (2 * std::numbers::pi) * (integrator_.time() + options_.settle);
  return static_cast<std::size_t>(kFirstStiffSteps + kStiffStepsAPeriod * periods);
}

void SmoothedSimulation::give_up(const std::string& reason) const {
  const double t = integrator_.time();
  throw InputError(
      fmt::format("the smoothed law cannot be integrated beyond t = {} s: {}; v_r = {} mm/s after "
                  "{} steps",
                  general(t, 6), reason, general(1e3 * relative_velocity(t, integrator_.state()), 3), steps_),
      "lower the sharpness, or use the law with located events");
}

/// Events within the step just made, which began at `begin` in the state `before`.
void SmoothedSimulation::find_events(double begin, const State& before) {
  const double end = integrator_.time();
  const State& after = integrator_.state();
  const auto crossing = [&](auto&& value) -> std::optional<double> {
    const double at_begin = value(begin, before), at_end = value(end, after);
    if (!(at_begin * at_end < 0)) return std::nullopt;
    return find_zero([&](double t) { return value(t, integrator_.at(t)); }, begin, end, at_begin, at_end);
  };
  const auto speed = [this](double t, const State& y) { return std::abs(relative_velocity(t, y)); };

  if (const auto t = crossing([](double, const State& y) { return y[1]; }); t && *t >= 0) {
    motion_.turning_points.push_back({*t, integrator_.at(*t)[0] / setup_.natural_frequency, before[1] > 0});
  }
  if (slipping_) {
    const auto gain = [this](double t, const State& y) { return setup_.disc_acceleration(t) - acceleration(t, y); };
    peak_speed_ = std::max({peak_speed_, speed(begin, before), speed(end, after)});
    if (const auto t = crossing(gain)) peak_speed_ = std::max(peak_speed_, speed(*t, integrator_.at(*t)));
  }
  const auto excess = [&](double t, const State& y) { return speed(t, y) - threshold(t); };
  if (const auto t = crossing(excess)) {
    slipping_ ? end_slip(*t) : begin_slip(*t, relative_velocity(end, after) < 0 ? -1 : 1);
  }
}

void SmoothedSimulation::begin_slip(double t, int direction) {
  slipping_ = true;
  peak_speed_ = 0;
  const bool begins_so = std::isnan(t);
  const double friction = begins_so ? 0 : std::abs(law_.friction(relative_velocity(t, integrator_.at(t))));
  motion_.slips.push_back({.break_away_time = t,
                           .restick_time = kNaN,
                           .stick_time = begins_so ? 0 : t - stick_begin_,
                           .direction = direction,
                           .break_away_friction = friction});
}

void SmoothedSimulation::end_slip(double t) {
  slipping_ = false;
  stick_begin_ = t;
  motion_.slips.back().restick_time = t;
  motion_.slips.back().peak_speed = peak_speed_;
}

void SmoothedSimulation::slide(double t, const State& y) {
  const double lag = setup_.disc_travel(t) - y[0] / setup_.natural_frequency;
  slid_ += std::abs(lag - last_lag_);
  last_lag_ = lag;
}

/// Samples within the step just made.
void SmoothedSimulation::sample(double until) {
  for (; next_sample_ < samples_; ++next_sample_) {
    const double t = static_cast<double>(next_sample_) / options_.rate;
    if (t > until) break;
    const State y = integrator_.at(t);
    slide(t, y);
    write_sample(t, y);
  }
  slide(until, integrator_.state());
}

void SmoothedSimulation::write_sample(double t, const State& y) {
  const double v = relative_velocity(t, y);
  motion_.time.push_back(t);
  motion_.displacement.push_back(y[0] / setup_.natural_frequency);
  motion_.velocity.push_back(y[1]);
  motion_.acceleration.push_back(acceleration(t, y));
  motion_.relative_velocity.push_back(v);
  motion_.friction.push_back(law_.friction(v));
  motion_.disc_speed.push_back(setup_.disc_speed(t));
  motion_.disc_angle.push_back(setup_.drive.speed.angle(t));
  motion_.distance.push_back(slid_);
  if (setup_.drive.load) motion_.load.push_back(setup_.load(t));
  if (setup_.drive.temperature) motion_.temperature.push_back(setup_.temperature(t));
  motion_.sticks.push_back(std::abs(v) <= threshold(t) ? 1 : 0);
}

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
