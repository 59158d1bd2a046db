#include "tribofit/oscillator/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <utility>

#include "normal_stream.hpp"
#include "simulation_checks.hpp"
#include "statistics/low_pass.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {

namespace {

void check(const Sensors& sensors) {
  const auto not_negative = [](double value, const char* name, const char* unit = "") {
    require_not_negative(value, unit, name, "give zero (absent) or more");
  };
  not_negative(sensors.mass_below, "the mass below the force sensor", " kg");
  not_negative(sensors.force_bandwidth, "the bandwidth of the force sensor", " Hz");
  not_negative(sensors.velocity_high_pass, "the high-pass of the vibrometer", " Hz");
  not_negative(sensors.velocity_low_pass, "the low-pass of the vibrometer", " Hz");
  not_negative(sensors.friction_low_pass, "the low-pass of the friction channel", " Hz");
  not_negative(sensors.friction_noise, "the noise on mu");
  not_negative(sensors.velocity_noise, "the noise on the velocity", " m/s");
  not_negative(sensors.friction_resolution, "the resolution of mu");
  not_negative(sensors.velocity_resolution, "the resolution of the velocity", " m/s");
  require(sensors.force_damping > 0, "the damping of the force sensor is not positive", "0.7 is usual");
  require(std::isfinite(sensors.friction_delay), "the delay of the friction channel is not finite",
          "give it as e.g. 2ms");
  require(std::isfinite(sensors.velocity_gain) && sensors.velocity_gain != 0, "the gain of the vibrometer is zero",
          "1 is a perfect one");
  require(sensors.noise_colour >= 0 && sensors.noise_colour < 1,
          "the colour of the noise is not within 0 (included) and 1", "0 is white, 0.9 strongly coloured");
}

/// Samples [begin, end) as one slip, for hooks that work on a stretch of samples. velocity: v_r there.
Slip slip_of(const SimulatedMotion& motion, std::size_t begin, std::size_t end, std::span<const double> velocity) {
  const auto part = [&](const std::vector<double>& channel) { return part_of(channel, begin, end); };
  Slip slip;
  slip.time = part(motion.time);
  slip.velocity = velocity;
  slip.acceleration = part(motion.acceleration);
  slip.angle = part(motion.disc_angle);
  slip.distance = part(motion.distance);
  slip.reversal_distance = part(motion.reversal_distance);
  slip.load = part(motion.load);
  slip.temperature = part(motion.temperature);
  slip.mean_load = motion.mean_load;
  slip.mean_temperature = motion.mean_temperature;
  return slip;
}

/// First-order high-pass, exact for straight lines between samples. `drift`: its low-pass part at the first sample.
void high_pass(std::vector<double>& v, double rate, double corner, double drift) {
  if (v.empty()) return;
  const double a = 2 * std::numbers::pi * corner / rate;
  const double e = std::exp(-a), mean = -std::expm1(-a) / a;
  double before = v[0], y = v[0] - drift;
  v[0] = y;
  for (std::size_t i = 1; i < v.size(); ++i) {
    y = e * y + mean * (v[i] - before);
    before = v[i];
    v[i] = y;
  }
}

/// The full scale of the response is the largest of the record, on the side of `direction`.
void respond(std::vector<double>& x, StaticResponse response, double direction) {
  if (!response.any() || x.empty()) return;
  const Extremes range = extremes(x);
  response.full_scale = std::copysign(std::max(range.high, -range.low), direction);
  for (double& value : x) value = response.reading(value);
}

/// A channel that runs ahead by `drift` of the time, on straight lines between samples.
void run_ahead(std::vector<double>& x, double drift) {
  if (drift == 0 || x.size() < 2) return;
  const std::vector<double> read = x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = std::min(static_cast<double>(i) * (1 + drift), static_cast<double>(x.size() - 1));
    const std::size_t k = std::min(static_cast<std::size_t>(at), x.size() - 2);
    x[i] = read[k] + (at - static_cast<double>(k)) * (read[k + 1] - read[k]);
  }
}

/// kept: takes the noise, unless it is nullptr.
void add_noise(std::vector<double>& x, double deviation, const Sensors& sensors, NormalStream::Purpose purpose,
               std::vector<double>* kept) {
  if (deviation == 0) return;
  CorrelatedStream stream(deviation, sensors.noise_colour, sensors.seed, purpose);
  if (kept != nullptr) kept->reserve(x.size());
  for (double& value : x) {
    value += stream.value();
    if (kept != nullptr) kept->push_back(stream.value());
    stream.next();
  }
}

void round_to(std::vector<double>& x, double resolution) {
  if (resolution == 0) return;
  for (double& value : x) value = std::round(value / resolution) * resolution;
}

