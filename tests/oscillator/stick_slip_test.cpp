#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

#include "rigs.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/oscillator/sensors.hpp"

namespace tribofit {
namespace {

/// mu_k + (mu_s - mu_k) exp(-alpha v) of the case, with an offset on mu_s.
double exponential(const Case& c, double speed, double offset = 0) {
  return c.p[1] + (c.p[0] + offset - c.p[1]) * std::exp(-c.p[2] * speed);
}

TEST(StickSlip, PublishedFrequencies) {
  const std::vector<double> radii = {0.009, 0.012, 0.015, 0.018};
  const std::vector<double> published = {3.662, 4.272, 4.883, 5.493};  // [D] Table, exponential
  const std::vector<double> fractional = {4.04, 4.75, 5.46, 6.09};     // the same rigs, computed elsewhere
  const std::vector<double> amplitude = {56.5, 66.2, 83.9, 72.7};      // mm/s
  for (std::size_t i = 0; i < radii.size(); ++i) {
    SimulationOptions options{.duration = 20, .rate = 5000, .settle = 3};
    const SimulatedMotion motion = simulate(published_case(radii[i], ExponentialLaw{}), options);
    EXPECT_NEAR(1 / mean_period(motion), published[i], 0.01 * published[i]) << radii[i];
    const double peak = *std::max_element(motion.relative_velocity.begin(), motion.relative_velocity.end());
    EXPECT_NEAR(1e3 * peak, amplitude[i], 0.015 * amplitude[i]) << radii[i];
    const SimulatedMotion other = simulate(published_case(radii[i], FractionalLaw{}), options);
    EXPECT_NEAR(1 / mean_period(other), fractional[i], 0.003 * fractional[i]) << radii[i];
  }
}

// Each slip begins at x = x_break with the velocity of the disc, so all are alike. How long one lasts and where it ends
// was computed with 25 digits by mpmath 1.3 (odefun, a Taylor series):
//   f = odefun(lambda t, y: [y[1], (N*(mu_k + (mu_s - mu_k)*exp(-alpha*(V - y[1]))) - c*y[1] - k*y[0])/m], 0, [x_break,
//   V]) T = findroot(lambda t: V - f(t)[1], (0.029, 0.03), solver='anderson'); print(T, f(T)[0])
TEST(StickSlip, SlipsAgreeWithATaylorSeries) {
  const double slip_time = 0.029554974325347709, x_end = 0.00046675895575892678;
  const Case c = published_case(0.015, ExponentialLaw{});
  const double v = 0.015 * 4 * 2 * std::numbers::pi / 60;
  const double x_break = (c.drive.mean_load * c.p[0] - c.rig.damping * v) / c.rig.stiffness;
  const SimulatedMotion motion = simulate(c, {.duration = 60, .rate = 0});
  double break_away = x_break / v;  // the spring winds up from zero
  ASSERT_GT(motion.slips.size(), 290U);
  for (std::size_t i = 0; i + 1 < motion.slips.size(); ++i) {
    const SimulatedSlip& slip = motion.slips[i];
    EXPECT_NEAR(slip.break_away_time, break_away, 1e-9 * static_cast<double>(i + 1));
    EXPECT_NEAR(slip.restick_time - slip.break_away_time, slip_time, 2e-9);
    break_away += slip_time + (x_break - x_end) / v;
  }
}

TEST(StickSlip, EachSlipUsesItsOwnStaticFriction) {
  const Case c = published_case(0.015, ExponentialLaw{});
  const double deviation = 0.004, wander = 0.7;
  const SimulatedMotion motion =
      simulate(c, {.duration = 600, .rate = 1000, .settle = 3, .scatter = {deviation, wander}, .seed = 5});
  std::size_t k = 0;
  double squares = 0, products = 0;
  for (std::size_t i = 0; i < motion.slips.size(); ++i) {
    const SimulatedSlip& slip = motion.slips[i];
    EXPECT_NEAR(slip.break_away_friction, c.p[0] + slip.mu_s_offset, 1e-9);
    for (; k < motion.size() && motion.time[k] < slip.break_away_time; ++k) {
      ASSERT_TRUE(motion.sticks[k]);
      ASSERT_EQ(motion.relative_velocity[k], 0);
    }
    for (; k < motion.size() && !(motion.time[k] >= slip.restick_time); ++k) {
      ASSERT_FALSE(motion.sticks[k]);
      ASSERT_NEAR(motion.friction[k], exponential(c, motion.relative_velocity[k], slip.mu_s_offset), 1e-12);
    }
    squares += slip.mu_s_offset * slip.mu_s_offset;
    if (i > 0) products += slip.mu_s_offset * motion.slips[i - 1].mu_s_offset;
  }
  const double n = static_cast<double>(motion.slips.size());
  // Four standard errors: variance sqrt(2/n (1+r^2)/(1-r^2)), correlation sqrt((1-r^2)/n).
  const double inflation = std::sqrt((1 + wander * wander) / (1 - wander * wander));
  EXPECT_NEAR(squares / n / (deviation * deviation), 1, 4 * std::sqrt(2 / n) * inflation);
  EXPECT_NEAR(products / squares, wander, 4 * std::sqrt((1 - wander * wander) / n));
}

TEST(StickSlip, ForceBalanceHoldsAtEverySample) {
  Case c = published_case(0.018, FractionalLaw{});
  c.drive.load = [](double t) { return 50 + 5 * std::sin(7 * t); };
  c.drive.speed = run_up_speed(0.42, 1);
  const double rate = 100000;
  const SimulatedMotion motion = simulate(c, {.duration = 3, .rate = rate});
  for (std::size_t i = 1; i + 1 < motion.size(); ++i) {
    // Where nothing jumps, x and v are integrals of v and a.
    if (motion.sticks[i - 1] != motion.sticks[i + 1] || std::abs(motion.time[i] - 1) < 2 / rate) continue;
    EXPECT_NEAR((motion.velocity[i + 1] - motion.velocity[i - 1]) * rate / 2, motion.acceleration[i], 3e-3);
    EXPECT_NEAR((motion.displacement[i + 1] - motion.displacement[i - 1]) * rate / 2, motion.velocity[i], 1e-6);
  }
  for (const SimulatedSlip& slip : motion.slips) EXPECT_NEAR(slip.break_away_friction, c.p[0], 1e-9);
  EXPECT_GT(motion.slips.size(), 8U);
}

TEST(StickSlip, RunUpStartsAtRest) {
  Case c = published_case(0.015, ExponentialLaw{});
  const double omega = 4 * 2 * std::numbers::pi / 60;
  c.drive.speed = run_up_speed(omega, 1);
  const SimulatedMotion motion = simulate(c, {.duration = 3, .rate = 1000});
  EXPECT_EQ(motion.velocity[0], 0);
  EXPECT_FALSE(motion.settled);
  EXPECT_NEAR(motion.velocity[500], 0.5 * omega * c.drive.radius, 1e-12);  // still stuck: half the speed
  EXPECT_NEAR(motion.disc_angle[1000], 0.5 * omega, 1e-12);
  EXPECT_NEAR(motion.disc_angle[2000], 1.5 * omega, 1e-12);
  // In stick the spring alone makes friction: k x + c v + m a over N.
  const double x = 0.5 * omega * 0.25 * c.drive.radius;
  const double expected =
      (c.rig.stiffness * x + c.rig.damping * motion.velocity[500] + c.rig.mass * omega * c.drive.radius) / 50;
  EXPECT_NEAR(motion.friction[500], expected, 1e-9);
}

TEST(StickSlip, ReversingDriveIsSymmetric) {
  Case c = published_case(0.015, ExponentialLaw{});
  c.drive.speed = reversing_speed(4, 0.5);
  const SimulatedMotion motion = simulate(c, {.duration = 8, .rate = 5000});
  int forward = 0, backward = 0;
  for (const SimulatedSlip& slip : motion.slips) {
    if (slip.break_away_time > 2) (slip.direction > 0 ? forward : backward)++;
  }
  EXPECT_EQ(forward, backward);
  EXPECT_GT(forward, 10);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (motion.sticks[i]) continue;
    const double v = motion.relative_velocity[i];
    ASSERT_NEAR(motion.friction[i], std::copysign(exponential(c, std::abs(v)), v), 1e-12);
  }
}

// The disc shakes harder than friction can carry the block along: m v_disc' > N mu_s where v_r = 0.
TEST(StickSlip, MotionTurnsRoundWhereFrictionCannotHoldTheBlock) {
  Case c = published_case(0.015, CoulombLaw{});
  c.p = {0.2, 0.2};
  c.drive.speed = reversing_speed(67, 20);  // 126 m/s^2
  const SimulatedMotion motion = simulate(c, {.duration = 5, .rate = 2000});
  bool turned = false;
  for (std::size_t i = 1; i < motion.slips.size(); ++i) {
    turned |= motion.slips[i].stick_time == 0 && motion.slips[i].direction != motion.slips[i - 1].direction;
  }
  EXPECT_TRUE(turned);
}

TEST(StickSlip, SteadySlidingRestsAtTheLaw) {
  Case c = published_case(0.015, ExponentialLaw{});
  c.rig = rig_with_damping_ratio(c.rig.mass, c.rig.stiffness, 3);  // above the slope N |dmu/dv| of the law
  const SimulatedMotion motion = simulate(c, {.duration = 2, .rate = 1000, .settle = 5});
  const double v = c.drive.radius * 4 * 2 * std::numbers::pi / 60;
  EXPECT_EQ(motion.break_away_count(), 0U);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    ASSERT_NEAR(motion.velocity[i], 0, 1e-6);
    ASSERT_NEAR(motion.displacement[i], 50 * exponential(c, v) / c.rig.stiffness, 1e-7);
  }
  // Sliding distance counts from the first sample.
  EXPECT_EQ(motion.distance[0], 0);
  EXPECT_NEAR(motion.distance.back(), v * motion.time.back(), 1e-6);
}

