#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/kinematics/motion.hpp"

// How the load point of velocity steps is read from what was recorded of it.

namespace tribofit {
namespace {

Trace steps_at(double rate, double duration) {
  Trace trace;
  trace.kind = RecordKind::velocity_steps;
  for (std::size_t i = 0; static_cast<double>(i) < rate * duration; ++i) {
    trace.time.push_back(static_cast<double>(i) / rate);
    trace.friction.push_back(0.6);
  }
  return trace;
}

/// Its integral wanders by a hundred times the roundings, and turned in dozens of places.
TEST(LoadPointMotion, NoiseOfARecordedSpeedMakesNoSteps) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Trace trace = steps_at(20, 140);
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal(0, 1e-6);
    for (const double t : trace.time)
      trace.load_point_speed.push_back((t < 60 || t >= 80 ? 2e-6 : 20e-6) + normal(generator));
    const Motion motion = compute_motion(std::move(trace));
    ASSERT_EQ(motion.load_point.size(), 3U) << seed;
    EXPECT_NEAR(motion.load_point[1].begin, 60, 0.1) << seed;
    EXPECT_NEAR(motion.load_point[2].begin, 80, 0.1) << seed;
    EXPECT_NEAR(motion.load_point[0].speed, 2e-6, 1e-7) << seed;
    EXPECT_NEAR(motion.load_point[1].speed, 20e-6, 2e-7) << seed;
  }
}

/// A ramp keeps its corners, so that its stairs are never further from it than what a digit or two shows.
TEST(LoadPointMotion, ARampIsFollowedAsItWasRecorded) {
  constexpr double kDigit = 1e-8;
  Trace trace = steps_at(20, 120);
  const auto displacement = [](double t) {
    const double ramp = std::min(std::max(t - 60, 0.0), 5.0);
    return 2e-6 * t + 0.5 * (18e-6 / 5) * ramp * ramp + 18e-6 * std::max(t - 65, 0.0);
  };
  for (const double t : trace.time) trace.drive_position.push_back(std::round(displacement(t) / kDigit) * kDigit);
  const std::vector<double> times = trace.time;
  const Motion motion = compute_motion(std::move(trace));
  double at = 0, largest = 0;
  for (std::size_t i = 1, phase = 0; i < times.size(); ++i) {
    double last = times[i - 1];
    while (phase + 1 < motion.load_point.size() && motion.load_point[phase + 1].begin <= times[i]) {
      at += motion.load_point[phase].speed * (motion.load_point[phase + 1].begin - last);
      last = motion.load_point[++phase].begin;
    }
    at += motion.load_point[phase].speed * (times[i] - last);
    largest = std::max(largest, std::abs(at - displacement(times[i])));
  }
  EXPECT_LT(largest, 6e-8);
}

/// A drive that hunts about its speeds has three of them, and a slide at a speed between two others is no ramp.
TEST(LoadPointMotion, SlidesBetweenOthersAreNoRamps) {
  for (const double hunting : {0.0, 0.07}) {
    Trace trace = steps_at(20, 240);
    double at = 0;
    for (std::size_t i = 0; i < trace.time.size(); ++i) {
      trace.drive_position.push_back(std::round(at / 1e-8) * 1e-8);
      const double t = trace.time[i], speed = t < 80 ? 1e-6 : t < 160 ? 3e-6 : 10e-6;
      at += speed * (1 + hunting * std::sin(2 * std::numbers::pi * t / 10)) / 20;
    }
    const Motion motion = compute_motion(std::move(trace));
    const auto slides = std::count_if(motion.load_point.begin(), motion.load_point.end(),
                                      [](const LoadPointPhase& phase) { return !phase.on_ramp; });
    EXPECT_EQ(slides, 3) << hunting;
  }
}

/// The answer of a stiff machine may be one sample as well: what lies beside a change of speed stays.
TEST(LoadPointMotion, LoneSamplesAndMarkersTakeNoPart) {
  Trace trace = steps_at(20, 120);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal(0, 2e-4);
  for (const double t : trace.time) trace.drive_position.push_back(2e-6 * t + 18e-6 * std::max(t - 60, 0.0));
  for (double& mu : trace.friction) mu += normal(generator);
  const auto at = [](double t) { return static_cast<std::size_t>(std::lround(20 * t)); };
  const std::vector<std::size_t> spoilt = {at(10), at(20), at(20) + 1, at(20) + 2, at(100)};
  trace.friction[at(10)] += 0.03;
  for (std::size_t k = 1; k < 4; ++k) trace.friction[spoilt[k]] = 0;
  trace.friction[at(100)] = 99;
  trace.friction[at(60) + 1] += 0.03;
  const double answer = trace.friction[at(60) + 1];
  const Motion motion = compute_motion(std::move(trace));
  ASSERT_EQ(motion.faults.size(), motion.size());
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const bool expected = std::find(spoilt.begin(), spoilt.end(), i) != spoilt.end();
    EXPECT_EQ(motion.has_fault(i, SampleFault::friction), expected) << motion.time[i];
  }
  EXPECT_EQ(motion.friction[at(60) + 1], answer);
  ASSERT_EQ(motion.notes.size(), 1U);
  EXPECT_NE(motion.notes[0].find("5 samples left out, the first at 10 s"), std::string::npos) << motion.notes[0];
}

/// Noise alone, and noise that a converter rounds, are left as they are.
TEST(LoadPointMotion, FrictionWithoutFaultsStaysWhole) {
  for (const double digit : {0.0, 1e-3, 2e-3}) {
    Trace trace = steps_at(20, 120);
    std::mt19937_64 generator(4);
    std::normal_distribution<double> normal(0, 2e-4);
    for (const double t : trace.time) trace.drive_position.push_back(2e-6 * t + 18e-6 * std::max(t - 60, 0.0));
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const double t = trace.time[i], adapts = t < 60 ? 0 : 0.02 * std::exp(-2 * (t - 60)) - 0.01;
      const double mu = 0.6 + adapts + normal(generator);
      trace.friction[i] = digit > 0 ? digit * std::round(mu / digit) : mu;
    }
    const Motion motion = compute_motion(std::move(trace));
    EXPECT_TRUE(motion.faults.empty()) << digit;
    EXPECT_TRUE(motion.notes.empty()) << digit;
  }
}

}  // namespace
}  // namespace tribofit
