#include "tribofit/oscillator/sensors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

#include "normal_stream.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {

namespace {

void check(const Sensors& sensors) {
  const auto not_negative = [](double value, const char* name) {
    if (std::isfinite(value) && value >= 0) return;
    throw InputError("the " + std::string(name) + " is negative", "give zero (absent) or more");
  };
  not_negative(sensors.mass_below, "mass below the force sensor");
  not_negative(sensors.force_bandwidth, "bandwidth of the force sensor");
  not_negative(sensors.velocity_high_pass, "high-pass of the vibrometer");
  not_negative(sensors.friction_noise, "noise on mu");
  not_negative(sensors.velocity_noise, "noise on the velocity");
  not_negative(sensors.friction_resolution, "resolution of mu");
  not_negative(sensors.velocity_resolution, "resolution of the velocity");
  if (!(sensors.force_damping > 0)) {
    throw InputError("the damping of the force sensor is not positive", "0.7 is usual");
  }
  if (!std::isfinite(sensors.friction_delay)) {
    throw InputError("the delay of the friction channel is not finite", "give it as e.g. 2ms");
  }
  if (!(std::isfinite(sensors.velocity_gain) && sensors.velocity_gain != 0)) {
    throw InputError("the gain of the vibrometer is zero", "1 is a perfect one");
  }
  if (!(sensors.noise_colour >= 0 && sensors.noise_colour < 1)) {
    throw InputError("the colour of the noise is not within 0 (included) and 1", "0 is white, 0.9 strongly coloured");
  }
}

/// The whole record as one slip, for hooks that work on a stretch of samples. (Unused while no effect has one.)
[[maybe_unused]] Slip whole_record(const SimulatedMotion& motion) {
  Slip slip;
  slip.time = motion.time;
  slip.velocity = motion.relative_velocity;
  slip.acceleration = motion.acceleration;
  slip.angle = motion.disc_angle;
  slip.distance = motion.distance;
  slip.load = motion.load;
  slip.temperature = motion.temperature;
  slip.mean_load = motion.mean_load;
  slip.mean_temperature = motion.mean_temperature;
  return slip;
}

double load_at(const SimulatedMotion& motion, std::size_t i) {
  return motion.load.empty() ? motion.mean_load : motion.load[i];
}

/// Second-order low-pass, bilinear transform with the corner prewarped; starts as if the first value had always been.
void low_pass(std::vector<double>& x, double rate, double corner, double damping) {
  if (x.empty()) return;
  if (!(corner < 0.5 * rate)) {
    throw InputError("the bandwidth of the force sensor is above half the sampling rate",
                     "leave it out, or sample faster");
  }
  const double w = std::tan(std::numbers::pi * corner / rate);
  const double a0 = 1 + 2 * damping * w + w * w;
  const double b = w * w / a0, a1 = 2 * (w * w - 1) / a0, a2 = (1 - 2 * damping * w + w * w) / a0;
  double x1 = x[0], x2 = x[0], y1 = x[0], y2 = x[0];
  for (double& value : x) {
    const double y = b * (value + 2 * x1 + x2) - a1 * y1 - a2 * y2;
    x2 = std::exchange(x1, value);
    y2 = std::exchange(y1, y);
    value = y;
  }
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

/// x(t - delay) by straight lines between samples; before the first sample, the first sample.
std::vector<double> delayed(const std::vector<double>& x, double rate, double delay) {
  std::vector<double> y(x.size());
  const double last = static_cast<double>(x.size()) - 1;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double at = std::clamp(static_cast<double>(i) - delay * rate, 0.0, last);
    const auto low = static_cast<std::size_t>(at);
    const std::size_t high = std::min(low + 1, x.size() - 1);
    y[i] = x[low] + (at - static_cast<double>(low)) * (x[high] - x[low]);
  }
  return y;
}

std::vector<double> add_noise(std::vector<double>& x, double deviation, double colour, std::uint64_t seed,
                              NormalStream::Purpose purpose) {
  if (deviation == 0) return {};
  CorrelatedStream stream(deviation, colour, seed, purpose);
  std::vector<double> noise(x.size());
  for (std::size_t i = 0; i < x.size(); ++i, stream.next()) {
    noise[i] = stream.value();
    x[i] += noise[i];
  }
  return noise;
}

void round_to(std::vector<double>& x, double resolution) {
  if (resolution == 0) return;
  for (double& value : x) value = std::round(value / resolution) * resolution;
}

std::vector<double> sensed_friction(const SimulatedMotion& motion, const FrictionModel& model,
                                    std::span<const double> p, const Sensors& sensors) {
  std::vector<double> mu = motion.friction;
  for_each_effect(model, p.data(), [&]<class E>(const E& effect, const double* q) {
    if constexpr (hooks::Senses<E, double>) effect.sense(q, whole_record(motion), std::span<double>(mu));
  });
  if (sensors.mass_below > 0) {
    for (std::size_t i = 0; i < mu.size(); ++i) {
      mu[i] -= sensors.mass_below * motion.acceleration[i] / load_at(motion, i);
    }
  }
  if (sensors.force_bandwidth > 0) low_pass(mu, motion.rate, sensors.force_bandwidth, sensors.force_damping);
  if (sensors.friction_delay != 0) mu = delayed(mu, motion.rate, sensors.friction_delay);
  return mu;
}

std::vector<double> sensed_velocity(const SimulatedMotion& motion, const Sensors& sensors) {
  std::vector<double> v = motion.velocity;
  for (double& value : v) value *= sensors.velocity_gain;
  if (sensors.velocity_high_pass > 0 && !v.empty()) {
    // In settled stick-slip the displacement comes back to its mean, and the low-pass part follows it: 2 pi f_c (x -
    // mean x).
    double away = 0;
    if (motion.settled) {
      double sum = 0;
      for (const double x : motion.displacement) sum += x;
      away = motion.displacement[0] - sum / static_cast<double>(motion.size());
    }
    const double corner = sensors.velocity_high_pass;
    high_pass(v, motion.rate, corner, 2 * std::numbers::pi * corner * sensors.velocity_gain * away);
  }
  return v;
}

}  // namespace

