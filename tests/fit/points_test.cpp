#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/pipeline.hpp"

// Steady points: what comes out is what was put in, as often as the intervals say.

namespace tribofit {
namespace {

constexpr double kStatic = 0.5, kKinetic = 0.35, kDecay = 60, kViscous = 0.4;  // SI

double law(double v) {
  return kKinetic + (kStatic - kKinetic) * std::exp(-kDecay * v) + kViscous * v;
}

struct Table {
  std::size_t points = 72;
  double slowest = 1e-3, fastest = 0.5;
  bool both_directions = true;
  bool even = false;  ///< in speed, else in its logarithm
  double noise = 0.004;
  double ratio = 1;      ///< of friction backwards
  bool unequal = false;  ///< noise of half of the points is four times as large
  bool with_std_error = false;
};

std::shared_ptr<const Trace> make(const Table& t, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  auto trace = std::make_shared<Trace>();
  trace->path = "made";
  trace->kind = RecordKind::points;
  trace->velocity_kind = VelocityKind::relative;
  const std::size_t speeds = t.both_directions ? t.points / 2 : t.points;
  for (std::size_t i = 0; i < t.points; ++i) {
    const double u = static_cast<double>(i % speeds) / static_cast<double>(speeds - 1);
    const double v = t.even ? t.slowest + u * (t.fastest - t.slowest) : t.slowest * std::pow(t.fastest / t.slowest, u);
    const double error = t.noise * (t.unequal && i % 2 == 0 ? 4 : 1);
    const int sign = i < speeds ? 1 : -1;
    trace->time.push_back(static_cast<double>(i));
    trace->velocity.push_back(sign * v);
    trace->friction.push_back(sign * law(v) * (sign < 0 ? t.ratio : 1) + error * normal(engine));
    if (t.with_std_error) trace->friction_std_error.push_back(error);
  }
  trace->steps = {{0, t.points, "", {}}};
  return trace;
}

Identification fitted(std::shared_ptr<const Trace> trace, std::vector<Effect> effects = {Viscous{}}) {
  IdentifyOptions options;
  options.laws = {ExponentialLaw{}};
  options.effects = std::move(effects);
  Identification out = prepare_trace({"made", {}, std::move(trace)}, options);
  fit_trace(options, out);
  return out;
}

/// Part of the 95 % intervals that hold the truth.
double coverage(const Table& table, int runs) {
  const std::vector<double> truth = {kStatic, kKinetic, kDecay, kViscous};
  double held = 0;
  for (int run = 0; run < runs; ++run) {
    const Identification result = fitted(make(table, static_cast<std::uint64_t>(run) + 1));
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const FitParameter& p = result.fits.at(0).parameters.at(k);
      if (p.lower95 <= truth[k] && truth[k] <= p.upper95) held += 1;
    }
  }
  return held / (runs * static_cast<double>(truth.size()));
}

TEST(PointsFit, IntervalsHoldTheTruth) {
  for (const Table& table : {Table{.points = 12, .both_directions = false, .noise = 0.002}, Table{.points = 72},
                             Table{.points = 300, .slowest = 5e-5}, Table{.points = 60, .even = true},
                             Table{.points = 72, .unequal = true, .with_std_error = true}}) {
    const double part = coverage(table, 150);
    EXPECT_GT(part, 0.92) << table.points << " points from " << table.slowest;
    EXPECT_LT(part, 0.98) << table.points << " points from " << table.slowest;
  }
}

TEST(PointsFit, StandardErrorsMakeTheNoisyPointsCountForLess) {
  double with = 0, without = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    with += fitted(make({.unequal = true, .with_std_error = true}, seed)).fits[0].parameters[1].std_error;
    without += fitted(make({.unequal = true}, seed)).fits[0].parameters[1].std_error;
  }
  EXPECT_LT(with, 0.7 * without);
}

