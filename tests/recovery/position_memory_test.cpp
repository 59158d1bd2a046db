/// Friction that depends on the distance since a reversal, simulated with springs that slide and with a gap, each in a
/// few lines that share nothing with the library.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"

namespace {

using namespace tribofit;

/// Springs in parallel, each of which slides from its limit on. That one lets go at the distance x after a reversal has
/// the probability x exp(-x/d)/d^2: together they turn round as 1 - 2 exp(-x/d).
class Springs {
 public:
  Springs(double friction, double d) {
    constexpr int kCount = 400;
    for (int k = 0; k < kCount; ++k) {
      double low = 0, high = 60 * d;
      for (int halving = 0; halving < 60; ++halving) {
        const double x = 0.5 * (low + high);
        const double below = 1 - (1 + x / d) * std::exp(-x / d);
        (below < (k + 0.5) / kCount ? low : high) = x;
      }
      limits_.push_back(friction / kCount);
      stiffnesses_.push_back(2 * friction / kCount / low);
    }
    pulls_.assign(limits_.size(), 0.0);
  }
  double move(double dx) {
    double sum = 0;
    for (std::size_t k = 0; k < pulls_.size(); ++k) {
      pulls_[k] = std::clamp(pulls_[k] + stiffnesses_[k] * dx, -limits_[k], limits_[k]);
      sum += pulls_[k];
    }
    return sum;
  }

 private:
  std::vector<double> limits_, stiffnesses_, pulls_;
};

/// A gap with a stiff side at either end, which gives way by `give` before it carries all.
class Gap {
 public:
  Gap(double play, double give) : play_(play), give_(give) {}
  /// How much of the load the side in the direction of motion carries.
  double carries(double dx) {
    place_ = std::clamp(place_ + dx, 0.0, play_ + give_);
    return std::clamp((dx > 0 ? place_ - play_ : give_ - place_) / give_, 0.0, 1.0);
  }