TEST(StickSlip, FrictionThatRisesWithSpeedSlidesOn) {
  Case c = published_case(0.015, ExponentialLaw{});
  c.p = {0.3, 0.5, 52};
  const SimulatedMotion motion = simulate(c, {.duration = 2, .rate = 1000, .settle = 5});
  EXPECT_EQ(motion.break_away_count(), 0U);
  EXPECT_NEAR(motion.friction.back(), exponential(c, c.drive.radius * 4 * 2 * std::numbers::pi / 60), 1e-6);
}

// A term in the block's acceleration makes friction depend on what it causes.
TEST(StickSlip, FrictionAndAccelerationAreConsistent) {
  Case c = published_case(0.015, ExponentialLaw{});
  c.model = FrictionModel(ExponentialLaw{}, {Formula("inertia = b*acceleration; b=1e-6")});  // acceleration in mm/s^2
  c.p.push_back(1e-6);
  const SimulatedMotion motion = simulate(c, {.duration = 2, .rate = 5000, .settle = 3});
  EXPECT_GT(motion.break_away_count(), 5U);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    if (motion.sticks[i]) continue;
    const double expected = exponential(c, motion.relative_velocity[i]) + 1e-6 * 1e3 * motion.acceleration[i];
    ASSERT_NEAR(motion.friction[i], expected, 1e-10);
  }
}