/// What the effect's sensor makes of a record.
template <class E>
void sense_record(const E& effect, const double* q, const SimulatedMotion& motion, const Slip& whole,
                  std::vector<double>& mu) {
  if constexpr (hooks::AddsToReading<E, double>) {
    auto next = motion.slips.begin();
    double last_break_away = std::numeric_limits<double>::quiet_NaN();
    double direction = 1;
    for (std::size_t i = 0; i < mu.size(); ++i) {
      for (; next != motion.slips.end() && next->break_away_time <= motion.time[i]; ++next) {
        if (next->stick_time > 0) last_break_away = next->break_away_time;
        direction = next->direction;
      }
      SlidingState<double> at = whole.at(i, motion.relative_velocity[i]);
      at.velocity = motion.relative_velocity[i];
      at.direction = direction;
      at.since_break_away = motion.time[i] - last_break_away;
      mu[i] = effect.add_to_reading(q, at, mu[i]);
    }
  }
  if constexpr (hooks::FiltersReading<E, double>) effect.filter_reading(q, whole, 0.0, std::span<double>(mu));
}

/// The normal force at the contact [N]: that of the drive, changed where the tangential force loads the contact. Empty
/// where it is constant. friction: of the motion.
std::vector<double> true_load(const SimulatedMotion& motion, std::span<const double> friction,
                              const FrictionModel& model, std::span<const double> p) {
  std::vector<double> load = motion.load;
  for_each_effect(model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (requires { E::load_at_contact(q, 1.0, 0.0); }) {
      if (load.empty()) load.assign(motion.size(), motion.mean_load);
      for (std::size_t i = 0; i < load.size(); ++i) load[i] = E::load_at_contact(q, load[i], friction[i]);
    }
  });
  return load;
}

/// mu: of the motion.
std::vector<double> sensed_friction(std::vector<double> mu, const SimulatedMotion& motion,
                                    const std::vector<double>& load, const FrictionModel& model,
                                    std::span<const double> p, const Sensors& sensors) {
  Slip whole = slip_of(motion, 0, motion.size(), motion.relative_velocity);
  whole.load = load;
  for_each_effect(model, p.data(),
                  [&]<class E>(const E& effect, const double* q) { sense_record(effect, q, motion, whole, mu); });
  const auto sense = [&](InstrumentValue value, const double* q) {
    std::visit([&](const auto& effect) { sense_record(effect, q, motion, whole, mu); }, effect_declared_by(value));
  };
  if (sensors.mass_below > 0) sense(InstrumentValue::force_mass_below, &sensors.mass_below);
  if (sensors.force_bandwidth > 0) {
    const double filter[] = {sensors.force_bandwidth, sensors.force_damping};
    sense(InstrumentValue::force_bandwidth, filter);
  }
  if (sensors.friction_low_pass > 0) low_pass(mu, 2 * std::numbers::pi * sensors.friction_low_pass / motion.rate);
  if (sensors.friction_delay != 0) sense(InstrumentValue::vibrometer_delay, &sensors.friction_delay);
  respond(mu, sensors.friction_response, 1);
  return mu;
}

/// v: of the motion.
std::vector<double> sensed_velocity(std::vector<double> v, const SimulatedMotion& motion, const Sensors& sensors) {
  for (double& value : v) value *= sensors.velocity_gain;
  if (sensors.velocity_high_pass > 0 && !v.empty()) {
    // In settled stick-slip the displacement comes back to its mean, and the low-pass part follows it: 2 pi f_c (x -
    // mean x).
    const double away = motion.settled ? motion.displacement[0] - mean_of(motion.displacement) : 0;
    const double corner = sensors.velocity_high_pass;
    high_pass(v, motion.rate, corner, 2 * std::numbers::pi * corner * sensors.velocity_gain * away);
  }
  respond(v, sensors.velocity_response, motion.stated_speed < 0 ? -1 : 1);  // not stated: NaN
  if (sensors.velocity_low_pass > 0) low_pass(v, 2 * std::numbers::pi * sensors.velocity_low_pass / motion.rate);
  for (double& value : v) value += sensors.velocity_zero;
  run_ahead(v, sensors.clock_drift);
  return v;
}

Sensors checked_sensors(const Sensors& stated, double rate, const FrictionModel& model, std::span<const double> p) {
  const Sensors sensors = true_sensors(stated, model, p);
  check(sensors);
  require(sensors.force_bandwidth < 0.5 * rate || !(sensors.force_bandwidth > 0),
          "the bandwidth of the force sensor is above half the sampling rate", "leave it out, or sample faster");
  return sensors;
}

