#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"

// A disc that slows down under friction, and friction that crosses into the velocity, on records of an integrator that
// is written here: semi-implicit Euler, sixteen steps a sample.

namespace tribofit {
namespace {

constexpr double kRate = 10e3, kRadius = 0.015, kSpeed = 0.42, kLoad = 50, kMass = 0.2, kStiffness = 25e3;

struct Machine {
  double droop = 0;      // of the disc's speed for a unit of friction
  double lag = 0;        // [s] within which it comes
  double crosstalk = 0;  // [m/s] for a unit of friction
  double seconds = 12;
  unsigned seed = 1;
};

/// The record, and v_r as it was.
struct MachineRun {
  Trace trace;
  std::vector<double> relative_velocity;
};

MachineRun run_machine(const Machine& machine) {
  constexpr int steps = 16;
  const double h = 1 / (kRate * steps);
  std::mt19937_64 random(machine.seed);
  std::normal_distribution<double> normal;
  double x = 0, v = 0, slower = 0, static_friction = 0.48;
  bool sticks = true;
  MachineRun run;
  const auto samples = static_cast<std::size_t>(machine.seconds * kRate);
  for (std::size_t i = 0; i < samples; ++i) {
    double friction = 0, disc = 0;
    for (int k = 0; k < steps; ++k) {
      disc = kSpeed * kRadius * (1 - slower);
      if (sticks) {
        v = disc;
        friction = kStiffness * x / kLoad;
        sticks = friction < static_friction;
      } else {
        friction = 0.30 + 0.18 * std::exp(-58 * (disc - v));
        const double next = v + h * (kLoad * friction - kStiffness * x) / kMass;
        sticks = next >= disc;
        v = sticks ? disc : next;
        if (sticks) static_friction = 0.48 * (1 + 0.004 * normal(random));
      }
      x += h * v;
      slower += machine.lag > 0 ? h * (machine.droop * friction - slower) / machine.lag : 0;
    }
    run.trace.time.push_back(static_cast<double>(i) / kRate);
    run.trace.friction.push_back(friction + 0.003 * normal(random));
    run.trace.velocity.push_back(v + machine.crosstalk * friction + 1e-4 * normal(random));
    run.relative_velocity.push_back(disc - v);
  }
  run.trace.conditions.radius = {kRadius, "test"};
  run.trace.conditions.load = {kLoad, "test"};
  return run;
}

double error_of(const Motion& motion, const MachineRun& run) {
  double squares = 0;
  for (std::size_t i = 0; i < motion.size(); ++i)
    squares += std::pow(motion.relative_velocity[i] - run.relative_velocity[i + motion.trimmed], 2);
  return std::sqrt(squares / static_cast<double>(motion.size()));
}

TEST(RestModel, ADiscThatSlowsDownUnderFrictionIsFollowed) {
  for (const double lag : {0.005, 0.02}) {
    for (const double droop : {0.05, 0.1}) {  // 2 and 5 % at break-away
      const MachineRun run = run_machine({.droop = droop, .lag = lag});
      const Motion motion = compute_motion(run.trace);
      EXPECT_EQ(motion.high_pass, 0) << droop << " within " << lag;
      EXPECT_FALSE(motion.velocity_crosstalk.any());
      EXPECT_FALSE(motion.friction_response.any());
      EXPECT_NEAR(motion.drive_compliance.value, droop, 0.2 * droop) << lag;
      EXPECT_LT(error_of(motion, run), 1.5e-4) << droop << " within " << lag;
    }
  }
}

TEST(RestModel, FrictionThatCrossesIntoTheVelocityIsTakenOff) {
  for (const double crosstalk : {-1e-3, 1e-3, 3e-3}) {
    const MachineRun run = run_machine({.crosstalk = crosstalk});
    const Motion motion = compute_motion(run.trace);
    EXPECT_EQ(motion.high_pass, 0) << crosstalk;
    EXPECT_FALSE(motion.drive_compliance.any());
    EXPECT_NEAR(motion.velocity_crosstalk.value, crosstalk, 0.05 * std::abs(crosstalk));
    EXPECT_LT(std::abs(motion.velocity_crosstalk.value - crosstalk), 4 * motion.velocity_crosstalk.std_error);
    EXPECT_LT(error_of(motion, run), 1.5e-4) << crosstalk;
  }
}

TEST(RestModel, NothingIsFoundWhereThereIsNothing) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Motion motion = compute_motion(run_machine({.seconds = 6, .seed = seed}).trace);
    EXPECT_EQ(motion.high_pass, 0) << seed;
    EXPECT_FALSE(motion.drive_compliance.any() || motion.velocity_crosstalk.any()) << seed;
    EXPECT_EQ(motion.speed_ripple.order, 0) << seed;
  }
}

TEST(RestModel, BehindAHighPassTheDiscDoesNotSlowDown) {
  for (const double corner : {0.1, 0.3}) {
    MachineRun run = run_machine({});
    truth::high_pass(run.trace.velocity, corner, kRate);
    const Motion motion = compute_motion(run.trace);
    EXPECT_NEAR(motion.high_pass, corner, 0.03 * corner);
    EXPECT_FALSE(motion.drive_compliance.any() || motion.velocity_crosstalk.any()) << corner;
  }
}

}  // namespace
}  // namespace tribofit