Recording record(const SimulatedMotion& motion, const FrictionModel& model, std::span<const double> p,
                 const Sensors& sensors) {
  check(sensors);
  Recording recording;
  Trace& trace = recording.trace;
  trace.time = motion.time;
  trace.friction = sensed_friction(motion, model, p, sensors);
  trace.velocity = sensed_velocity(motion, sensors);
  using Purpose = NormalStream::Purpose;
  recording.friction_noise =
      add_noise(trace.friction, sensors.friction_noise, sensors.noise_colour, sensors.seed, Purpose::friction);
  recording.velocity_noise =
      add_noise(trace.velocity, sensors.velocity_noise, sensors.noise_colour, sensors.seed, Purpose::velocity);
  round_to(trace.friction, sensors.friction_resolution);
  round_to(trace.velocity, sensors.velocity_resolution);

  trace.load = motion.load;
  trace.temperature = motion.temperature;
  const std::string source = "simulation";
  trace.conditions.radius = {motion.radius, source};
  trace.conditions.load = {motion.mean_load, source};
  const auto [slowest, fastest] = std::minmax_element(motion.disc_speed.begin(), motion.disc_speed.end());
  if (motion.size() > 0 && *slowest == *fastest) {
    trace.conditions.speed = {*fastest, source};
  } else {
    trace.disc_speed = motion.disc_speed;
  }
  trace.steps = {{0, motion.size(), "", trace.conditions}};
  return recording;
}

namespace {

/// The model and parameters without what only sensors see.
std::pair<FrictionModel, std::vector<double>> at_the_interface(const FrictionModel& model, std::span<const double> p) {
  std::vector<Effect> effects;
  std::vector<double> kept(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(model.base_count()));
  for (std::size_t k = 0; k < model.effects().size(); ++k) {
    const Effect& effect = model.effects()[k];
    if (std::visit([]<class E>(const E&) { return hooks::Senses<E, double>; }, effect)) continue;
    effects.push_back(effect);
    const std::size_t count = describe(effect).parameters.size();
    for (std::size_t i = 0; i < count; ++i) kept.push_back(p[model.offset(k) + i]);
  }
  return {FrictionModel(model.law(), std::move(effects)), std::move(kept)};
}

/// Samples [begin, end) of a channel that may be absent.
std::span<const double> part(const std::vector<double>& channel, std::size_t begin, std::size_t end) {
  return channel.empty() ? std::span<const double>() : std::span(channel).subspan(begin, end - begin);
}

}  // namespace

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
    std::vector<double> velocity(motion.relative_velocity.begin() + static_cast<std::ptrdiff_t>(begin),
                                 motion.relative_velocity.begin() + static_cast<std::ptrdiff_t>(end));
    if (!recording.velocity_noise.empty()) {
      for (std::size_t i = begin; i < end; ++i) velocity[i - begin] -= recording.velocity_noise[i];
    }
    Slip slip;
    slip.time = part(motion.time, begin, end);
    slip.velocity = velocity;
    slip.acceleration = part(motion.acceleration, begin, end);
    slip.angle = part(motion.disc_angle, begin, end);
    slip.distance = part(motion.distance, begin, end);
    slip.load = part(motion.load, begin, end);
    slip.temperature = part(motion.temperature, begin, end);
    slip.from_stick = event.break_away_time >= 0;
    slip.break_away_time = event.break_away_time;
    slip.stick_time = event.stick_time;
    slip.stick_slope = begin >= 2 ? (motion.friction[begin - 1] - motion.friction[begin - 2]) * motion.rate : 0;
    slip.direction = event.direction;
    slip.mean_load = motion.mean_load;
    slip.mean_temperature = motion.mean_temperature;
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
