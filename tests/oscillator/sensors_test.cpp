#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "rigs.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/sensors.hpp"

namespace tribofit {
namespace {

constexpr double kRate = 20000;

const FrictionModel kLaw(CoulombLaw{});
const std::vector<double> kLevels = {0.5, 0.3};

/// A made-up motion: mu and v are sines of frequency f.
SimulatedMotion sine(double f, double duration) {
  SimulatedMotion motion;
  motion.rate = kRate;
  motion.radius = 0.015;
  motion.mean_load = 50;
  const auto n = static_cast<std::size_t>(duration * kRate);
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / kRate, w = 2 * std::numbers::pi * f;
    motion.time.push_back(t);
    motion.displacement.push_back(-std::cos(w * t) / w);
    motion.velocity.push_back(std::sin(w * t));
    motion.acceleration.push_back(w * std::cos(w * t));
    motion.friction.push_back(std::sin(w * t));
    motion.disc_speed.push_back(0.4);
    motion.relative_velocity.push_back(0.4 * motion.radius - motion.velocity.back());
  }
  return motion;
}

/// Complex amplitude of x at f, over the last whole periods of the second half.
std::complex<double> amplitude(const std::vector<double>& x, double f) {
  const auto period = static_cast<std::size_t>(std::lround(kRate / f));
  const std::size_t count = x.size() / 2 / period * period;
  std::complex<double> sum = 0;
  for (std::size_t i = x.size() - count; i < x.size(); ++i) {
    sum += x[i] * std::polar(1.0, -2 * std::numbers::pi * f * static_cast<double>(i) / kRate);
  }
  return 2.0 * sum / static_cast<double>(count) * std::complex<double>(0, 1);  // a plain sine gives 1
}

struct Statistics {
  double deviation = 0, correlation = 0;
};
Statistics statistics(const std::vector<double>& x) {
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    squares += x[i] * x[i];
    if (i > 0) products += x[i] * x[i - 1];
  }
  return {std::sqrt(squares / static_cast<double>(x.size())), products / squares};
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> d(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

TEST(Sensors, PerfectOnesRecordTheMotion) {
  const SimulatedMotion motion = sine(10, 1);
  const Recording r = record(motion, kLaw, kLevels);
  EXPECT_EQ(r.trace.friction, motion.friction);
  EXPECT_EQ(r.trace.velocity, motion.velocity);
  EXPECT_EQ(r.trace.conditions.speed.value, 0.4);
  EXPECT_TRUE(r.trace.disc_speed.empty());
}

TEST(Sensors, NoiseHasTheStatedDeviationAndColour) {
  const SimulatedMotion motion = sine(10, 20);
  for (const double colour : {0.0, 0.9}) {
    const Recording r = record(motion, kLaw, kLevels,
                               {.friction_noise = 0.003, .velocity_noise = 2e-5, .noise_colour = colour, .seed = 7});
    const Statistics mu = statistics(difference(r.trace.friction, motion.friction));
    const Statistics v = statistics(difference(r.trace.velocity, motion.velocity));
    const double n = static_cast<double>(motion.size());
    const double spread = 4 * std::sqrt((1 + colour * colour) / (1 - colour * colour) / (2 * n));
    EXPECT_NEAR(mu.deviation / 0.003, 1, spread);
    EXPECT_NEAR(v.deviation / 2e-5, 1, spread);
    EXPECT_NEAR(mu.correlation, colour, 4 / std::sqrt(n));
    EXPECT_NEAR(v.correlation, colour, 4 / std::sqrt(n));
    // The two channels know nothing of each other.
    double product = 0;
    for (std::size_t i = 0; i < motion.size(); ++i) product += r.friction_noise[i] * r.velocity_noise[i];
    EXPECT_LT(std::abs(product / n / (0.003 * 2e-5)), 4 * std::sqrt((1 + colour * colour) / (1 - colour * colour) / n));
  }
}

TEST(Sensors, SeedDecides) {
  const SimulatedMotion motion = sine(10, 0.1);
  const auto friction = [&](std::uint64_t seed) {
    return record(motion, kLaw, kLevels, {.friction_noise = 0.003, .seed = seed}).trace.friction;
  };
  EXPECT_EQ(friction(1), friction(1));
  EXPECT_NE(friction(1), friction(2));
  EXPECT_NE(friction(1), friction(1 + (std::uint64_t{1} << 32)));
}

TEST(Sensors, DelayShiftsFriction) {
  const double f = 20, delay = 2.5e-3;
  const Recording r = record(sine(f, 1), kLaw, kLevels, {.friction_delay = delay});
  const std::complex<double> expected = std::polar(1.0, -2 * std::numbers::pi * f * delay);
  EXPECT_LT(std::abs(amplitude(r.trace.friction, f) - expected), 1e-6);
  EXPECT_LT(std::abs(amplitude(r.trace.velocity, f) - 1.0), 1e-6);
  const Recording early = record(sine(f, 1), kLaw, kLevels, {.friction_delay = -1.23e-3});
  EXPECT_NEAR(early.trace.friction[100], std::sin(2 * std::numbers::pi * f * (0.005 + 1.23e-3)), 1e-5);
}

TEST(Sensors, MassBelowTheSensorAddsItsInertia) {
  const SimulatedMotion motion = sine(5, 0.5);
  const Recording r = record(motion, kLaw, kLevels, {.mass_below = 0.2});
  for (std::size_t i = 0; i < motion.size(); ++i) {
    ASSERT_NEAR(r.trace.friction[i], motion.friction[i] - 0.2 * motion.acceleration[i] / 50, 1e-14);
  }
}

TEST(Sensors, HighPassAndGainOfTheVibrometer) {
  const double corner = 0.5, gain = 0.95;
  for (const double f : {0.5, 5.0}) {
    const Recording r = record(sine(f, 40), kLaw, kLevels, {.velocity_gain = gain, .velocity_high_pass = corner});
    const std::complex<double> ratio(0, f / corner);
    EXPECT_LT(std::abs(amplitude(r.trace.velocity, f) - gain * ratio / (1.0 + ratio)), 1e-4) << f;
  }
}

TEST(Sensors, HighPassStartsSettled) {
  const Case c = published_case(0.015, ExponentialLaw{});
  const Sensors sensors{.velocity_high_pass = 0.5};
  const SimulatedMotion motion = simulate(c, {.duration = 8, .rate = kRate, .settle = 3.05});
  const SimulatedMotion late = simulate(c, {.duration = 3, .rate = kRate, .settle = 8.05});
  const std::vector<double> all = record(motion, c.model, c.p, sensors).trace.velocity;
  const std::vector<double> end = record(late, c.model, c.p, sensors).trace.velocity;
  // The same motion 5 s later; a start from scratch would be wrong by mm/s.
  for (std::size_t i = 0; i < 60000; i += 100) {
    ASSERT_NEAR(motion.velocity[i + 100000], late.velocity[i], 1e-6);
    ASSERT_NEAR(all[i + 100000], end[i], 2e-4) << i;
  }
}

TEST(Sensors, ForceBandwidthIsASecondOrderLowPass) {
  const double corner = 200, damping = 0.5;
  for (const double f : {20.0, 200.0, 800.0}) {
    const Recording r = record(sine(f, 2), kLaw, kLevels, {.force_bandwidth = corner, .force_damping = damping});
    // The filter is exact, but straight lines between samples stand for the sine: they lower it by sinc^2.
    const double ratio = f / corner, half = std::numbers::pi * f / kRate;
    const std::complex<double> expected =
        std::pow(std::sin(half) / half, 2) / std::complex<double>(1 - ratio * ratio, 2 * damping * ratio);
    EXPECT_LT(std::abs(amplitude(r.trace.friction, f) - expected), 1e-6) << f;
  }
}

TEST(Sensors, ReadingsAreRounded) {
  const Recording r = record(sine(10, 0.1), kLaw, kLevels, {.friction_resolution = 0.01, .velocity_resolution = 0.125});
  for (std::size_t i = 0; i < r.trace.size(); ++i) {
    EXPECT_NEAR(r.trace.friction[i] * 100, std::round(r.trace.friction[i] * 100), 1e-10);
    EXPECT_EQ(r.trace.velocity[i] * 8, std::round(r.trace.velocity[i] * 8));
  }
}

TEST(Floor, IsNoiseAndScatter) {
  const Case c = published_case(0.015, ExponentialLaw{});
  const SimulatedMotion clean = simulate(c, {.duration = 10, .rate = kRate, .settle = 3});
  EXPECT_NEAR(floor_rmse(clean, record(clean, c.model, c.p), c.model, c.p), 0, 1e-12);
  const Recording noisy = record(clean, c.model, c.p, {.friction_noise = 0.003});
  EXPECT_NEAR(floor_rmse(clean, noisy, c.model, c.p), 0.003, 3e-5);

  const SimulatedMotion scattered = simulate(c, {.duration = 10, .rate = kRate, .settle = 3, .scatter = {0.01, 0.5}});
  // An offset o of mu_s changes the law by o exp(-alpha v).
  double sum = 0;
  std::size_t k = 0, count = 0;
  for (const SimulatedSlip& slip : scattered.slips) {
    for (; k < scattered.size() && scattered.time[k] <= slip.break_away_time; ++k) continue;
    for (; k < scattered.size() && !(scattered.time[k] >= slip.restick_time); ++k, ++count) {
      const double left = slip.mu_s_offset * std::exp(-c.p[2] * scattered.relative_velocity[k]);
      sum += left * left;
    }
  }
  const double expected = std::sqrt(sum / static_cast<double>(count));
  EXPECT_NEAR(floor_rmse(scattered, record(scattered, c.model, c.p), c.model, c.p) / expected, 1, 1e-9);
  // Instruments that distort do not count, noise on the velocity hardly.
  const Recording distorted =
      record(scattered, c.model, c.p, {.mass_below = 0.3, .friction_delay = 1e-3, .velocity_noise = 2e-5});
  EXPECT_NEAR(floor_rmse(scattered, distorted, c.model, c.p) / expected, 1, 0.01);
}

TEST(Sensors, WhatCannotBeIsRefused) {
  const SimulatedMotion motion = sine(10, 0.1);
  const auto refused = [&](const Sensors& sensors) {
    EXPECT_THROW(record(motion, kLaw, kLevels, sensors), InputError);
  };
  refused({.mass_below = -1});
  refused({.force_bandwidth = kRate});
  refused({.force_bandwidth = 100, .force_damping = 0});
  refused({.friction_delay = std::nan("")});
  refused({.velocity_gain = 0});
  refused({.velocity_high_pass = -1});
  refused({.friction_noise = -1});
  refused({.velocity_noise = -1});
  refused({.noise_colour = 1});
  refused({.friction_resolution = -1});
}

}  // namespace
}  // namespace tribofit
