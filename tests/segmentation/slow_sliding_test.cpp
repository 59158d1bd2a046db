// Records of controlled speed that never stick, and what the user says of stick.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "../kinematics/stick_slip_truth.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {
namespace {

/// Slow sliding is no stick, however fast the record becomes: every sample is used, as what it is.
TEST(SlowSliding, SlowIsNotAtRest) {
  std::mt19937_64 engine(3);
  constexpr double kStep = 5e-3, kDuration = 60, kNoise = 5e-5;
  const double speeds[] = {1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 35e-3, 50e-3, 70e-3, 90e-3, 110e-3, 130e-3, 150e-3};
  const auto steps = [&](double t) { return speeds[std::min<std::size_t>(11, static_cast<std::size_t>(t / 5))]; };
  struct Programme {
    const char* name;
    std::function<double(double)> speed;
  };
  const Programme programmes[] = {
      {"steps", steps},
      {"down", [&](double t) { return steps(kDuration - t); }},
      {"ramp", [](double t) { return 1e-3 + 149e-3 * t / kDuration; }},
      {"triangle", [](double t) { return 1e-3 + 149e-3 * std::abs(std::fmod(t / 10, 2) - 1); }},
      {"sine", [](double t) { return 0.08 + 0.079 * std::sin(2 * std::numbers::pi * t / 15); }},
      {"reversing", [](double t) { return 0.1 * std::sin(2 * std::numbers::pi * t / 10); }},
      {"reversing steps", [&](double t) { return steps(t) * (std::fmod(t, 10) < 5 ? 1 : -1); }}};
  for (const Programme& programme : programmes) {
    for (const double noise : {0.0, kNoise, 4 * kNoise}) {
      std::normal_distribution<double> error(0, 1);
      Trace trace;
      trace.velocity_kind = VelocityKind::relative;
      for (double t = 0; t < kDuration; t += kStep) {
        const double v = programme.speed(t), mu = 0.25 + 0.15 * std::exp(-std::abs(v) / 0.02) + 0.8 * std::abs(v);
        trace.time.push_back(t);
        trace.velocity.push_back(v + noise * error(engine));
        trace.friction.push_back(std::copysign(mu, v) + 0.003 * error(engine));
      }
      const std::size_t n = trace.size();
      const Segmentation s = find_cycles(compute_motion(std::move(trace)));
      EXPECT_EQ(s.kind, MotionKind::always_slipping) << programme.name << " " << noise;
      // Only the direction of what is slower than the noise is not known.
      EXPECT_GT(samples_in_slip(s), n - n / 20) << programme.name << " " << noise;
    }
  }
}

/// A drive that keeps its speed slides, however long the recorder runs on; two slips of a block on a spring do not.
TEST(SlowSliding, ALongRestBesideSlidingAtOneSpeedIsNoStickSlip) {
  std::mt19937_64 engine(8);
  std::normal_distribution<double> error;
  const auto record_of = [&](const std::function<double(double)>& speed) {
    Trace trace;
    trace.velocity_kind = VelocityKind::relative;
    for (double t = 0; t < 20; t += 0.01) {
      const double v = speed(t);
      trace.time.push_back(t);
      trace.velocity.push_back(v + 2e-3 * error(engine));
      trace.friction.push_back((v > 0 ? 2 : 0.5) + 0.05 * error(engine));
    }
    return find_cycles(compute_motion(std::move(trace)));
  };
  EXPECT_EQ(record_of([](double t) { return t < 3 ? 1.0 : 0.0; }).kind, MotionKind::always_slipping);
  const auto slips = [](double t) {
    const double in = std::fmod(t, 9);
    return in > 4 && in < 6 ? std::sin(std::numbers::pi * (in - 4) / 2) : 0.0;
  };
  EXPECT_EQ(record_of(slips).kind, MotionKind::stick_slip);
}

/// The recorder starts before the motor does and stops after it.
TEST(SlowSliding, ARestAtEitherEndMakesNoStickSlip) {
  std::mt19937_64 engine(4);
  std::normal_distribution<double> error(0, 1);
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  for (double t = 0; t < 40; t += 5e-3) {
    const bool moves = t > 4 && t < 36;
    const double v = moves ? 1e-3 + 0.1 * (t - 4) / 32 : 0, mu = moves ? 0.25 + 0.15 * std::exp(-v / 0.02) : 0.2;
    trace.time.push_back(t);
    trace.velocity.push_back(v + 5e-5 * error(engine));
    trace.friction.push_back(mu + 0.003 * error(engine));
  }
  const Segmentation s = find_cycles(compute_motion(std::move(trace)));
  EXPECT_EQ(s.kind, MotionKind::always_slipping);
  EXPECT_NEAR(static_cast<double>(samples_in_slip(s)), 32 * 200, 40);
}

/// Where it is said that nothing sticks, no sample is too slow, and noise turns nothing round.
TEST(SlowSliding, EverySampleCountsWhereTheUserSaysSo) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> error(0, 1);
  for (const bool reverses : {false, true}) {
    Trace trace;
    trace.kind = RecordKind::sliding;
    trace.velocity_kind = VelocityKind::relative;
    for (double t = 0; t < 40; t += 5e-3) {
      const double part = std::abs(std::fmod(t / 10, 2) - 1), sign = reverses && std::fmod(t, 20) < 10 ? -1 : 1;
      const double v = sign * (5e-5 + 0.5 * std::pow(part, 4));
      trace.time.push_back(t);
      trace.velocity.push_back(v + 5e-4 * error(engine));
      trace.friction.push_back(std::copysign(0.35 + 0.15 * std::exp(-60 * std::abs(v)), v) + 0.003 * error(engine));
    }
    const std::size_t n = trace.size();
    const Segmentation s = find_cycles(compute_motion(std::move(trace)));
    EXPECT_EQ(s.kind, MotionKind::always_slipping);
    EXPECT_EQ(samples_in_slip(s), n);
    EXPECT_EQ(s.slip_threshold, 0);
    EXPECT_EQ(s.cycles.size(), reverses ? 4U : 1U);
  }
}

