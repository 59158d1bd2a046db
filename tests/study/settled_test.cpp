#include "tribofit/study/settled.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "machines.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/steady_sliding.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {
namespace {

using studies::published_machine;
using studies::uradnicek_machine;

TEST(SteadySliding, IsLostWhereDampingNoLongerOutweighsTheFallOfFriction) {
  // m s^2 + (c + N mu'(v)) s + k = 0: the real part is -(c + N mu')/(2 m), to the last figures.
  for (const double velocity : {2e-3, 6.99e-3, 20e-3}) {
    const Machine machine = uradnicek_machine(61.5, velocity);
    const double slope = -(0.6 - 0.1) * 61.5 * std::exp(-61.5 * velocity);
    const SteadySliding sliding = steady_sliding(machine);
    EXPECT_NEAR(sliding.growth_rate(), -(200 + 10 * slope) / 2000, 1e-6);
    EXPECT_NEAR(sliding.displacement, 10 * (0.1 + 0.5 * std::exp(-61.5 * velocity)) / 5000, 1e-12);
  }
}

TEST(SteadySliding, OfALawWithALagHasTheRootsOfItsCubic) {
  // m s^2 + c s + k = N f'(v)/(1 + tau s) (-s): m tau s^3 + (m + c tau) s^2 + (c + k tau + N f') s + k = 0.
  Machine machine = published_machine();
  machine.model = FrictionModel(ExponentialLaw{}, {make_effect("frictional-lag")});
  const double tau = 2e-3;
  machine.parameters.push_back(tau);
  const double v = machine.disc_velocity(), decay = machine.parameters[2];
  const double slope = -(machine.parameters[0] - machine.parameters[1]) * decay * std::exp(-decay * v);
  const Rig& rig = machine.rig;
  const SteadySliding sliding = steady_sliding(machine);
  ASSERT_EQ(sliding.eigenvalues.size(), 3U);
  for (const std::complex<double>& s : sliding.eigenvalues) {
    const std::complex<double> rest = rig.mass * tau * s * s * s + (rig.mass + rig.damping * tau) * s * s +
                                      (rig.damping + rig.stiffness * tau + machine.load * slope) * s + rig.stiffness;
    EXPECT_LT(std::abs(rest), 1e-5 * rig.stiffness);
  }
}

TEST(Settled, CoulombFrictionWithoutDampingHasAClosedForm) {
  // Slip is an arc about x_k = N mu_k/k that begins at x_k + d, d = N (mu_s - mu_k)/k, with the speed of the disc and
  // ends at x_k - d with it: radius sqrt(d^2 + (v/w)^2), duration (2 pi - 2 atan2(d, -... )) from the two angles.
  Machine machine = published_machine();
  machine.model = FrictionModel(CoulombLaw{});
  machine.parameters = {0.5, 0.3};
  machine.rig.damping = 0;
  const double w = machine.rig.natural_frequency(), v = machine.disc_velocity();
  const double d = machine.load * 0.2 / machine.rig.stiffness;
  const double radius = std::hypot(d, v / w), slip = (2 * std::numbers::pi - 2 * std::atan2(d, v / w)) / w;
  const Settled settled = settle(machine);
  EXPECT_EQ(settled.regime, Regime::stick_slip);
  EXPECT_NEAR(settled.peak_to_peak, 2 * radius, 1e-6 * radius);
  EXPECT_NEAR(settled.stick_time, 2 * d / v, 1e-6 * settled.stick_time);
  EXPECT_NEAR(1 / settled.frequency, 2 * d / v + slip, 1e-6);
  EXPECT_NEAR(settled.peak_speed, v + w * radius, 1e-6 * v);
  EXPECT_NEAR(settled.energy, 2 * machine.rig.stiffness * radius * radius, 1e-6 * settled.energy);
}

TEST(Settled, AboveTheCriticalSpeedVibrationDiesOut) {
  const Settled settled = settle(uradnicek_machine(61.5, 10e-3));
  EXPECT_EQ(settled.regime, Regime::sliding);
  EXPECT_FALSE(settled.sticks);
  EXPECT_EQ(settled.peak_to_peak, 0);
}

TEST(Settled, WhatHardlySwingsSlidesWithAllItsMeasures) {
  // Nearly critical, overdamped, and by friction that rises with speed.
  const Machine published = published_machine();
  for (const Machine& machine :
       {with_value(with_value(published, "damping-ratio", 0.99), "velocity", 0.4), with_value(published, "ratio", 1.6),
        with_value(published, "damping-ratio", 3), with_value(published, "damping-ratio", 100)}) {
    for (const StartFrom start : {StartFrom::stick, StartFrom::sliding}) {
      const Settled settled = settle(machine, {.start = start});
      EXPECT_EQ(settled.regime, Regime::sliding) << settled.seen;
      EXPECT_EQ(settled.peak_to_peak, 0);
      EXPECT_EQ(settled.energy, 0);
      EXPECT_EQ(settled.peak_speed, machine.disc_velocity());
      EXPECT_TRUE(std::isnan(settled.frequency));
    }
  }
}

TEST(Settled, RoundingIsNoVibration) {
  // Damped by friction that rises with speed: after twenty periods nothing is left of the push but rounding.
  Machine machine = published_machine();
  machine.model = FrictionModel(ExponentialLaw{}, {make_effect("viscous")});
  machine.parameters.push_back(2);
  for (double v = 0.038; v < 0.06; v += 0.0005) {
    const Settled settled = settle(with_value(machine, "velocity", v), {.start = StartFrom::sliding});
    EXPECT_EQ(settled.regime, Regime::sliding) << v << ": " << settled.peak_to_peak;
  }
}

TEST(Settled, FrictionThatGoesWithTheAngleDoesNotSettleAndSaysWhatWasSeen) {
  Machine machine = published_machine();
  machine.model = FrictionModel(ExponentialLaw{}, {make_effect("runout")});
  machine.parameters.insert(machine.parameters.end(), {0.05, 0.3});
  const Settled settled = settle(machine, {.longest_cycles = 50});
  EXPECT_EQ(settled.regime, Regime::not_settled);
  EXPECT_TRUE(settled.sticks);
  EXPECT_NEAR(settled.frequency, settle(published_machine()).frequency, 0.3);
  EXPECT_THAT(settled.seen, ::testing::HasSubstr("does not repeat itself"));
}

TEST(Settled, FromSteadySlidingVibrationGrowsIntoTheSameCycle) {
  const Machine machine = published_machine();
  const Settled wound = settle(machine), grown = settle(machine, {.start = StartFrom::sliding});
  EXPECT_EQ(grown.regime, Regime::stick_slip);
  EXPECT_NEAR(grown.frequency, wound.frequency, 1e-6 * wound.frequency);
  EXPECT_NEAR(grown.peak_to_peak, wound.peak_to_peak, 1e-6 * wound.peak_to_peak);
}

TEST(Settled, SmoothedLawTendsToTheLawWithLocatedEvents) {
  const Machine machine = uradnicek_machine(330, 0.5e-3);
  const Settled exact = settle(machine);
  double last = 1;
  for (const double sharpness : {1e5, 1e6, 1e7, 1e8}) {  // s/m
    const Settled smoothed = settle(machine, {.sharpness = sharpness});
    EXPECT_EQ(smoothed.regime, Regime::stick_slip);
    const double difference = smoothed.frequency / exact.frequency - 1;
    EXPECT_GT(difference, 0);
    EXPECT_LT(difference, 0.4 * last);
    last = difference;
    EXPECT_NEAR(smoothed.peak_to_peak / exact.peak_to_peak, 1, 2.5 * difference);
  }
  EXPECT_LT(last, 2e-3);
  EXPECT_EQ(settle(uradnicek_machine(330, 12e-3), {.sharpness = 5e5}).regime, Regime::sliding);
  EXPECT_THROW(settle(published_machine(FractionalLaw{}), {.sharpness = 5e5}), InputError);
}

TEST(Settled, FromRestOverTheLossOfStabilityVibrationDiesOutThoughStickSlipIsThere) {
  const Machine machine = uradnicek_machine(330, 8e-3);  // loss of stability at 6.4, stick vanishes at 9.6 mm/s
  EXPECT_EQ(settle(machine).regime, Regime::stick_slip);
  EXPECT_EQ(settle(machine, {.start = StartFrom::rest}).regime, Regime::sliding);
  EXPECT_EQ(settle(machine, {.start = StartFrom::sliding}).regime, Regime::sliding);
}

TEST(Settled, MotionBeginsAtTheBreakAwayOfASettledCycle) {
  const Machine machine = published_machine();
  const Settled settled = settle(machine);
  const SimulatedMotion motion = settled_motion(machine, settled, 2, 1000);
  ASSERT_EQ(motion.size(), 2000U);
  EXPECT_NEAR(motion.friction[0], machine.parameters[0], 1e-6);
  for (std::size_t i = 0; i < 1000; i += 50) {
    EXPECT_NEAR(motion.displacement[i], motion.displacement[i + 1000], 1e-8);
  }
}

TEST(Settled, RefusesMachinesThatCannotBe) {
  EXPECT_THROW(settle(with_value(published_machine(), "mass", -1)), InputError);
  EXPECT_THROW(settle(with_value(published_machine(), "speed", 0)), InputError);
  EXPECT_THROW(settle(with_value(published_machine(), "load", 0)), InputError);
  EXPECT_THROW(settle(with_value(published_machine(), "alpha", -1)), InputError);
}

TEST(Variables, TwoAtOnceAreBothThoseOfTheMachineInEitherOrder) {
  const Machine machine = published_machine();
  const auto check = [&](const char* a, double va, const char* b, double vb) {
    for (const Machine& both : {with_values(machine, a, va, b, vb), with_values(machine, b, vb, a, va)}) {
      EXPECT_NEAR(value_of(both, a), va, 1e-12 * va) << a << ", " << b;
      EXPECT_NEAR(value_of(both, b), vb, 1e-12 * vb) << a << ", " << b;
    }
  };
  check("velocity", 0.01, "radius", 0.03);
  check("damping-ratio", 0.1, "mass", 2);
  check("damping-ratio", 0.1, "stiffness", 5e3);
  check("ratio", 0.4, "mu_s", 0.8);
  check("velocity", 0.01, "ratio", 0.4);
  EXPECT_THROW(with_values(machine, "velocity", 1, "speed", 1), InputError);
  EXPECT_THROW(with_values(machine, "mu_k", 0.1, "ratio", 0.4), InputError);
  EXPECT_THROW(with_values(machine, "damping", 1, "damping-ratio", 1), InputError);
}

TEST(Variables, ComeBackAsTheyWereSet) {
  const Machine machine = published_machine();
  for (const Variable& variable : variables_of(machine)) {
    const double value = 1.25 * value_of(machine, variable.name);
    EXPECT_NEAR(value_of(with_value(machine, variable.name, value), variable.name), value, 1e-12 * value)
        << variable.name;
  }
  EXPECT_THROW(with_value(machine, "stifness", 1), InputError);
  EXPECT_THROW(measure_named("loudness"), InputError);
}

}  // namespace
}  // namespace tribofit
