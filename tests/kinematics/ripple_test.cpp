// A disc whose speed follows its angle is noticed on the plateaus and undone; what only looks like it is left alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {
namespace {

truth::Rig rig_of(double amplitude, double order, double phase) {
  truth::Rig rig;
  rig.duration = 34;  // 2.3 revolutions
  rig.rate = 4000;
  rig.scatter = 0.004;
  rig.ripple = amplitude, rig.ripple_order = order, rig.ripple_phase = phase;
  return rig;
}

double difference_of_angles(double a, double b) {
  return std::remainder(a - b, 2 * std::numbers::pi);
}

// Root mean square of v_r less the true one [m/s].
double error_of(const Motion& motion, const truth::Rig& rig, const Trace& truth) {
  double squares = 0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double t = motion.time[i];
    squares += std::pow(motion.relative_velocity[i] - (rig.disc(t) - truth.velocity[i + motion.trimmed]), 2);
  }
  return std::sqrt(squares / static_cast<double>(motion.size()));
}

TEST(Ripple, IsFoundAndUndone) {
  double order = 1;
  for (double amplitude : {0.0075, 0.02, 0.07, 0.15}) {
    for (double rho : {0.0, 0.9}) {
      truth::Rig rig = rig_of(amplitude, order, 2.5 - order);
      rig.noise_correlation = rho;
      rig.seed = static_cast<unsigned>(order);
      const Trace truth = truth::simulate(rig).trace;
      const Motion motion = compute_motion(truth);
      const DiscRipple& found = motion.speed_ripple;
      ASSERT_EQ(found.order, static_cast<int>(order)) << amplitude;
      EXPECT_NEAR(found.amplitude, amplitude, 5 * found.amplitude_std_error);
      EXPECT_NEAR(difference_of_angles(found.phase, rig.ripple_phase), 0, 5 * found.phase_std_error);
      EXPECT_LT(found.amplitude_std_error, 0.03 * amplitude);
      EXPECT_NEAR(motion.velocity_noise, 2e-5, rho > 0 ? 6e-6 : 2e-6);  // seen in windows of a plateau
      EXPECT_NEAR(motion.plateau_velocity, 0, 5e-6);
      EXPECT_NEAR(motion.plateau_ratio, 1, 5e-4);
      // What is left in v_r is little beside the noise of 0.02 mm/s, which the truth here holds too.
      EXPECT_LT(error_of(motion, rig, truth), 4e-6) << amplitude << " order " << order;
      order = order < 6 ? order + 1 : 1;
    }
  }
}

// The ripple of a coupling runs with the angle that the disc has turned, not with omega t.
TEST(Ripple, IsFoundToRunWithTheTrueAngle) {
  for (double amplitude : {0.03, 0.15}) {
    const truth::Rig rig = rig_of(0, 1, 0);
    const double omega = rig.speed(), order = 2, phase = 0.7, step = 1 / rig.rate;
    Trace trace = truth::simulate(rig).trace;
    const auto speed = [&](double angle) { return omega * (1 + amplitude * std::cos(order * angle + phase)); };
    std::vector<double> relative, angle;
    double theta = 0;
    for (double& v : trace.velocity) {
      relative.push_back(omega * rig.radius - v);
      angle.push_back(theta);
      v += (speed(theta) - omega) * rig.radius;
      const double k1 = speed(theta), k2 = speed(theta + 0.5 * step * k1), k3 = speed(theta + 0.5 * step * k2);
      theta += step / 6 * (k1 + 2 * k2 + 2 * k3 + speed(theta + step * k3));
    }
    const Motion motion = compute_motion(std::move(trace));
    ASSERT_EQ(motion.speed_ripple.order, 2);
    EXPECT_NEAR(motion.speed_ripple.amplitude, amplitude, 5e-4);
    EXPECT_NEAR(motion.speed_ripple.phase, phase, 5e-3);
    double squares = 0;
    for (std::size_t i = 0; i < motion.size(); ++i) {
      squares += std::pow(motion.relative_velocity[i] - relative[i + motion.trimmed], 2);
      ASSERT_NEAR(motion.disc_angle[i], angle[i + motion.trimmed], 1e-3);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(motion.size())), 4e-6);
  }
}

TEST(Ripple, SpeedAngleAndSlidingFollowIt) {
  const truth::Rig rig = rig_of(0.1, 2, 0.4);
  const Motion motion = compute_motion(truth::simulate(rig).trace);
  ASSERT_EQ(motion.disc_speed.size(), motion.size());
  const std::vector<double> angle = disc_angle(motion);
  for (std::size_t i = 0; i < motion.size(); i += 1000) {
    const double t = motion.time[i];
    EXPECT_NEAR(motion.disc_speed[i] / rig.speed(), rig.disc(t) / rig.speed() / rig.radius, 2e-3);
    EXPECT_NEAR(angle[i], rig.disc_travel(t) / rig.radius, 5e-3);
    EXPECT_NEAR(motion.disc_velocity[i], motion.disc_speed[i] * rig.radius, 1e-12);
  }
  // The block does not move on: what slides is what the disc turns.
  const double turned = rig.disc_travel(motion.time.back()) - rig.disc_travel(motion.time.front());
  EXPECT_NEAR(sliding_distance(motion).back() / turned, 1, 0.02);
}

