// Records whose motion a drive sets: one speed throughout, and strokes of which only the position was recorded.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"

namespace {

using namespace tribofit;

TraceInput input_of(Trace trace) {
  trace.path = "driven.csv";
  trace.velocity_kind = VelocityKind::relative;
  trace.steps = {{0, trace.size(), "", {}}};
  auto shared = std::make_shared<const Trace>(std::move(trace));
  return {shared->path, {}, shared};
}

Diagnosed diagnosed(Trace trace) {
  DiagnosedTraces out = diagnose(std::vector<TraceInput>{input_of(std::move(trace))});
  return {std::move(out.diagnosis), std::move(out.fits)};
}

const FitParameter* parameter(const Fit& fit, const std::string& name) {
  for (const FitParameter& p : fit.parameters) {
    if (p.parameter.name == name) return &p;
  }
  return nullptr;
}

/// Friction at one speed shows no law of speed, but its level and its course: here it settles over 8 m.
TEST(Driven, AtOneSpeedTheLevelAndTheRunInAreFound) {
  for (const double speed : {0.1, 0.002, 3.0}) {
    std::mt19937_64 random(11);
    std::normal_distribution<double> noise(0, 0.004);
    const double length = 80 * speed;
    Trace trace;
    for (std::size_t i = 0; i < 1200; ++i) {
      trace.time.push_back(0.5 * static_cast<double>(i));
      trace.velocity.push_back(speed);
      trace.friction.push_back(0.45 - 0.25 * std::exp(-trace.time.back() / 80) + noise(random));
    }
    const Diagnosed out = diagnosed(std::move(trace));
    EXPECT_EQ(out.diagnosis.verdict, Verdict::effect_found) << speed;
    const FitParameter *level = parameter(out.fits.back(), "mu_k"), *part = parameter(out.fits.back(), "w"),
                       *distance = parameter(out.fits.back(), "L");
    ASSERT_TRUE(level != nullptr && part != nullptr && distance != nullptr) << speed;
    EXPECT_NEAR(level->value, 0.45, 4 * level->std_error) << speed;
    EXPECT_NEAR(part->value, -0.25 / 0.45, 4 * part->std_error) << speed;
    EXPECT_NEAR(distance->value, length, 4 * distance->std_error) << speed;
  }
}

/// A dwell is the drive's, no stick: nothing breaks away where the contact is unloaded first.
TEST(Driven, StrokesWithDwellsOfARecordedPositionHaveOneLevel) {
  for (const double slower : {1.0, 20.0}) {
    std::mt19937_64 random(12);
    std::normal_distribution<double> scatter(0, 1);
    Trace trace;
    double position = 0;
    for (std::size_t i = 0; i < 3000; ++i) {
      const std::size_t place = i % 500;
      const bool forth = place < 250, moves = place % 250 < 200;
      trace.time.push_back(0.01 * slower * static_cast<double>(i));
      trace.drive_position.push_back(position + 1e-7 * scatter(random));
      trace.friction.push_back((forth ? 0.3 : -0.3) + 0.004 * scatter(random));
      position += moves ? (forth ? 5e-5 : -5e-5) : 0;
    }
    const Diagnosed out = diagnosed(std::move(trace));
    EXPECT_EQ(out.diagnosis.verdict, Verdict::sufficient) << slower;
    EXPECT_EQ(out.diagnosis.ladder.size(), 1U) << slower << " " << out.diagnosis.ladder.back().added;
    EXPECT_EQ(to_string(out.diagnosis.law), "coulomb") << slower;
    const FitParameter* level = parameter(out.fits.back(), "mu_k");
    ASSERT_NE(level, nullptr);
    EXPECT_NEAR(level->value, 0.3, 4 * level->std_error) << slower;
  }
}

/// At reversals friction changes its sign when v_r does, or as much later as its channel is.
TEST(Driven, ADelayIsMeasuredAtReversals) {
  for (const double delay : {0.010, 0.020, -0.008}) {
    std::mt19937_64 random(13);
    std::normal_distribution<double> noise(0, 0.003);
    const auto speed = [](double t) {
      return 0.04 * std::sin(2 * std::numbers::pi * 0.31 * t) + 0.012 * std::sin(2 * std::numbers::pi * 1.07 * t + 1);
    };
    const auto law = [](double v) { return std::copysign(0.22 + 0.13 * std::exp(-80 * std::abs(v)), v); };
    Trace trace;
    for (std::size_t i = 0; i < 8000; ++i) {
      const double t = 0.005 * static_cast<double>(i);
      trace.time.push_back(t);
      trace.velocity.push_back(speed(t));
      trace.friction.push_back(law(speed(t - delay)) + noise(random));
    }
    EXPECT_NEAR(prepare_trace(input_of(std::move(trace))).motion.restick_delay, delay, 0.001);
  }
}

}  // namespace