TEST(PointsFit, TheOrderOfTheRowsChangesNoDigit) {
  const auto trace = make({}, 7);
  auto other = std::make_shared<Trace>(*trace);
  for (std::vector<double>* channel : {&other->velocity, &other->friction}) {
    std::mt19937 engine(5);
    std::shuffle(channel->begin(), channel->end(), engine);
  }
  const Fit a = fitted(trace).fits[0], b = fitted(other).fits[0];
  EXPECT_EQ(a.values(), b.values());
  EXPECT_EQ(a.covariance, b.covariance);
  EXPECT_EQ(a.error.held_out_rmse, b.error.held_out_rmse);
}

TEST(PointsFit, TheLowestSpeedsAreSlidingAndTheFloorIsTheNoise) {
  const Identification result = fitted(make({.points = 400, .slowest = 5e-5}, 2));
  EXPECT_EQ(kind_of_record(result.motion, result.segmentation), RecordKind::points);
  EXPECT_EQ(samples_in_slip(result.segmentation), 400U);
  EXPECT_EQ(result.fits[0].observations, 400U);
  EXPECT_NEAR(result.fits[0].floor.rmse, 0.004, 0.0005);
  EXPECT_NEAR(result.fits[0].error.held_out_rmse, 0.004, 0.0005);
}

TEST(PointsFit, FrictionThatDiffersByDirectionIsAsymmetry) {
  const Identification result = fitted(make({.points = 200, .ratio = 0.9}, 2), {Viscous{}, Asymmetry{}});
  const FitParameter& ratio = result.fits[0].parameters[4];
  EXPECT_EQ(ratio.effect, "asymmetry");
  EXPECT_NEAR(ratio.value, 0.9, 4 * ratio.std_error);
  EXPECT_LT(ratio.std_error, 0.01);
}

TEST(PointsFit, FrictionWithoutASignTakesThatOfTheVelocity) {
  auto sizes = std::make_shared<Trace>(*make({}, 4));
  for (double& mu : sizes->friction) mu = std::abs(mu);
  EXPECT_EQ(fitted(sizes).fits[0].values(), fitted(make({}, 4)).fits[0].values());
}

TEST(PointsFit, WhatNeedsAnOrderInTimeIsRefused) {
  const Identification result = fitted(make({}, 4), {FrictionalLag{}});
  EXPECT_FALSE(result.analysed);
  EXPECT_THAT(result.warnings.back(), ::testing::HasSubstr("points have no order in time"));
  EXPECT_FALSE(fitted(make({}, 4), {Formula("slow = a*t; a=0.001")}).analysed);
  EXPECT_TRUE(fitted(make({}, 4), {Formula("hump = a*exp(-(v/w)^2); a=0.01, w=6mm/s")}).analysed);
}

TEST(PointsFit, TooFewPointsFitNothing) {
  const Identification four = fitted(make({.points = 4, .both_directions = false}, 1));
  EXPECT_FALSE(four.analysed);
  const Identification five = fitted(make({.points = 5, .both_directions = false}, 1), {Viscous{}, StribeckExponent{}});
  EXPECT_FALSE(five.fits.at(0).converged);
  EXPECT_THAT(five.fits[0].messages.front(), ::testing::HasSubstr("5 values for 5 parameters"));
}

/// The base law alone misses the rise with speed: the diagnosis finds it, and nothing else.
TEST(PointsFit, TheDiagnosisFindsWhatIsMissing) {
  IdentifyOptions options;
  const DiagnosedTraces found = diagnose({{"made", {}, make({.points = 120}, 11)}}, options);
  ASSERT_EQ(found.diagnosis.ladder.size(), 2U);
  EXPECT_EQ(found.diagnosis.ladder[1].added, "viscous");
  EXPECT_EQ(found.diagnosis.verdict, Verdict::effect_found);
  for (const EffectFinding& effect : found.diagnosis.effects) {
    if (effect.key == "frictional-lag") {
      EXPECT_EQ(effect.status, EffectStatus::untestable);
    }
  }
  const DiagnosedTraces few = diagnose({{"made", {}, make({.points = 10, .both_directions = false}, 1)}}, options);
  EXPECT_EQ(few.diagnosis.verdict, Verdict::not_enough_data);
  EXPECT_THAT(few.diagnosis.messages.front(), ::testing::HasSubstr("there are 10 points"));
}

}  // namespace
}  // namespace tribofit