// Friction that rises at once with motion holds the block, although the spring is past its static friction.
TEST(StickSlip, ABlockThatCannotStartStaysStuck) {
  Case c = published_case(0.015, CoulombLaw{});
  c.p = {0.3, 0.5};
  const SimulatedMotion motion = simulate(c, {.duration = 3, .rate = 1000});
  ASSERT_EQ(motion.slips.size(), 1U);
  // It starts once the spring is past 0.5, found to within the march of a sixteenth of the natural period.
  EXPECT_GT(motion.slips[0].break_away_friction, 0.5);
  EXPECT_LT(motion.slips[0].break_away_friction, 0.51);
}

TEST(StickSlip, SpeedProfilesAreConsistent) {
  const std::vector<SpeedProfile> profiles = {constant_speed(0.4), reversing_speed(2, 0.7), run_up_speed(0.4, 1),
                                              piecewise_linear_speed({-0.5, 0.3, 2}, {1, -1, 0.5})};
  for (const SpeedProfile& profile : profiles) {
    EXPECT_NEAR(profile.angle(0), 0, 1e-15);
    for (const double t : {-0.9, -0.2, 0.1, 0.77, 1.5, 3.1}) {
      const double h = 1e-6;
      EXPECT_NEAR((profile.angle(t + h) - profile.angle(t - h)) / (2 * h), profile.speed(t), 1e-8);
      EXPECT_NEAR((profile.speed(t + h) - profile.speed(t - h)) / (2 * h), profile.acceleration(t), 1e-7);
    }
  }
  EXPECT_THROW(piecewise_linear_speed({0, 0}, {1, 2}), InputError);
  EXPECT_THROW(piecewise_linear_speed({}, {}), InputError);
}