 private:
  double play_, give_, place_ = 0;
};

/// Sliding at 500 Hz whose strokes and speeds differ: two frequencies, of which each swing has some of both. It begins
/// with a reversal and a long stroke: what is half-way when a record begins has a past that nobody knows.
double speed_at(double t) {
  const double turn = 2 * std::numbers::pi;
  return 0.05 * std::sin(turn * 0.31 * t) + 0.03 * std::sin(turn * 0.47 * t);
}

/// contact: what friction is at (v, dx), of which the law below is f(v).
std::shared_ptr<const Trace> record(const std::function<double(double, double, double)>& contact, std::uint64_t seed) {
  constexpr double kStep = 2e-3, kNoise = 0.003;
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> error(0, 1);
  Trace trace;
  trace.velocity_kind = VelocityKind::relative;
  for (double t = -20; t < 60; t += kStep) {
    constexpr int kParts = 10;
    double mu = 0;
    for (int part = 0; part < kParts; ++part) {  // to the instant t
      const double v = speed_at(t - (kParts - 1 - part) * kStep / kParts);
      const double law = 0.3 + 0.15 * std::exp(-std::abs(v) / 0.02);
      mu = contact(std::copysign(law, v), v, v * kStep / kParts);
    }
    if (t < 0) continue;
    trace.time.push_back(t);
    trace.velocity.push_back(speed_at(t) + 2e-5 * error(engine));
    trace.friction.push_back(mu + kNoise * error(engine));
  }
  return std::make_shared<const Trace>(std::move(trace));
}

DiagnosedTraces diagnosis_of(const std::shared_ptr<const Trace>& trace) {
  return diagnose(std::vector<TraceInput>{{"back and forth", {}, trace}}, IdentifyOptions{});
}

std::string rungs_of(const Diagnosis& diagnosis) {
  std::string text;
  for (const Rung& rung : diagnosis.ladder) {
    text += rung.added + " ";
    for (const std::string& other : rung.equivalent) text += "|" + other + " ";
  }
  return text;
}

/// Truth within twice the 95 % interval, which is a tenth of it at most.
void expect_found(const DiagnosedTraces& diagnosed, const std::string& key, const std::vector<double>& truth) {
  const Diagnosis& diagnosis = diagnosed.diagnosis;
  ASSERT_EQ(diagnosis.ladder.size(), 2u) << rungs_of(diagnosis);
  EXPECT_EQ(diagnosis.ladder[1].added, key) << rungs_of(diagnosis);
  EXPECT_TRUE(diagnosis.ladder[1].equivalent.empty()) << rungs_of(diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::effect_found);
  EXPECT_LT(diagnosis.ladder[1].held_out_rmse, 1.05 * 0.003);
  std::size_t k = 0;
  for (const FitParameter& p : diagnosed.rungs.back().parameters) {
    if (p.effect != key) continue;
    const double half = 0.5 * (p.upper95 - p.lower95);
    ASSERT_LT(k, truth.size());
    EXPECT_NEAR(p.value, truth[k], 2 * half) << p.parameter.name;
    EXPECT_LT(half, 0.1 * truth[k]) << p.parameter.name;
    ++k;
  }
  EXPECT_EQ(k, truth.size());
}

TEST(PositionMemory, SoftContactsAreNamed) {
  const double mu_h = 0.06, d_h = 0.008;
  for (const std::uint64_t seed : {1u, 2u}) {
    Springs springs(mu_h, d_h);
    const auto trace =
        record([&](double law, double v, double dx) { return law - std::copysign(mu_h, v) + springs.move(dx); }, seed);
    expect_found(diagnosis_of(trace), "hysteresis", {mu_h, d_h});
  }
}

/// What no effect of the catalogue is: friction that is higher after a reversal and falls with the distance slid.
TEST(PositionMemory, WhatDiesAwayWithTheDistanceHasAFormula) {
  const double higher = 0.05, length = 0.006;
  double slid = 0, before = 0;
  const auto trace = record(
      [&](double law, double v, double dx) {
        slid = v * before < 0 ? 0 : slid + std::abs(dx);
        before = v;
        return law + std::copysign(higher * std::exp(-slid / length), v);
      },
      3);
  const Diagnosis found = diagnosis_of(trace).diagnosis;
  EXPECT_EQ(found.verdict, Verdict::unexplained) << rungs_of(found);
  const std::size_t a = found.formula.find("; a="), l = found.formula.find("L=");
  ASSERT_NE(found.formula.find("a*exp(-reversal_distance/L)"), std::string::npos) << found.formula;
  ASSERT_TRUE(a != std::string::npos && l != std::string::npos) << found.formula;
  EXPECT_NEAR(std::stod(found.formula.substr(a + 4)), higher, 0.1 * higher) << found.formula;
  EXPECT_NEAR(std::stod(found.formula.substr(l + 2)), 1e3 * length, 0.1 * 1e3 * length) << found.formula;
}

TEST(PositionMemory, PlayIsNamed) {
  const double loss = 0.2, play = 0.011, give = 0.0006;
  for (const std::uint64_t seed : {3u, 4u}) {
    Gap gap(play, give);
    const auto trace =
        record([&](double law, double, double dx) { return (1 - loss * (1 - gap.carries(dx))) * law; }, seed);
    expect_found(diagnosis_of(trace), "backlash", {loss, play + 0.5 * give});
  }
}

TEST(PositionMemory, NothingIsNamedWithoutIt) {
  const auto trace = record([](double law, double, double) { return law; }, 5);
  const Diagnosis diagnosis = diagnosis_of(trace).diagnosis;
  EXPECT_EQ(diagnosis.verdict, Verdict::sufficient);
  EXPECT_EQ(diagnosis.ladder.size(), 1u) << rungs_of(diagnosis);
}

TEST(PositionMemory, CannotShowWhereNothingReverses) {
  Trace forward = *record([](double law, double, double) { return law; }, 7);
  for (double& v : forward.velocity) v = std::abs(v);
  for (double& mu : forward.friction) mu = std::abs(mu);
  const Diagnosis diagnosis = diagnosis_of(std::make_shared<const Trace>(std::move(forward))).diagnosis;
  for (const char* key : {"hysteresis", "backlash"}) {
    const auto found = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                                    [&](const EffectFinding& effect) { return effect.key == key; });
    ASSERT_NE(found, diagnosis.effects.end()) << key;
    EXPECT_EQ(found->status, EffectStatus::untestable) << key;
    EXPECT_EQ(found->reason, "the block slides in one direction only") << key;
  }
}

/// What no effect of the catalogue explains goes with the distance since a reversal all the same.
TEST(PositionMemory, OtherShapesGoWithTheDistanceSinceAReversal) {
  double gone = 0, last = 1;
  const auto trace = record(
      [&](double law, double v, double dx) {
        gone = v * last < 0 ? 0 : gone + std::abs(dx);
        last = v;
        return law + std::copysign(0.03 * std::sin(2 * std::numbers::pi * gone / 0.013), v);
      },
      6);
  const Diagnosis diagnosis = diagnosis_of(trace).diagnosis;
  ASSERT_FALSE(diagnosis.where.empty());
  EXPECT_EQ(diagnosis.where[0].variable, ResidualVariable::reversal_distance);
  EXPECT_GT(diagnosis.where[0].share, 0.5);
  ASSERT_FALSE(diagnosis.remaining.empty());
  EXPECT_EQ(diagnosis.remaining[0].variable, ResidualVariable::reversal_distance);
}

}  // namespace
