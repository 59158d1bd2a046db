/// Contacts that age with time, at rest too (rate-state:healing), against an independent integration and in their
/// limits.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <vector>

#include "tribofit/friction/dynamics.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace {

using namespace tribofit;

constexpr double kLength = 0.1, kRest = 0.3, kPeak = 0.08;  // of a slip [s], of the stick between [s], [m/s]

/// v_r of two slips with a stick between them, from t = 0.
double speed_at(double t) {
  const double within = t < kLength ? t : t - kLength - kRest;
  return within < 0 || within > kLength ? 0 : kPeak * std::pow(std::sin(std::numbers::pi * within / kLength), 2);
}

/// The second of the two slips, with or without the first.
struct SecondSlip {
  std::vector<double> time, velocity, earlier_time, earlier_velocity;
  Slip slip;

  explicit SecondSlip(double step) {
    for (double t = 0.5 * step; t < kLength; t += step) {
      earlier_time.push_back(t);
      earlier_velocity.push_back(speed_at(t));
      time.push_back(t + kLength + kRest);
      velocity.push_back(speed_at(time.back()));
    }
    slip.time = time;
    slip.velocity = velocity;
    slip.earlier_time = earlier_time;
    slip.earlier_velocity = earlier_velocity;
    slip.earlier_restick_time = kLength;
    slip.from_stick = true;
    slip.break_away_time = kLength + kRest;
    slip.stick_time = kRest;
  }
  SecondSlip(const SecondSlip&) = delete;
  SecondSlip& operator=(const SecondSlip&) = delete;
};

FrictionModel healing(Law law = Law(ExponentialLaw{})) {
  return FrictionModel(law, {make_effect("rate-state:healing")});
}

