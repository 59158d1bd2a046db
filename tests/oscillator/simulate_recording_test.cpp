/// Effects of the motion and of the load channel, hidden in a record.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "rigs.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"

namespace tribofit {
namespace {

/// The published 15 mm test with one effect; p of the effect in SI.
SimulatedRecording hidden_with(const std::string& key, const std::vector<double>& effect,
                               const SimulationOptions& options) {
  const Case c = published_case(0.015, ExponentialLaw{});
  std::vector<double> p = c.p;
  p.insert(p.end(), effect.begin(), effect.end());
  return simulate_recording(FrictionModel(ExponentialLaw{}, {make_effect(key)}), p, c.rig, c.drive, options);
}

TEST(Ripple, SpeedIsTheRateOfTheAngleAndFollowsIt) {
  const double a = 0.1, n = 3, phase = 1;
  const SpeedProfile swung = rippled_speed(constant_speed(0.4), a, n, phase);
  EXPECT_NEAR(swung.angle(0), 0, 1e-14);
  for (double t = -20; t < 40; t += 1.7) {
    const double h = 1e-5, theta = swung.angle(t);
    EXPECT_NEAR(swung.speed(t), 0.4 * (1 + a * std::cos(n * theta + phase)), 1e-12);
    EXPECT_NEAR(swung.speed(t), (swung.angle(t + h) - swung.angle(t - h)) / (2 * h), 1e-8);
    EXPECT_NEAR(swung.acceleration(t), (swung.speed(t + h) - swung.speed(t - h)) / (2 * h), 1e-8);
  }
}

TEST(Hide, SpeedRippleMovesThePlateauWhileTheRecordStatesOneSpeed) {
  const SimulatedRecording hidden =
      hidden_with("speed-ripple", {0.08, 2, 0.5}, {.duration = 16, .rate = 2000, .settle = 3});
  const Trace& trace = hidden.recording.trace;
  EXPECT_TRUE(trace.disc_speed.empty());
  const double stated = trace.conditions.speed.value;
  EXPECT_NEAR(stated, 4 * 2 * std::numbers::pi / 60, 1e-12);
  std::size_t stuck = 0;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (hidden.motion.sticks[i] == 0) continue;
    const double theta = hidden.motion.disc_angle[i];
    ASSERT_NEAR(trace.velocity[i], stated * 0.015 * (1 + 0.08 * std::cos(2 * theta + 0.5)), 1e-12);
    ++stuck;
  }
  EXPECT_GT(stuck, 10000u);
}

TEST(Hide, RadiusAndGainShowInThePlateau) {
  const double stated = 4 * 2 * std::numbers::pi / 60 * 0.015;
  const SimulatedRecording radius = hidden_with("radius-offset", {1.05}, {.duration = 2, .rate = 2000, .settle = 3});
  const SimulatedRecording gain = hidden_with("velocity-gain", {0.92}, {.duration = 2, .rate = 2000, .settle = 3});
  EXPECT_NEAR(radius.recording.trace.conditions.radius.value, 0.015, 1e-15);
  for (std::size_t i = 0; i < 4000; ++i) {
    if (radius.motion.sticks[i] != 0) {
      ASSERT_NEAR(radius.recording.trace.velocity[i], 1.05 * stated, 1e-12);
    }
    ASSERT_NEAR(gain.recording.trace.velocity[i], 0.92 * gain.motion.velocity[i], 1e-15);
  }
}

TEST(Hide, LoadCouplingShowsInTheLoadChannelAndInTheForce) {
  const double kappa = 0.2;
  const SimulatedRecording hidden = hidden_with("load-coupling", {kappa}, {.duration = 2, .rate = 2000, .settle = 3});
  const Trace& trace = hidden.recording.trace;
  ASSERT_EQ(trace.load.size(), trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {
    ASSERT_NEAR(trace.load[i], 50 * (1 + kappa * trace.friction[i]), 1e-9);
    if (hidden.motion.sticks[i]) continue;
    const double v = hidden.motion.relative_velocity[i], mu = 0.318 + 0.191 * std::exp(-52.14 * v);
    ASSERT_NEAR(trace.friction[i], mu / (1 - kappa * mu), 1e-12);
  }
}

TEST(Hide, ContactSpinCreepsInStickByTheSpeedOfItsRim) {
  const double pad = 4e-3;
  const SimulatedRecording hidden = hidden_with("contact-spin", {pad}, {.duration = 2, .rate = 2000, .settle = 3});
  const double omega = 4 * 2 * std::numbers::pi / 60;
  std::size_t checked = 0;
  for (std::size_t i = 0; i < hidden.motion.size(); ++i) {
    const double mu = hidden.motion.friction[i];
    if (!hidden.motion.sticks[i] || mu < 0.25 || mu > 0.4) continue;
    // 2 %: mu_s stands for friction at the speed of the rim, exp(-alpha omega R_c) of the fall lower.
    const double at_rim = 0.318 + 0.191 * std::exp(-52.14 * omega * pad);
    ASSERT_NEAR(hidden.motion.relative_velocity[i] / ContactSpin{}.creep(&pad, at_rim, mu, 0.0, omega), 1, 0.02);
    ++checked;
  }
  EXPECT_GT(checked, 500u);
  EXPECT_NEAR(hidden.floor_rmse, 0, 1e-9);
}

TEST(Drives, StepsAndPausesChangeTheSpeedAsStated) {
  const SpeedProfile drive = stepped_speed({0, 10, 20}, {0.1, 0.4, -0.4}, {{5, 2}});
  EXPECT_EQ(drive.speed(-3), 0.1);
  EXPECT_EQ(drive.speed(4.99), 0.1);
  EXPECT_EQ(drive.speed(6), 0);
  EXPECT_NEAR(drive.speed(8), 0.1, 1e-15);
  EXPECT_NEAR(drive.speed(10 + kSpeedChangeTime / 2), 0.25, 1e-12);
  EXPECT_NEAR(drive.speed(15), 0.4, 1e-15);
  EXPECT_NEAR(drive.speed(25), -0.4, 1e-15);
  EXPECT_NEAR(drive.angle(20) - drive.angle(0), 0.1 * 8 + 0.4 * 10 - 0.3 * kSpeedChangeTime / 2, 1e-12);
  EXPECT_THROW(stepped_speed({0, 1, 1.01}, {1, 2, 3}), InputError);
  EXPECT_THROW(stepped_speed({0}, {1}, {{1, 0}}), InputError);
}

TEST(Simulation, RefusesWhatCannotBeOrNeverEnds) {
  const Case c = published_case(0.015, ExponentialLaw{});
  Rig stiff = c.rig;
  stiff.damping = 1e9;
  EXPECT_THROW(simulate(stiff, c.drive, c.model, c.p, {.duration = 1}), InputError);
  std::vector<double> p = c.p;
  p[2] = -50;
  EXPECT_THROW(simulate(c.rig, c.drive, c.model, p, {.duration = 1}), InputError);
  EXPECT_THROW(simulate(c.rig, c.drive, c.model, c.p, {.duration = 1e-6}), InputError);
  EXPECT_THROW(hidden_with("rate-state", {-5e-6, 0}, {.duration = 1}), InputError);
  EXPECT_THROW(hidden_with("frictional-lag", {0}, {.duration = 1}), InputError);
}

}  // namespace
}  // namespace tribofit
