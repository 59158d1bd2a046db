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
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"

// A slider that a spring draws, of which only the pull is recorded; simulated apart from the library.

namespace tribofit {
namespace {

using ::testing::HasSubstr;

struct Slider {
  double stiffness = 168, drive = 1.1e-3, mass = 0.0307, load = 0.301;  // SI
  double mu_s = 0.42, mu_k = 0.32, decay = 150, scatter = 0.003;
  double duration = 15, rate = 2000, range = 1;  ///< [s], [Hz], of a converter with 12 bits [1]
  std::uint64_t seed = 1;
};

struct Drawn {
  std::shared_ptr<Trace> trace = std::make_shared<Trace>();
  std::vector<double> velocity, friction;  ///< of the slider
};

/// Runge-Kutta of fourth order, twenty steps a sample; stick until the pull exceeds mu_s.
class Simulation {
 public:
  explicit Simulation(const Slider& slider)
      : s_(slider), stretch_(0.9 * s_.mu_s * s_.load / s_.stiffness), mu_s_(s_.mu_s), random_(s_.seed) {}

  Drawn run() {
    constexpr int kSteps = 20;
    constexpr double kSettle = 2;
    const double h = 1 / (kSteps * s_.rate), digit = s_.range / 4096;
    for (double t = 0; t < kSettle; t += h) step(h);
    Drawn out;
    Trace& trace = *out.trace;
    for (std::size_t i = 0; i < static_cast<std::size_t>(s_.duration * s_.rate); ++i) {
      const double pull = s_.stiffness * stretch_ / s_.load;
      trace.time.push_back(static_cast<double>(i) / s_.rate);
      trace.friction.push_back(std::round(pull / digit) * digit);
      out.velocity.push_back(velocity_);
      out.friction.push_back(sticks_ ? pull : pull - s_.mass * acceleration(stretch_, velocity_) / s_.load);
      for (int k = 0; k < kSteps; ++k) step(h);
    }
    trace.path = "simulated";
    trace.kind = RecordKind::spring_slider;
    trace.velocity_kind = VelocityKind::relative;
    trace.spring.velocity = {s_.drive, "test"};
    trace.spring.stiffness = {s_.stiffness, "test"};
    trace.conditions.load = {s_.load, "test"};
    trace.steps = {{0, trace.time.size(), "", trace.conditions}};
    return out;
  }

 private:
  /// Within a step the slider goes on forwards: what turns round is at rest at its end.
  double friction(double v) const { return s_.mu_k + (mu_s_ - s_.mu_k) * std::exp(-s_.decay * std::abs(v)); }
  double acceleration(double stretch, double v) const {
    return (s_.stiffness * stretch - s_.load * friction(v)) / s_.mass;
  }

  void step(double h) {
    if (sticks_) {
      stretch_ += h * s_.drive;
      sticks_ = s_.stiffness * stretch_ <= s_.load * mu_s_;
      velocity_ = 0;
      return;
    }
    double slope[4][2], x = stretch_, v = velocity_;
    for (int k = 0; k < 4; ++k) {
      slope[k][0] = s_.drive - v;
      slope[k][1] = acceleration(x, v);
      const double part = k < 2 ? h / 2 : h;
      x = stretch_ + part * slope[k][0];
      v = velocity_ + part * slope[k][1];
    }
    stretch_ += h / 6 * (slope[0][0] + 2 * slope[1][0] + 2 * slope[2][0] + slope[3][0]);
    velocity_ += h / 6 * (slope[0][1] + 2 * slope[1][1] + 2 * slope[2][1] + slope[3][1]);
    if (velocity_ >= 0) return;
    velocity_ = 0;
    if (s_.stiffness * stretch_ > s_.load * mu_s_) return;
    sticks_ = true;
    mu_s_ = s_.mu_s + s_.scatter * normal_(random_);
  }

