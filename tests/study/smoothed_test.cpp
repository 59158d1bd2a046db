#include "tribofit/study/smoothed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

/// [U] Fig 2 in N, mm, s with the mass in t; c_v is not printed.
constexpr double kDecay = 330;  // s/m
const Rig kRig{1000, 200, 5000};
constexpr double kDisc = 0.5e-3, kLoad = 10;

Drive drive_at(double velocity) {
  return {.speed = constant_speed(velocity), .radius = 1, .mean_load = kLoad};
}

SmoothedLaw law_of(double sharpness_s_per_mm, ArctangentReading reading = ArctangentReading::smooth) {
  return {.mu_brk = 0.6, .mu_c = 0.1, .decay = kDecay, .sharpness = 1e3 * sharpness_s_per_mm, .reading = reading};
}

struct Measures {
  double period = 0, stick_time = 0, peak_to_peak = 0;
};

/// Of the motion after its third break-away.
Measures measures_of(const SimulatedMotion& motion) {
  const auto& slips = motion.slips;
  const std::size_t last = slips.size() - 2;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const TurningPoint& point : motion.turning_points) {
    if (point.time < slips[3].break_away_time) continue;
    low = std::min(low, point.displacement);
    high = std::max(high, point.displacement);
  }
  return {(slips[last].break_away_time - slips[3].break_away_time) / static_cast<double>(last - 3),
          slips[last].stick_time, high - low};
}

TEST(Smoothed, IsTheLawAsWritten) {
  const double mm = 1e3;  // per m
  for (const double v : {-3e-3, -1e-6, 0.0, 2e-6, 0.5e-3, 7e-3}) {
    const double arctangent = 2 / std::numbers::pi * std::atan(500 * mm * v);
    const double fall = std::exp(-0.33 * mm * std::abs(v));
    SmoothedLaw law = law_of(500);
    law.viscous = 0.004 * mm;
    EXPECT_NEAR(law.friction(v), (0.1 + 0.5 * fall) * arctangent + 0.004 * mm * v, 1e-15);
    EXPECT_DOUBLE_EQ(law.friction(-v), -law.friction(v));
    for (const auto reading : {ArctangentReading::smooth, ArctangentReading::as_printed}) {
      law.reading = reading;
      const double h = 1e-9;
      EXPECT_NEAR(law.slope(v), (law.friction(v + h) - law.friction(v - h)) / (2 * h), 1e-3 * std::abs(law.slope(0)));
    }
    EXPECT_NEAR(law.friction(v), 0.1 + 0.5 * fall * arctangent + 0.004 * mm * v, 1e-15);
  }
}

// What is printed still pulls with mu_c at rest and pushes a fast backward motion on; with the sign of v_r on mu_c it
// jumps by 2 mu_c.
TEST(Smoothed, AsPrintedTheLawIsNotFriction) {
  const SmoothedLaw printed = law_of(500, ArctangentReading::as_printed), smooth = law_of(500);
  EXPECT_EQ(printed.friction(0), 0.1);
  EXPECT_EQ(smooth.friction(0), 0);
  EXPECT_GT(printed.friction(-10e-3), 0);
  EXPECT_LT(smooth.friction(-10e-3), 0);
  EXPECT_NEAR(printed.friction(1e-3), smooth.friction(1e-3), 2e-4);
}

TEST(Smoothed, CrestIsWhereFrictionIsLargest) {
  for (const double sharpness : {50.0, 500.0, 1e5}) {
    for (const auto reading : {ArctangentReading::smooth, ArctangentReading::as_printed}) {
      const SmoothedLaw law = law_of(sharpness, reading);
      const double crest = law.crest(), top = law.friction(crest);
      for (double v = 1e-3 * crest; v < 100 * crest; v *= 1.01) EXPECT_LE(law.friction(v), top);
    }
  }
  // Leading order for sharp laws.
  const SmoothedLaw sharp = law_of(1e6);
  EXPECT_NEAR((0.6 - sharp.friction(sharp.crest())) / std::sqrt(8 / std::numbers::pi * 0.6 * 0.5 * kDecay / 1e9), 1,
              0.01);
  SmoothedLaw rising = law_of(500);
  rising.viscous = 300;
  EXPECT_TRUE(std::isinf(rising.crest()));
}