TEST(Ripple, StickAndSlipAreFoundOnIt) {
  const truth::Rig rig = rig_of(0.15, 3, -1);
  const truth::Run run = truth::simulate(rig);
  const Segmentation segmentation = find_cycles(compute_motion(run.trace));
  std::size_t sticks = 0;
  for (const Cycle& cycle : segmentation.cycles) sticks += cycle.stick.size() > 0 ? 1u : 0u;
  EXPECT_EQ(sticks, run.break_away_time.size());
  EXPECT_NEAR(segmentation.slip_time.value, 0.031, 0.006);
}

TEST(Ripple, CanBeLeftAsItIs) {
  MotionOptions options;
  options.undo_speed_ripple = false;
  const Motion motion = compute_motion(truth::simulate(rig_of(0.07, 1, 0)).trace, {}, options);
  EXPECT_EQ(motion.speed_ripple.order, 0);
  EXPECT_TRUE(motion.disc_velocity.empty());
  EXPECT_EQ(motion.health.at(6).status, HealthItem::Status::warning);
}

TEST(Ripple, BehindAHighPassBothAreUndone) {
  const truth::Rig rig = rig_of(0.07, 2, 1);
  const Trace truth = truth::simulate(rig).trace;
  Trace trace = truth;
  truth::high_pass(trace.velocity, 0.3, rig.rate);
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_NEAR(motion.high_pass, 0.3, 0.01);
  ASSERT_EQ(motion.speed_ripple.order, 2);
  EXPECT_NEAR(motion.speed_ripple.amplitude, 0.07, 0.0015);
  EXPECT_LT(error_of(motion, rig, truth), 5e-5);
}

TEST(Ripple, WithoutAStatedSpeedThePlateausStillShowIt) {
  const truth::Rig rig = rig_of(0.05, 1, 1);
  Trace trace = truth::simulate(rig).trace;
  trace.conditions.speed = {};
  const Motion motion = compute_motion(std::move(trace));
  ASSERT_EQ(motion.speed_ripple.order, 1);
  EXPECT_NEAR(motion.speed_ripple.amplitude, 0.05, 0.001);
  EXPECT_NEAR(motion.conditions.speed.value / rig.speed(), 1, 0.002);
}

TEST(Ripple, IsNotSeenWhereThereIsNone) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    truth::Rig rig = rig_of(0, 1, 0);
    rig.rate = 2000;
    rig.seed = seed;
    rig.noise_correlation = seed % 2 == 0 ? 0.9 : 0;
    rig.scatter = 0.005 * (seed % 5);
    rig.wander = 0.3 * (seed % 4);
    Trace trace = truth::simulate(rig).trace;
    if (seed % 3 == 0) trace.conditions.radius.value *= 1.06;
    if (seed % 4 == 0) truth::high_pass(trace.velocity, 0.1, rig.rate);
    EXPECT_EQ(compute_motion(std::move(trace)).speed_ripple.order, 0) << seed;
  }
}

TEST(Ripple, NeedsTwoRevolutionsAndAnUnrecordedSpeed) {
  truth::Rig rig = rig_of(0.07, 2, 1);
  rig.duration = 20;
  EXPECT_EQ(compute_motion(truth::simulate(rig).trace).speed_ripple.order, 0);
  rig.duration = 34;
  Trace trace = truth::simulate(rig).trace;
  trace.conditions.speed = {};
  for (double t : trace.time) trace.disc_speed.push_back(rig.disc(t) / rig.radius);
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_EQ(motion.speed_ripple.order, 0);
  EXPECT_NEAR(motion.plateau_ratio, 1, 1e-3);
}

// A bristle creeps more where a runout loads it less: the plateau then follows the angle though the disc does not.
TEST(Ripple, CreepUnderARunoutIsNotMistakenForIt) {
  for (double sigma0 : {12e3, 20e3, 36e3}) {  // 1/m
    const truth::Rig rig = rig_of(0, 1, 0);
    Trace trace = truth::simulate(rig).trace;
    const double disc = rig.speed() * rig.radius, rise = rig.stiffness * disc / rig.load;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const double load = 1 + 0.1 * std::cos(rig.speed() * trace.time[i] + 0.3);
      const double remaining = std::max(0.02, 1 - trace.friction[i] / rig.static_friction);
      if (std::abs(trace.velocity[i] - disc) < 1.5e-4) trace.velocity[i] -= rise / sigma0 / load / remaining;
      trace.friction[i] *= load;
    }
    const Motion motion = compute_motion(std::move(trace));
    EXPECT_EQ(motion.speed_ripple.order, 0) << sigma0 << ": " << motion.health.at(6).message;
  }
}

// A swing in time whose period is no part of a revolution is no ripple of the angle.
TEST(Ripple, ASwingInTimeIsNotMistakenForIt) {
  truth::Rig rig = rig_of(0.05, 1.7, 1);
  rig.duration = 45;
  EXPECT_EQ(compute_motion(truth::simulate(rig).trace).speed_ripple.order, 0);
}

}  // namespace
}  // namespace tribofit