TEST(StickSlip, WhatCannotBeIsRefused) {
  const Case good = published_case(0.015, ExponentialLaw{});
  const auto refused = [&](auto&& change) {
    Case c = good;
    SimulationOptions options;
    change(c, options);
    EXPECT_THROW(simulate(c, options), InputError);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  refused([](Case& c, auto&) { c.rig.mass = -1; });
  refused([](Case& c, auto&) { c.rig.stiffness = 0; });
  refused([](Case& c, auto&) { c.rig.damping = -1; });
  refused([](Case& c, auto&) { c.drive.radius = 0; });
  refused([](Case& c, auto&) { c.drive.mean_load = -50; });
  refused([](Case& c, auto&) { c.drive.speed = {}; });
  refused([](Case& c, auto&) { c.p.pop_back(); });
  refused([nan](Case& c, auto&) { c.p[0] = nan; });
  refused([](Case& c, auto&) { c.drive.load = [](double) { return -1.0; }; });
  refused([nan](Case& c, auto&) { c.drive.load = [nan](double) { return nan; }; });
  refused([](Case&, auto& o) { o.duration = 0; });
  refused([nan](Case&, auto& o) { o.duration = nan; });
  refused([](Case&, auto& o) { o.rate = -1; });
  refused([](Case&, auto& o) { o.scatter.wander = 1; });
  refused([](Case&, auto& o) { o.scatter.deviation = -0.1; });
}

}  // namespace
TEST(StickSlip, ChannelsThatAreLeftOutChangeNothingElse) {
  const Case c = published_case(0.015, ExponentialLaw{});
  SimulationOptions options;
  options.duration = 2;
  const SimulatedMotion whole = simulate(c, options);
  options.channels = {.displacement = false, .acceleration = false, .disc = false, .distance = false};
  const SimulatedMotion part = simulate(c, options);
  ASSERT_EQ(part.size(), whole.size());
  EXPECT_EQ(part.velocity, whole.velocity);
  EXPECT_EQ(part.friction, whole.friction);
  EXPECT_EQ(part.relative_velocity, whole.relative_velocity);
  EXPECT_EQ(part.slips.size(), whole.slips.size());
  EXPECT_TRUE(part.displacement.empty() && part.acceleration.empty() && part.disc_speed.empty());
  EXPECT_TRUE(part.disc_angle.empty() && part.distance.empty());
  EXPECT_FALSE(whole.displacement.empty() || whole.acceleration.empty() || whole.disc_speed.empty());
  // Sensors that ask for none of them read the same.
  EXPECT_EQ(record(part, c.model, c.p).trace.friction, record(whole, c.model, c.p).trace.friction);
  EXPECT_EQ(record(part, c.model, c.p).trace.conditions.speed.value,
            record(whole, c.model, c.p).trace.conditions.speed.value);
}

}  // namespace tribofit