/// d theta/dt = 1 - v theta/D_c by Runge and Kutta from (begin, theta) to the end.
double age(double begin, double end, double theta, double length) {
  const auto rate = [&](double t, double x) { return 1 - speed_at(t) * x / length; };
  const int n = std::max(1, static_cast<int>(std::ceil((end - begin) * kPeak / length / 0.02)));
  const double h = (end - begin) / n;
  for (int i = 0; i < n; ++i) {
    const double t = begin + i * h;
    const double k1 = rate(t, theta), k2 = rate(t + 0.5 * h, theta + 0.5 * h * k1);
    const double k3 = rate(t + 0.5 * h, theta + 0.5 * h * k2), k4 = rate(t + h, theta + h * k3);
    theta += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return theta;
}

std::vector<double> friction_along(const FrictionModel& model, const std::vector<double>& p, const Slip& slip) {
  std::vector<double> mu(slip.size());
  evaluate<double>(model, p.data(), slip, slip.velocity, mu);
  return mu;
}

TEST(Healing, FollowsAnIndependentIntegrationThroughSlipStickAndSlip) {
  const SecondSlip second(2e-6);
  for (const double length : {3e-6, 20e-6, 200e-6}) {
    const double direct = 0.004;
    const auto law = [](double speed) { return 0.318 + 0.191 * std::exp(-52.14 * speed); };
    const std::vector<double> p = {0.509, 0.318, 52.14, length, direct};
    const std::vector<double> mu = friction_along(healing(), p, second.slip);
    double theta = age(0, kLength + kRest, kRest, length), t = kLength + kRest;
    EXPECT_NEAR(break_away_level(healing(), p.data(), second.slip), law(length / theta), 1e-6) << length;
    for (std::size_t i = 0; i < mu.size(); i += 250) {
      theta = age(t, second.time[i], theta, length);
      t = second.time[i];
      EXPECT_NEAR(mu[i], law(length / theta) + direct * std::asinh(second.velocity[i] / 2e-3), 1e-6)
          << length << " " << t;
    }
  }
}

TEST(Healing, ConvergesWithTheSquareOfTheStep) {
  const std::vector<double> p = {0.509, 0.318, 52.14, 50e-6, 0};
  const auto worst = [&](double step) {
    const SecondSlip second(step);
    const std::vector<double> mu = friction_along(healing(), p, second.slip);
    double theta = age(0, kLength + kRest, kRest, 50e-6), t = kLength + kRest, off = 0;
    for (std::size_t i = 0; i < mu.size(); ++i) {
      theta = age(t, second.time[i], theta, 50e-6);
      t = second.time[i];
      off = std::max(off, std::abs(mu[i] - (0.318 + 0.191 * std::exp(-52.14 * 50e-6 / theta))));
    }
    return off;
  };
  const double coarse = worst(2e-4), fine = worst(5e-5);
  EXPECT_LT(coarse, 2e-3);
  EXPECT_NEAR(std::log2(coarse / fine) / 2, 2, 0.5);
}

TEST(Healing, SteadySlidingIsTheLawAtThatSpeed) {
  for (const Law base : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
    for (const double speed : {1e-5, 1e-3, 0.05, 5.0}) {
      std::vector<double> time, velocity(50, speed);
      for (std::size_t i = 0; i < velocity.size(); ++i) time.push_back(1e-3 * static_cast<double>(i));
      Slip slip;
      slip.time = time;
      slip.velocity = velocity;
      const double expected =
          base == Law(ExponentialLaw{}) ? 0.3 + 0.2 * std::exp(-50 * speed) : 0.3 + 0.2 / (1 + 50 * speed);
      const std::vector<double> mu = friction_along(healing(base), {0.5, 0.3, 50, 20e-6, 0.003}, slip);
      EXPECT_NEAR(mu.front(), expected + 0.003 * std::asinh(speed / 2e-3), 1e-12);
      EXPECT_NEAR(mu.back(), expected + 0.003 * std::asinh(speed / 2e-3), 1e-12);
    }
  }
}

TEST(Healing, BreakAwayGrowsWithTheTimeAtRestUpToStaticFriction) {
  SecondSlip second(1e-4);
  second.slip.earlier_time = second.slip.earlier_velocity = {};
  const std::vector<double> p = {0.5, 0.3, 50, 100e-6, 0};
  double last = 0;
  for (const double rest : {0.0, 0.001, 0.01, 0.1, 1.0, 100.0}) {
    second.slip.stick_time = rest;
    const double level = break_away_level(healing(), p.data(), second.slip);
    EXPECT_NEAR(level, rest > 0 ? 0.3 + 0.2 * std::exp(-50 * 100e-6 / rest) : 0.3, 1e-9);
    EXPECT_GT(level, last);
    last = level;
  }
  EXPECT_NEAR(last, 0.5, 2e-5);
  second.slip.stick_time = std::nan("");
  EXPECT_NEAR(break_away_level(healing(), p.data(), second.slip), 0.5, 2e-5);  // not recorded: at rest for long
}

TEST(Healing, ShortMemoryIsTheLawAlone) {
  const SecondSlip second(1e-5);
  const std::vector<double> with = friction_along(healing(), {0.509, 0.318, 52.14, 1e-9, 0}, second.slip);
  const std::vector<double> without =
      friction_along(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, second.slip);
  // Away from rest: within D_c of it every memory is long.
  for (std::size_t i = 200; i + 200 < with.size(); ++i) EXPECT_NEAR(with[i], without[i], 1e-4);
}

TEST(Healing, MemoriesAfterItStartFromItsBreakAway) {
  SecondSlip second(1e-5);
  const FrictionModel model(ExponentialLaw{}, {make_effect("rate-state:healing"), make_effect("frictional-lag")});
  std::vector<double> p = {0.509, 0.318, 52.14};
  for (const auto& slot : model.parameters().subspan(3)) p.push_back(slot.parameter.start * slot.parameter.si);
  p[model.offset_of("rate-state")] = 200e-6;
  p[model.offset_of("frictional-lag")] = 10;  // 10 s: nothing changes
  EXPECT_NEAR(friction_along(model, p, second.slip).front(), break_away_level(model, p.data(), second.slip), 1e-5);
  EXPECT_LT(break_away_level(model, p.data(), second.slip), 0.508);
}

TEST(Healing, OneInstantAtATimeIsTheSame) {
  const FrictionModel model = healing();
  FrictionDynamics friction(model, {0.509, 0.318, 52.14, 50e-6, 0.002});
  const std::vector<double> left = {0.004};
  std::vector<double> state(1), rate(1);
  friction.begin_stick(left);
  friction.begin_slip(0.2, 1);
  friction.states_at_break_away(state);
  EXPECT_DOUBLE_EQ(state[0], 0.204);
  EXPECT_NEAR(friction.break_away_friction({.velocity = 0}), 0.318 + 0.191 * std::exp(-52.14 * 50e-6 / 0.204), 1e-12);
  friction.rates({.velocity = 0.02}, state, rate);
  EXPECT_NEAR(rate[0], 1 - 0.02 * 0.204 / 50e-6, 1e-9);
  EXPECT_NEAR(friction.friction({.velocity = 0.02}, state),
              0.318 + 0.191 * std::exp(-52.14 * 50e-6 / 0.204) + 0.002 * std::asinh(10.0), 1e-12);
}

TEST(Healing, IsAFormOfRateState) {
  const EffectInfo info = describe(make_effect("rate-state:healing"));
  EXPECT_EQ(info.key, "rate-state");
  EXPECT_EQ(info.spelled(), "rate-state:healing");
  EXPECT_EQ(healing().name(), "exponential + rate-state:healing");
  EXPECT_EQ(healing().effect_keys(), std::vector<std::string>{"rate-state"});
  EXPECT_THROW(FrictionModel(ExponentialLaw{}, {make_effect("rate-state"), make_effect("rate-state:healing")}),
               InputError);
  EXPECT_THROW(FrictionModel(ExponentialLaw{}, {make_effect("bristle"), make_effect("rate-state:healing")}),
               InputError);
  EXPECT_FALSE(healing().acts_with(make_effect("bristle")));
  EXPECT_FALSE(FrictionModel(ExponentialLaw{}, {make_effect("bristle")}).acts_with(make_effect("rate-state:healing")));
  EXPECT_TRUE(healing().acts_with(make_effect("viscous")));
  for (const auto& [name, hint] :
       {std::pair("rate-state:heling", "rate-state:healing"), std::pair("rate-stat", "rate-state"),
        std::pair("runout:A=0.05", "write it as runout"), std::pair("runout:x", "runout")}) {
    try {
      make_effect(name);
      ADD_FAILURE() << name;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(hint));
    }
  }
}

}  // namespace