/// The trace but for its time, of a motion whose friction and velocity stand beside it. noise: as of add_noise().
Trace sensed(const SimulatedMotion& motion, std::vector<double> friction, std::vector<double> velocity,
             const FrictionModel& model, std::span<const double> p, const Sensors& sensors, Recording* noise) {
  Trace trace;
  trace.load = true_load(motion, friction, model, p);
  trace.friction = sensed_friction(std::move(friction), motion, trace.load, model, p, sensors);
  trace.velocity = sensed_velocity(std::move(velocity), motion, sensors);
  using Purpose = NormalStream::Purpose;
  add_noise(trace.friction, sensors.friction_noise, sensors, Purpose::friction,
            noise != nullptr ? &noise->friction_noise : nullptr);
  add_noise(trace.velocity, sensors.velocity_noise, sensors, Purpose::velocity,
            noise != nullptr ? &noise->velocity_noise : nullptr);
  round_to(trace.friction, sensors.friction_resolution);
  round_to(trace.velocity, sensors.velocity_resolution);

  trace.temperature = motion.temperature;
  const std::string source = "simulation";
  trace.conditions.radius = {motion.radius, source};
  trace.conditions.load = {motion.mean_load, source};
  const auto [slowest, fastest] = std::minmax_element(motion.disc_speed.begin(), motion.disc_speed.end());
  if (std::isfinite(motion.stated_speed)) {
    trace.conditions.speed = {motion.stated_speed, source};
  } else if (motion.size() > 0 && *slowest == *fastest) {
    trace.conditions.speed = {*fastest, source};
  } else {
    trace.disc_speed = motion.disc_speed;
  }
  trace.steps = {{0, motion.size(), "", trace.conditions}};
  return trace;
}

/// The model and parameters without what only sensors see.
std::pair<FrictionModel, std::vector<double>> at_the_interface(const FrictionModel& model, std::span<const double> p) {
  std::vector<Effect> effects;
  std::vector<double> kept(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(model.base_count()));
  for (std::size_t k = 0; k < model.effects().size(); ++k) {
    const Effect& effect = model.effects()[k];
    if (std::visit([]<class E>(const E&) { return hooks::SensorEffect<E>; }, effect)) continue;
    effects.push_back(effect);
    const std::size_t count = describe(effect).parameters.size();
    for (std::size_t i = 0; i < count; ++i) kept.push_back(p[model.offset(k) + i]);
  }
  return {FrictionModel(model.law(), std::move(effects)), std::move(kept)};
}

}  // namespace

Recording record(const SimulatedMotion& motion, const FrictionModel& model, std::span<const double> p,
                 const Sensors& stated) {
  const Sensors sensors = checked_sensors(stated, motion.rate, model, p);
  Recording recording;
  recording.trace = sensed(motion, motion.friction, motion.velocity, model, p, sensors, &recording);
  recording.trace.time = motion.time;
  return recording;
}

Trace recorded_trace(SimulatedMotion motion, const FrictionModel& model, std::span<const double> p,
                     const Sensors& stated) {
  const Sensors sensors = checked_sensors(stated, motion.rate, model, p);
  std::vector<double> friction = std::move(motion.friction), velocity = std::move(motion.velocity);
  Trace trace = sensed(motion, std::move(friction), std::move(velocity), model, p, sensors, nullptr);
  trace.time = std::move(motion.time);
  return trace;
}

double floor_rmse(const SimulatedMotion& motion, const Recording& recording, const FrictionModel& model,
                  std::span<const double> p) {
  const auto [law, kept] = at_the_interface(model, p);
  double sum = 0;
  std::size_t count = 0;
  for (const SimulatedSlip& event : motion.slips) {
    const auto begin = static_cast<std::size_t>(
        std::upper_bound(motion.time.begin(), motion.time.end(), event.break_away_time) - motion.time.begin());
    const auto end =
        std::isnan(event.restick_time)
            ? motion.size()
            : static_cast<std::size_t>(std::lower_bound(motion.time.begin(), motion.time.end(), event.restick_time) -
                                       motion.time.begin());
    if (begin >= end) continue;
    const std::span<const double> moved = part_of(motion.relative_velocity, begin, end);
    std::vector<double> velocity(moved.begin(), moved.end());
    if (!recording.velocity_noise.empty()) {
      for (std::size_t i = begin; i < end; ++i) velocity[i - begin] -= recording.velocity_noise[i];
    }
    Slip slip = slip_of(motion, begin, end, velocity);
    slip.from_stick = event.break_away_time >= 0;
    slip.break_away_time = event.break_away_time;
    slip.stick_time = event.stick_time;
    slip.stick_slope = begin >= 2 ? (motion.friction[begin - 1] - motion.friction[begin - 2]) * motion.rate : 0;
    slip.direction = event.direction;
    slip.disc_speed = motion.disc_speed[begin];
    slip.earlier_strokes = event.earlier_strokes;
    std::vector<double> model_mu(end - begin);
    evaluate<double>(law, kept.data(), slip, velocity, model_mu);
    for (std::size_t i = begin; i < end; ++i) {
      const double noise = recording.friction_noise.empty() ? 0 : recording.friction_noise[i];
      const double residual = motion.friction[i] + noise - model_mu[i - begin];
      sum += residual * residual;
    }
    count += end - begin;
  }
  return count > 0 ? std::sqrt(sum / static_cast<double>(count)) : 0;
}

}  // namespace tribofit