  Slider s_;
  double stretch_, velocity_ = 0, mu_s_;
  bool sticks_ = true;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

Identification prepared(const Drawn& drawn) {
  return prepare_trace({"simulated", {}, drawn.trace});
}

/// In slips velocity and friction are means over stretches, weighed by a bell; more: variance of what else they are
/// means over [samples^2].
std::vector<double> as_means(const Motion& motion, const std::vector<double>& truth, double more = 0) {
  std::vector<double> out = truth;
  const double deviation = motion.smoothing > 0 ? std::sqrt(std::pow(motion.smoothing / motion.step, 2) + more) : 0;
  const auto reach = static_cast<std::size_t>(std::ceil(3 * deviation));
  for (std::size_t i = reach; i + reach < truth.size() && deviation > 0; ++i) {
    if (!(motion.velocity_variance[i] > 0)) continue;
    double sum = 0, weights = 0;
    for (std::size_t k = i - reach; k <= i + reach; ++k) {
      const double x = (static_cast<double>(k) - static_cast<double>(i)) / deviation, w = std::exp(-0.5 * x * x);
      sum += w * truth[k];
      weights += w;
    }
    out[i] = sum / weights;
  }
  return out;
}

/// What is found less what is true, over its stated error, of the samples that are used: mean, and root mean square
/// without the hundredth that is farthest off (beside the kinks).
struct Pulls {
  double mean = 0, spread = 0;
};
Pulls pulls_of(const Motion& motion, const std::vector<double>& found, const std::vector<double>& truth,
               const std::vector<double>& error) {
  std::vector<double> z;
  Pulls out;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!motion.has_fault(i, SampleFault::any)) z.push_back((found[i] - truth[i]) / error[i]);
  }
  for (const double x : z) out.mean += x / static_cast<double>(z.size());
  std::sort(z.begin(), z.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  z.resize(z.size() - z.size() / 100);
  for (const double x : z) out.spread += x * x / static_cast<double>(z.size());
  out.spread = std::sqrt(out.spread);
  return out;
}

TEST(SpringSlider, VelocityAndFrictionAreWithinTheirStatedErrors) {
  for (const double stiffness : {168.0, 420.0, 1002.0}) {
    for (const double drive : {1.1e-3, 2.2e-3, 4.3e-3}) {
      Slider slider{.stiffness = stiffness, .drive = drive, .duration = 6};
      const Drawn drawn = Simulation(slider).run();
      drawn.trace->spring.mass = {slider.mass, "test"};
      MotionOptions options;
      options.trim = false;
      const Motion motion = compute_motion(*drawn.trace, {}, options);
      ASSERT_EQ(motion.size(), drawn.velocity.size());
      const Pulls v = pulls_of(motion, motion.relative_velocity, as_means(motion, drawn.velocity, 1.0 / 6),
                               motion.velocity_std_error);
      const Pulls mu = pulls_of(motion, motion.friction, as_means(motion, drawn.friction), motion.friction_std_error);
      EXPECT_LT(std::abs(v.mean), 0.2) << stiffness << " N/m, " << 1e3 * drive << " mm/s";
      EXPECT_LT(std::abs(mu.mean), 0.2) << stiffness << " N/m, " << 1e3 * drive << " mm/s";
      EXPECT_LT(v.spread, 2) << stiffness << " N/m, " << 1e3 * drive << " mm/s";
      EXPECT_LT(mu.spread, 2) << stiffness << " N/m, " << 1e3 * drive << " mm/s";
    }
  }
}

TEST(SpringSlider, TheMovingMassIsTheInertiaInThePull) {
  for (const double stiffness : {168.0, 420.0, 1002.0}) {
    for (const double drive : {2.2e-3, 4.3e-3}) {
      const Slider slider{.stiffness = stiffness, .drive = drive};
      const Drawn drawn = Simulation(slider).run();
      IdentifyOptions options;
      options.laws = {ExponentialLaw{}};
      options.effects = {SensorInertia{}};
      Identification result = prepared(drawn);
      fit_trace(options, result);
      ASSERT_FALSE(result.fits.empty());
      const FitParameter& mass = result.fits[0].parameters.at(3);
      EXPECT_EQ(mass.effect, "sensor-inertia");
      EXPECT_NEAR(mass.value, slider.mass, 0.05 * slider.mass) << stiffness << " N/m, " << 1e3 * drive << " mm/s";
    }
  }
}

TEST(SpringSlider, IntervalsHoldTheLaw) {
  int masses = 0;  // of nine, whose interval holds the true one
  for (const double stiffness : {168.0, 420.0, 1002.0}) {
    for (const double drive : {1.1e-3, 2.2e-3, 4.3e-3}) {
      for (const bool known : {false, true}) {
        const Slider slider{.stiffness = stiffness, .drive = drive};
        const Drawn drawn = Simulation(slider).run();
        IdentifyOptions options;
        options.laws = {ExponentialLaw{}};
        if (known) drawn.trace->spring.mass = {slider.mass, "test"};
        if (!known) options.effects = {SensorInertia{}};
        Identification result = prepared(drawn);
        fit_trace(options, result);
        ASSERT_FALSE(result.fits.empty());
        const std::vector<FitParameter>& found = result.fits[0].parameters;
        const double truth[] = {slider.mu_s, slider.mu_k, slider.decay};
        for (std::size_t k = 0; k < 3; ++k) {
          const std::string what = found.at(k).parameter.name + " at " + std::to_string(stiffness) + " N/m, " +
                                   std::to_string(1e3 * drive) + " mm/s";
          EXPECT_LE(found.at(k).lower95, truth[k]) << what;
          EXPECT_GE(found.at(k).upper95, truth[k]) << what;
          EXPECT_NEAR(found.at(k).value, truth[k], (k == 2 ? 0.11 : 0.022) * truth[k]) << what;
        }
        if (known) continue;
        EXPECT_NEAR(found.at(3).value, slider.mass, 0.005 * slider.mass) << stiffness << drive;
        masses += found.at(3).lower95 <= slider.mass && found.at(3).upper95 >= slider.mass ? 1 : 0;
      }
    }
  }
  EXPECT_GE(masses, 8);
}

/// Mass and spring filter friction like a slow sensor: what is named is the mass.
TEST(SpringSlider, TheDiagnosisNamesTheInertia) {
  const DiagnosedTraces found = diagnose({{"simulated", {}, Simulation({.duration = 10}).run().trace}}, {});
  ASSERT_GT(found.diagnosis.ladder.size(), 1U);
  EXPECT_EQ(found.diagnosis.ladder[1].added, SensorInertia::key);
  EXPECT_EQ(found.diagnosis.law, Law(ExponentialLaw{}));
}

TEST(SpringSlider, StickIsWhereTheSpringStretchesAtTheSpeedOfItsDrive) {
  const Slider slider;
  const Identification result = prepared(Simulation(slider).run());
  EXPECT_EQ(result.segmentation.kind, MotionKind::stick_slip);
  EXPECT_EQ(kind_of_record(result.motion, result.segmentation), RecordKind::spring_slider);
  EXPECT_NEAR(result.motion.plateau_velocity, 0, 0.02 * slider.drive);
  double break_away = 0, count = 0;
  for (const Cycle& cycle : result.segmentation.cycles) {
    if (!std::isfinite(cycle.break_away_friction)) continue;
    break_away += cycle.break_away_friction;
    count += 1;
  }
  EXPECT_GT(count, 30);
  EXPECT_NEAR(break_away / count, slider.mu_s, 0.003);
}

TEST(SpringSlider, LoneSamplesOfThePullChangeNothing) {
  const Drawn drawn = Simulation({.duration = 5}).run();
  const Motion clean = compute_motion(*drawn.trace);
  for (std::size_t i = 700; i < drawn.trace->friction.size(); i += 997) drawn.trace->friction[i] += 0.05;
  const Motion spoilt = compute_motion(*drawn.trace);
  for (std::size_t i = 0; i < clean.size(); ++i) {
    ASSERT_NEAR(spoilt.relative_velocity[i], clean.relative_velocity[i],
                6 * clean.velocity_std_error[i] + 0.02 * 0.0111)
        << i;
  }
}

/// A displacement beside friction gives the velocity that was not recorded; of a linear drive the relative one.
TEST(SpringSlider, DisplacementsBesideFrictionGiveTheVelocity) {
  const Slider slider{.duration = 8};
  for (const bool drive : {false, true}) {
    Drawn drawn = Simulation(slider).run();
    Trace& trace = *drawn.trace;
    trace.kind = std::nullopt;
    trace.velocity_kind = drive ? VelocityKind::relative : VelocityKind::block;
    trace.conditions.radius = {1, "test"};
    trace.conditions.speed = {slider.drive, "test"};
    trace.steps = {{0, trace.size(), "", trace.conditions}};
    for (std::size_t i = 0; i < trace.size(); ++i) {
      const double stretch = trace.friction[i] * slider.load / slider.stiffness;
      trace.block_position.push_back(stretch);
      if (drive) trace.drive_position.push_back(slider.drive * trace.time[i]);
      trace.friction[i] = drawn.friction[i];
    }
    MotionOptions options;
    options.trim = false;
    const Motion motion = compute_motion(trace, {}, options);
    ASSERT_EQ(motion.size(), drawn.velocity.size());
    const Pulls v = pulls_of(motion, motion.relative_velocity, drawn.velocity, motion.velocity_std_error);
    EXPECT_LT(std::abs(v.mean), 0.2) << drive;
    EXPECT_LT(v.spread, 2) << drive;
    Identification result = prepared(drawn);
    EXPECT_EQ(kind_of_record(result.motion, result.segmentation), RecordKind::stick_slip);
    IdentifyOptions fit;
    fit.laws = {ExponentialLaw{}};
    fit_trace(fit, result);
    ASSERT_FALSE(result.fits.empty());
    EXPECT_NEAR(result.fits[0].parameters.at(0).value, slider.mu_s, 0.01 * slider.mu_s);
    EXPECT_NEAR(result.fits[0].parameters.at(1).value, slider.mu_k, 0.02 * slider.mu_k);
    EXPECT_NEAR(result.fits[0].parameters.at(2).value, slider.decay, 0.15 * slider.decay);
  }
}

TEST(SpringSlider, WhatIsNotKnownIsAskedFor) {
  const Drawn drawn = Simulation({.duration = 1}).run();
  const auto refusal = [&](Trace trace) -> std::string {
    try {
      compute_motion(std::move(trace));
    } catch (const InputError& error) {
      return error.problem() + "; " + error.advice();
    }
    return "";
  };
  Trace soft = *drawn.trace;
  soft.spring.stiffness = {};
  EXPECT_THAT(refusal(soft), HasSubstr("--stiffness 168N/m"));
  Trace light = *drawn.trace;
  light.conditions.load = {};
  EXPECT_THAT(refusal(light), HasSubstr("--load"));
  light.spring.mass = {0.0307, "test"};
  EXPECT_EQ(refusal(light), "");
}

TEST(SpringSlider, NoRigShowsInAVelocityMadeFromThePull) {
  const Drawn drawn = Simulation({.duration = 5}).run();
  const RigIdentification found = identify_rig({"simulated", {}, drawn.trace});
  EXPECT_FALSE(found.rig.determined);
  EXPECT_THAT(found.rig.reason, HasSubstr("stated stiffness"));
}

}  // namespace
}  // namespace tribofit