// The same equation by classical Runge-Kutta with steps far below the fastest time of the law.
TEST(Smoothed, MotionAgreesWithAnExplicitIntegration) {
  const SmoothedLaw law = law_of(20);
  const double duration = 15, step = 2e-4;
  const SimulatedMotion motion = simulate_smoothed(kRig, drive_at(kDisc), law, {.duration = duration, .rate = 100});
  std::array<double, 2> y{0, 0};
  const auto rates = [&](const std::array<double, 2>& z) {
    const double mu = law.friction(kDisc - z[1]);
    return std::array<double, 2>{z[1], (kLoad * mu - kRig.damping * z[1] - kRig.stiffness * z[0]) / kRig.mass};
  };
  const auto moved = [&](const std::array<double, 2>& rate, double h) {
    return std::array<double, 2>{y[0] + h * rate[0], y[1] + h * rate[1]};
  };
  std::size_t sample = 0;
  for (int i = 0; sample < motion.size(); ++i) {
    if (i % 50 == 0) {
      ASSERT_NEAR(motion.time[sample], i * step, 1e-9);
      ASSERT_NEAR(motion.displacement[sample], y[0], 1e-10);  // of 0.6 mm
      ASSERT_NEAR(motion.velocity[sample], y[1], 1e-9);
      ++sample;
    }
    const auto k1 = rates(y), k2 = rates(moved(k1, step / 2)), k3 = rates(moved(k2, step / 2)),
               k4 = rates(moved(k3, step));
    for (std::size_t k = 0; k < 2; ++k) y[k] += step / 6 * (k1[k] + 2 * k2[k] + 2 * k3[k] + k4[k]);
  }
}

TEST(Smoothed, RecordIsConsistent) {
  const SimulatedMotion motion =
      simulate_smoothed(kRig, drive_at(kDisc), law_of(500), {.duration = 20, .rate = 1000, .settle = 8});
  ASSERT_EQ(motion.size(), 20000U);
  std::size_t turns = 0;
  for (std::size_t i = 1; i < motion.size(); ++i) {
    const double force =
        kLoad * motion.friction[i] - kRig.damping * motion.velocity[i] - kRig.stiffness * motion.displacement[i];
    ASSERT_NEAR(kRig.mass * motion.acceleration[i], force, 1e-9);
    ASSERT_EQ(motion.relative_velocity[i], kDisc - motion.velocity[i]);
    if (motion.velocity[i - 1] * motion.velocity[i] < 0) {
      const TurningPoint& turn = motion.turning_points.at(turns++);
      EXPECT_NEAR(turn.time, motion.time[i], 1.001e-3);
      EXPECT_NEAR(turn.displacement, motion.displacement[i], 1e-8);
      EXPECT_EQ(turn.is_maximum, motion.velocity[i - 1] > 0);
    }
  }
  EXPECT_EQ(turns, motion.turning_points.size());
  EXPECT_NEAR(motion.distance.back(), kDisc * motion.time.back() - motion.displacement.back() + motion.displacement[0],
              1e-6);  // what the creep backwards after a re-stick adds
  for (const SimulatedSlip& slip : motion.slips) {
    for (std::size_t i = 0; i < motion.size(); ++i) {
      if (motion.time[i] > slip.break_away_time && motion.time[i] < slip.restick_time) {
        ASSERT_FALSE(motion.sticks[i]);
        ASSERT_LE(motion.relative_velocity[i], slip.peak_speed * (1 + 1e-9));
      }
    }
  }
}

TEST(Smoothed, StartsAtRestLikeTheSources) {
  const SimulatedMotion motion = simulate_smoothed(kRig, drive_at(kDisc), law_of(500), {.duration = 5, .rate = 100});
  EXPECT_EQ(motion.displacement[0], 0);
  EXPECT_EQ(motion.velocity[0], 0);
  ASSERT_FALSE(motion.slips.empty());
  EXPECT_TRUE(std::isnan(motion.slips[0].break_away_time));  // the disc slides under it until it is carried along
  EXPECT_GT(motion.slips[0].restick_time, 0);
  EXPECT_NEAR(motion.slips[0].peak_speed, kDisc, 1e-9);
}

// The crest of the law is below mu_brk by a term in 1/sqrt(s), so the block breaks away too early; what the block gains
// while it passes the crest makes up for a part of it. Differences fall between s^-1/2 and s^-0.8.
TEST(Smoothed, TendsToTheEventLocatedMotionAsItSharpens) {
  const FrictionModel model(ExponentialLaw{});
  const std::vector<double> p{0.6, 0.1, kDecay};
  const Measures exact = measures_of(simulate(kRig, drive_at(kDisc), model, p, {.duration = 60, .rate = 0}));
  double last_period = 0, last_swing = 0;
  for (const double sharpness : {1e2, 1e3, 1e4, 1e5, 1e6}) {
    SCOPED_TRACE(sharpness);
    const SmoothedLaw law = smoothed_law(model, p, 1e3 * sharpness);
    const Measures here = measures_of(simulate_smoothed(kRig, drive_at(kDisc), law, {.duration = 60, .rate = 0}));
    const double period = exact.period - here.period, swing = exact.peak_to_peak - here.peak_to_peak;
    EXPECT_GT(period, 0);
    EXPECT_GT(swing, 0);
    if (last_period > 0) {
      EXPECT_GT(std::log10(last_period / period), 0.5);
      EXPECT_LT(std::log10(last_period / period), 0.8);
      EXPECT_GT(std::log10(last_swing / swing), 0.5);
      EXPECT_LT(std::log10(last_swing / swing), 0.8);
    }
    last_period = period;
    last_swing = swing;
    EXPECT_NEAR(here.stick_time / exact.stick_time, 1, sharpness < 1e3 ? 0.15 : 0.04);
  }
  EXPECT_LT(last_period / exact.period, 5e-4);
}

