// What creeps in stick is given back part by part, on the scale a bristle, a gap or a turning disc would show.
#include "tribofit/segmentation/stick_motion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "../kinematics/stick_slip_truth.hpp"

namespace tribofit {
namespace {

struct Sticks {
  Motion motion;
  Segmentation segmentation;
  std::vector<StickCreep> creep;
};

Sticks sticks_of(Trace trace) {
  Sticks s{compute_motion(std::move(trace)), {}, {}};
  s.segmentation = find_cycles(s.motion);
  s.creep = stick_motion(s.motion, s.segmentation);
  return s;
}

TEST(StickMotion, RigidStickStandsStillAndItsFrictionRisesWithTheSpring) {
  truth::Rig rig;
  const Sticks s = sticks_of(truth::simulate(rig).trace);
  ASSERT_GT(s.creep.size(), 15u);
  const double disc = rig.speed() * rig.radius, rise = rig.stiffness * disc / rig.load;
  double mean_rise = 0, count = 0;
  for (const StickCreep& stick : s.creep) {
    const Cycle& cycle = s.segmentation.cycles.at(stick.cycle);
    double last = s.motion.time[cycle.stick.begin];
    for (const StickPart& part : stick.parts) {
      EXPECT_NEAR(part.relative_velocity, 0, 5e-6);
      EXPECT_DOUBLE_EQ(part.disc_velocity, s.motion.constant_disc_velocity);
      EXPECT_GT(part.time, last);
      last = part.time;
      // A spring that is wound up at constant speed: back from the friction at break-away.
      const double expected = cycle.break_away_friction - rise * (cycle.break_away_time - part.time);
      EXPECT_NEAR(part.friction, expected, 1.5e-3);
      mean_rise += part.friction_rate, count += 1;
    }
    EXPECT_LT(last, s.motion.time[cycle.stick.begin + cycle.stick.size() * 8 / 10]);
  }
  EXPECT_NEAR(mean_rise / count / rise, 1, 0.01);
}

TEST(StickMotion, ABristleAndAConstantGapAreToldApartByIt) {
  truth::Rig rig;
  rig.duration = 8;
  const Trace truth = truth::simulate(rig).trace;
  const double disc = rig.speed() * rig.radius, sigma0 = 100e3;
  Trace bristle = truth, gap = truth;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (std::abs(truth.velocity[i] - disc) > 1.5e-4) continue;  // in slip
    const double remaining = std::max(0.05, 1 - truth.friction[i] / rig.static_friction);
    bristle.velocity[i] -= rig.stiffness * disc / rig.load / sigma0 / remaining;
  }
  gap.conditions.radius.value *= 1 + 1e-4 / disc;
  const Sticks of_gap = sticks_of(gap);
  for (const StickCreep& stick : of_gap.creep) {
    for (const StickPart& part : stick.parts) EXPECT_NEAR(part.relative_velocity, 1e-4, 5e-6);
  }
  const Sticks of_bristle = sticks_of(bristle);
  ASSERT_GT(of_bristle.creep.size(), 15u);
  double measured = 0, predicted = 0;
  for (const StickCreep& stick : of_bristle.creep) {
    EXPECT_GT(stick.parts.back().relative_velocity, 1.5 * stick.parts.front().relative_velocity);
    for (const StickPart& part : stick.parts) {
      measured += part.relative_velocity;
      predicted += part.friction_rate / sigma0 / (1 - part.friction / rig.static_friction);
    }
  }
  EXPECT_NEAR(measured / predicted, 1, 0.03);
}

TEST(StickMotion, FollowsADiscWhoseSpeedVariesAndASlipBackwards) {
  truth::Rig rig;
  Trace trace = truth::simulate(rig).trace;
  for (double& v : trace.velocity) v = -v;
  for (double& mu : trace.friction) mu = -mu;
  trace.conditions.speed = {};
  trace.disc_speed.assign(trace.size(), -rig.speed());
  const Sticks s = sticks_of(std::move(trace));
  ASSERT_GT(s.creep.size(), 15u);
  for (const StickCreep& stick : s.creep) {
    EXPECT_EQ(s.segmentation.cycles[stick.cycle].direction, -1);
    for (const StickPart& part : stick.parts) {
      EXPECT_GT(part.friction, 0);
      EXPECT_GT(part.friction_rate, 0);
      EXPECT_NEAR(part.disc_velocity, rig.speed() * rig.radius, 1e-12);
    }
  }
}

TEST(StickMotion, SticksOfAFewSamplesAreLeftOut) {
  truth::Rig rig;
  rig.rate = 200;  // 36 samples a stick
  EXPECT_TRUE(sticks_of(truth::simulate(rig).trace).creep.empty());
}

}  // namespace
}  // namespace tribofit