TEST(SlowSliding, WhatSticksIsWhatTheUserSays) {
  std::vector<double> v;
  for (int i = 0; i < 4000; ++i) v.push_back(0.01 + 0.009 * std::cos(2 * std::numbers::pi * i / 1000.0));
  Motion motion;
  motion.step = 1e-3;
  motion.velocity_kind = VelocityKind::relative;
  motion.velocity_noise = 1e-6;
  motion.relative_velocity = v;
  motion.friction.assign(v.size(), 0.3);
  for (std::size_t i = 0; i < v.size(); ++i) motion.time.push_back(motion.step * static_cast<double>(i));
  motion.steps = {{0, v.size(), "", {}}};
  EXPECT_EQ(find_cycles(motion).kind, MotionKind::always_slipping);
  motion.stick.below = 2e-3;
  const Segmentation below = find_cycles(motion);
  EXPECT_EQ(below.kind, MotionKind::stick_slip);
  EXPECT_EQ(below.stick_threshold, 2e-3);
  for (const Cycle& c : below.cycles) {  // break-away is where the growth begins, a little below
    if (c.stick.size() > 0) {
      EXPECT_LT(v[(c.stick.begin + c.stick.end) / 2], 2e-3);
    }
    EXPECT_GT(v[(c.slip.begin + c.slip.end) / 2], 2e-3);
  }
  motion.stick.below = 0.1;
  EXPECT_EQ(find_cycles(motion).kind, MotionKind::always_sticking);

  truth::Rig rig;
  rig.duration = 4;
  MotionOptions options;
  options.stick.never = true;
  Trace trace = truth::simulate(rig).trace;
  trace.conditions.radius = {0.015, "test"};
  trace.conditions.speed = {0.4, "test"};
  const std::size_t n = trace.size();
  const Segmentation never = find_cycles(compute_motion(std::move(trace), {}, options));
  EXPECT_EQ(never.kind, MotionKind::always_slipping);
  EXPECT_GT(samples_in_slip(never), n / 2);
}

}  // namespace
}  // namespace tribofit