TEST(Smoothed, ViscousTermIsThatOfTheEffect) {
  const FrictionModel model(ExponentialLaw{}, {Viscous{}});
  const std::vector<double> p{0.6, 0.1, kDecay, 20};
  const Measures exact = measures_of(simulate(kRig, drive_at(kDisc), model, p, {.duration = 60, .rate = 0}));
  const SmoothedLaw law = smoothed_law(model, p, 1e9);
  EXPECT_EQ(law.viscous, 20);
  const Measures here = measures_of(simulate_smoothed(kRig, drive_at(kDisc), law, {.duration = 60, .rate = 0}));
  EXPECT_NEAR(here.period / exact.period, 1, 1e-3);
  EXPECT_NEAR(here.peak_to_peak / exact.peak_to_peak, 1, 2e-3);
}

// v_r > 0 but for the end of a slip, so the reading of the arctangent hardly matters to [U]'s figures.
TEST(Smoothed, ReadingsGiveNearlyTheSameMotion) {
  const auto measures = [&](ArctangentReading reading) {
    return measures_of(simulate_smoothed(kRig, drive_at(kDisc), law_of(500, reading), {.duration = 60, .rate = 0}));
  };
  const Measures smooth = measures(ArctangentReading::smooth), printed = measures(ArctangentReading::as_printed);
  EXPECT_NEAR(printed.period / smooth.period, 1, 0.01);
  EXPECT_NEAR(printed.peak_to_peak / smooth.peak_to_peak, 1, 0.02);
  EXPECT_NE(printed.period, smooth.period);
}

TEST(Smoothed, WhatCannotBeIsRefused) {
  const auto refused = [&](auto&& change) {
    Rig rig = kRig;
    Drive drive = drive_at(kDisc);
    SmoothedLaw law = law_of(500);
    SmoothedOptions options{.rate = 0};
    change(rig, drive, law, options);
    EXPECT_THROW(simulate_smoothed(rig, drive, law, options), InputError);
  };
  refused([](Rig& r, auto&, auto&, auto&) { r.mass = -1; });
  refused([](auto&, Drive& d, auto&, auto&) { d.mean_load = 0; });
  refused([](auto&, Drive& d, auto&, auto&) { d.speed = {}; });
  refused([](auto&, auto&, SmoothedLaw& l, auto&) { l.sharpness = 0; });
  refused([](auto&, auto&, SmoothedLaw& l, auto&) { l.decay = -1; });
  refused([](auto&, auto&, SmoothedLaw& l, auto&) { l.mu_brk = 0; });
  refused([](auto&, auto&, SmoothedLaw& l, auto&) { l.viscous = std::nan(""); });
  refused([](auto&, auto&, auto&, SmoothedOptions& o) { o.duration = 0; });
  refused([](auto&, auto&, auto&, SmoothedOptions& o) { o.stick_share = 1; });
  refused([](auto&, auto&, auto&, SmoothedOptions& o) { o.tolerance = 0; });
  refused([](auto&, auto&, auto&, SmoothedOptions& o) { o.start.velocity = std::nan(""); });
  const std::vector<double> p{0.6, 0.1, kDecay};
  EXPECT_THROW(smoothed_law(FrictionModel(FractionalLaw{}), p, 1), InputError);
  EXPECT_THROW(smoothed_law(FrictionModel(CoulombLaw{}), p, 1), InputError);
}

// Beyond what doubles can hold the integrator gives up, and says where.
TEST(Smoothed, ALawTooSharpIsRefusedWithWhatWasSeen) {
  try {
    simulate_smoothed(kRig, drive_at(kDisc), law_of(1e12), {.duration = 60, .rate = 0});
    FAIL() << "should have given up";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("beyond t = "));
    EXPECT_THAT(error.what(), ::testing::HasSubstr("steps"));
  }
}

}  // namespace
}  // namespace tribofit
