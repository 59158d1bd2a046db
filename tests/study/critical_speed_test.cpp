#include "tribofit/study/critical_speed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "machines.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/study/settled.hpp"
#include "tribofit/study/identified.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {
namespace {

using studies::published_machine;
using studies::uradnicek_machine;

TEST(CriticalSpeed, LinearOneOfTheExponentialLawHasAClosedForm) {
  // c = N (mu_s - mu_k) alpha exp(-alpha v).
  const Machine machine = published_machine();
  const double drop = machine.parameters[0] - machine.parameters[1], decay = machine.parameters[2];
  const double expected = std::log(machine.load * drop * decay / machine.rig.damping) / decay;
  const CriticalSpeed critical = critical_speed(machine);
  ASSERT_EQ(critical.linear.size(), 1U);
  EXPECT_NEAR(critical.linear[0], expected, 1e-7 * expected);
}

TEST(CriticalSpeed, OfUradnicekAreThoseOfTheTwoRoots) {
  // Loss of stability at 6.99 mm/s has two roots in c_v, 0.0615 and 0.277 s/mm.
  for (const double decay : {61.5, 277.0}) {
    const CriticalSpeed critical = critical_speed(uradnicek_machine(decay, 0.5e-3));
    ASSERT_EQ(critical.linear.size(), 1U);
    EXPECT_NEAR(critical.linear[0], 6.99e-3, 0.02e-3);
  }
}

TEST(CriticalSpeed, StickVanishesWhereTheSlipFromBreakAwayJustReachesTheDisc) {
  const Machine machine = uradnicek_machine(250, 0.5e-3);
  const CriticalSpeed critical = critical_speed(machine);
  const double found = critical.stick_vanishes;
  EXPECT_TRUE(settle(uradnicek_machine(250, found * (1 - 1e-5))).sticks);
  EXPECT_FALSE(settle(uradnicek_machine(250, found * (1 + 1e-5))).sticks);
  // It does so far above the loss of stability: the bifurcation is subcritical.
  EXPECT_GT(found, 1.2 * critical.linear.back());
  // On the way down it cannot come back where sliding is stable.
  EXPECT_LE(critical.stick_returns, critical.linear.back() * (1 + 1e-9));
}

Machine with_effect(const std::string& key, double value) {
  Machine machine = published_machine();
  machine.model = FrictionModel(ExponentialLaw{}, {make_effect(key)});
  machine.parameters.push_back(value);
  return machine;
}

TEST(CriticalSpeed, IsFoundWhereSlowSlidingIsStableToo) {
  // exp(-(alpha v)^2) is flat at rest: c = 2 N (mu_s - mu_k) alpha^2 v exp(-(alpha v)^2) has two roots, and nothing
  // sticks below the first.
  const Machine machine = with_effect("stribeck-exponent", 2);
  const CriticalSpeed critical = critical_speed(machine);
  ASSERT_EQ(critical.linear.size(), 2U);
  const double drop = machine.load * (machine.parameters[0] - machine.parameters[1]), alpha = machine.parameters[2];
  for (const double v : critical.linear) {
    EXPECT_NEAR(2 * drop * alpha * alpha * v * std::exp(-std::pow(alpha * v, 2)), machine.rig.damping,
                1e-4 * machine.rig.damping);
  }
  EXPECT_TRUE(critical.stable_at_highest);
  EXPECT_FALSE(critical.below_range);
  const auto sticks = [&](double v) { return settle(with_value(machine, "velocity", v)).sticks; };
  EXPECT_FALSE(sticks(critical.lowest));
  EXPECT_TRUE(sticks(critical.stick_vanishes * (1 - 1e-5)));
  EXPECT_FALSE(sticks(critical.stick_vanishes * (1 + 1e-5)));
  EXPECT_LE(critical.stick_returns, critical.linear.back() * (1 + 1e-9));
  EXPECT_GT(critical.stick_returns, critical.linear.front());
}

TEST(CriticalSpeed, DoesNotTakeAStartAtTheSpeedOfAFastDiscForStickSlip) {
  // A creeping contact is within half the speed of the disc for some swings after such a start, which die out.
  const Machine machine = with_effect("contact-spin", 3e-3);
  EXPECT_TRUE(keeps_sticking(with_value(machine, "velocity", 0.05)));
  for (const double v : {0.5, 5.0}) {
    EXPECT_FALSE(keeps_sticking(with_value(machine, "velocity", v)));
    EXPECT_EQ(settle(with_value(machine, "velocity", v)).regime, Regime::sliding);
  }
}

TEST(CriticalSpeed, NothingSticksWhereSlidingIsOverdampedOrFrictionRises) {
  for (const Machine& machine :
       {with_value(published_machine(), "damping-ratio", 10), with_value(published_machine(), "ratio", 1.5)}) {
    const CriticalSpeed critical = critical_speed(machine);
    EXPECT_TRUE(critical.below_range);
    EXPECT_TRUE(critical.linear.empty());
    EXPECT_TRUE(critical.stable_at_highest);
    EXPECT_TRUE(std::isnan(critical.stick_vanishes));
  }
}

TEST(CriticalSpeed, SaysWhereItLiesOutsideTheRange) {
  const CriticalSpeed above = critical_speed(uradnicek_machine(250, 0.5e-3), {.lowest = 1e-4, .highest = 2e-4});
  EXPECT_TRUE(above.above_range);
  EXPECT_TRUE(std::isnan(above.stick_vanishes));
  const CriticalSpeed below = critical_speed(uradnicek_machine(250, 0.5e-3), {.lowest = 0.1, .highest = 0.2});
  EXPECT_TRUE(below.below_range);
  EXPECT_THROW(critical_speed(published_machine(), {.lowest = 2, .highest = 1}), InputError);
}

TEST(Uncertainty, DrawsHaveTheCovarianceTheyAreDrawnFrom) {
  const Machine machine = published_machine();
  MachineCovariance covariance;
  covariance.friction = {1e-6, 0.5e-6, 0, 0.5e-6, 1e-6, 0, 0, 0, 0.25};
  covariance.rig = {1e-4, 0, 0, 0, 1e-4, 0, 0, 0, 1e4};
  const std::vector<Machine> draws = draws_of(machine, covariance, 4000, 3);
  ASSERT_EQ(draws.size(), 4000U);
  double ss = 0, sk = 0, kk = 0;
  for (const Machine& m : draws) {
    ss += std::pow(m.parameters[0] - machine.parameters[0], 2) / 4000;
    sk += (m.parameters[0] - machine.parameters[0]) * (m.parameters[1] - machine.parameters[1]) / 4000;
    kk += std::pow(m.rig.stiffness - machine.rig.stiffness, 2) / 4000;
  }
  EXPECT_NEAR(ss, 1e-6, 0.08e-6);
  EXPECT_NEAR(sk, 0.5e-6, 0.06e-6);
  EXPECT_NEAR(kk, 1e4, 0.08e4);
}

}  // namespace
}  // namespace tribofit
