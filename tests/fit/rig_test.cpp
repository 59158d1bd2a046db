#include "tribofit/fit/rig.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/sensors.hpp"
#include "tribofit/oscillator/simulate.hpp"

namespace {

using namespace tribofit;
using ::testing::HasSubstr;

/// A test of [D] as recorded: noise 0.003 on mu and 0.2 mm/s on v_b, break-away scatter that wanders.
struct Recorded {
  double radius = 0.015;
  Law law = ExponentialLaw{};
  double duration = 10, rate = 20e3;
  SpeedProfile speed = {};  // none: that of the test
  Sensors sensors = {.friction_noise = 0.003, .velocity_noise = 0.2e-3};
  double settle = -1;  // as long as it takes
  std::uint64_t seed = 1;
};

Trace trace_of(const Recorded& r) {
  const PublishedTest test = published_test(r.radius, r.law);
  const FrictionModel model(r.law);
  const std::vector<double> p = test.friction;
  Drive drive;
  drive.speed = r.speed.speed ? r.speed : constant_speed(test.speed);
  drive.radius = test.radius;
  drive.mean_load = test.load;
  SimulationOptions options;
  options.duration = r.duration;
  options.rate = r.rate;
  options.settle = r.settle < 0 ? settling_time(test.rig, drive, p) : r.settle;
  options.scatter = {0.004, 0.5};
  options.seed = r.seed;
  Sensors sensors = r.sensors;
  sensors.seed = r.seed + 100000;
  return record(simulate(test.rig, drive, model, p, options), model, p, sensors).trace;
}

RigFit rig_of(Trace trace, const Instruments& instruments = {}, const MotionOptions& options = {}) {
  const Motion motion = compute_motion(std::move(trace), instruments, options);
  return identify_rig(motion, find_cycles(motion), instruments);
}

RigFit rig_of(const Recorded& r) {
  return rig_of(trace_of(r));
}

Rig truth(const Recorded& r) {
  return published_test(r.radius, r.law).rig;
}

void expect_rig(const RigFit& fit, const Rig& rig) {
  ASSERT_TRUE(fit.determined) << fit.reason;
  EXPECT_NEAR(fit.mass.value, rig.mass, 0.01 * rig.mass);
  EXPECT_NEAR(fit.stiffness.value, rig.stiffness, 0.01 * rig.stiffness);
  EXPECT_NEAR(fit.damping.value, rig.damping, 0.1 * rig.damping);
}

std::string all(const std::vector<std::string>& messages) {
  std::string text;
  for (const std::string& m : messages) text += m + "\n";
  return text;
}

TEST(RigFit, RigsOfThePublishedTestsComeBack) {
  for (const double radius : {0.009, 0.012, 0.015, 0.018}) {
    for (const Law& law : {Law(ExponentialLaw{}), Law(FractionalLaw{})}) {
      for (const double colour : {0.0, 0.9}) {
        Recorded r{.radius = radius, .law = law};
        r.sensors.noise_colour = colour;
        const RigFit fit = rig_of(r);
        const Rig rig = truth(r);
        expect_rig(fit, rig);
        EXPECT_NEAR(fit.natural_frequency.value, rig.natural_frequency() / (2 * M_PI), 0.1);
        EXPECT_NEAR(fit.damping_ratio.value, rig.damping_ratio(), 0.1 * rig.damping_ratio());
        EXPECT_NEAR(fit.stick_slope_stiffness.value, rig.stiffness, 0.01 * rig.stiffness);
        EXPECT_LT(std::abs(fit.stick_slope_difference), 5);
        EXPECT_FALSE(fit.per_unit_load);
        EXPECT_FALSE(fit.damping_doubtful) << all(fit.messages);
        EXPECT_THAT(all(fit.messages), HasSubstr("m - m_s"));
      }
    }
  }
}

TEST(RigFit, IntervalsCoverTheTruth) {
  for (const double colour : {0.0, 0.9}) {
    int covered = 0, intervals = 0;
    double mass = 0, damping = 0, stiffness = 0;
    constexpr int kRecords = 320;
    for (int k = 0; k < kRecords; ++k) {
      Recorded r{.radius = 0.009 + 0.003 * (k % 4), .duration = 4, .rate = 10e3};
      r.sensors.noise_colour = colour;
      r.seed = static_cast<std::uint64_t>(k + 1);
      const RigFit fit = rig_of(r);
      const Rig rig = truth(r);
      const auto count = [&](const RigValue& v, double value) {
        ++intervals;
        covered += v.lower95 <= value && value <= v.upper95 ? 1 : 0;
      };
      count(fit.mass, rig.mass);
      count(fit.damping, rig.damping);
      count(fit.stiffness, rig.stiffness);
      mass += fit.mass.value / rig.mass / kRecords;
      damping += fit.damping.value / rig.damping / kRecords;
      stiffness += fit.stiffness.value / rig.stiffness / kRecords;
    }
    const double share = static_cast<double>(covered) / intervals;
    EXPECT_GT(share, 0.93) << "colour " << colour;
    EXPECT_LT(share, 0.97) << "colour " << colour;
    // No bias that would matter: noise in the variables would lower all three.
    EXPECT_NEAR(mass, 1, 1e-3);
    EXPECT_NEAR(damping, 1, 1e-2);
    EXPECT_NEAR(stiffness, 1, 5e-4);
  }
}

TEST(RigFit, CovarianceGoesWithTheErrors) {
  const RigFit fit = rig_of(Recorded{});
  EXPECT_NEAR(fit.covariance[0], fit.mass.std_error * fit.mass.std_error, 1e-12 * fit.covariance[0]);
  EXPECT_NEAR(fit.covariance[4], fit.damping.std_error * fit.damping.std_error, 1e-12 * fit.covariance[4]);
  EXPECT_NEAR(fit.covariance[8], fit.stiffness.std_error * fit.stiffness.std_error, 1e-12 * fit.covariance[8]);
  EXPECT_DOUBLE_EQ(fit.covariance[1], fit.covariance[3]);
}

TEST(RigFit, AHighPassLeftInMakesDampingNegativeUntilItIsUndone) {
  Recorded r;
  r.sensors.velocity_high_pass = 0.5;
  const RigFit undone = rig_of(r);
  expect_rig(undone, truth(r));
  EXPECT_THAT(all(undone.messages), HasSubstr("was undone"));
  const RigFit kept = rig_of(trace_of(r), {}, {.undo_high_pass = false});
  EXPECT_FALSE(kept.determined);
  EXPECT_LT(kept.damping.upper95, 0);
  EXPECT_THAT(kept.reason, HasSubstr("high-pass"));
  EXPECT_NEAR(kept.high_pass.value, 0.5, 0.01);  // the balance sees it without the plateau
  EXPECT_NEAR(kept.without_both.damping, truth(r).damping, 0.1 * truth(r).damping);
  EXPECT_THROW(kept.to_rig(), std::logic_error);
}

TEST(RigFit, ADelayBetweenTheChannelsIsSeenAndSaid) {
  Recorded r;
  const Rig rig = truth(r);
  const RigFit sound = rig_of(r);
  r.sensors.friction_delay = 0.5e-3;
  const RigFit late = rig_of(r);
  EXPECT_NEAR(late.delay.value, 0.5e-3, 0.03e-3);
  EXPECT_LT(late.damping.value, 0.9 * rig.damping);
  EXPECT_NEAR(late.without_both.damping, rig.damping, 0.1 * rig.damping);
  EXPECT_TRUE(late.damping_doubtful);
  EXPECT_THAT(all(late.messages), HasSubstr("later than v_b"));
  // Friction early, declared as a vibrometer that is late.
  r.sensors.friction_delay = -0.5e-3;
  Instruments instruments;
  instruments.vibrometer.delay = Declared{0.5e-3, 0.05e-3};
  const RigFit declared = rig_of(trace_of(r), instruments);
  expect_rig(declared, rig);
  EXPECT_FALSE(declared.damping_doubtful);
  // Its uncertainty is what a delay of that size does to the damping.
  EXPECT_NEAR(declared.damping.systematic, 0.1 * (sound.damping.value - late.damping.value),
              0.02 * (sound.damping.value - late.damping.value));
}

TEST(RigFit, OnlyTheMassAboveTheForceSensorShowsUnlessMoreIsDeclared) {
  Recorded r;
  r.sensors.mass_below = 0.3;
  const Rig rig = truth(r);
  const RigFit bare = rig_of(r);
  EXPECT_NEAR(bare.mass.value, rig.mass - 0.3, 0.01 * rig.mass);
  EXPECT_FALSE(bare.mass_below_declared);
  Instruments declared;
  declared.force_sensor.mass_below = Declared{0.3, 0.01};
  const RigFit whole = rig_of(trace_of(r), declared);
  EXPECT_NEAR(whole.mass.value, rig.mass, 0.01 * rig.mass);
  EXPECT_TRUE(whole.mass_below_declared);
  EXPECT_NEAR(whole.mass.systematic, 0.01, 1e-4);
  Instruments ping;
  ping.rig.ping_frequency = Declared{rig.natural_frequency() / (2 * M_PI), 0.02};
  const RigFit split = rig_of(trace_of(r), ping);
  EXPECT_NEAR(split.mass_below.value, 0.3, 0.01);
}

TEST(RigFit, OffsetsAndDriftsBiasNothing) {
  const Recorded r;
  Motion motion = compute_motion(trace_of(r));
  const Segmentation segmentation = find_cycles(motion);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion.relative_velocity[i] += 1e-3;  // zero error of the vibrometer: a tenth of the stiffness if nothing was done
    motion.friction[i] += 0.1 + 0.02 * motion.time[i];
  }
  expect_rig(identify_rig(motion, segmentation), truth(r));
  const RigFit fit = identify_rig(motion, segmentation);
  EXPECT_NEAR(fit.stiffness.value, truth(r).stiffness, 2e-3 * truth(r).stiffness);
  EXPECT_NEAR(fit.damping.value, truth(r).damping, 0.05 * truth(r).damping);
}

TEST(RigFit, WithoutALoadEverythingIsPerNewton) {
  const Recorded r;
  Trace trace = trace_of(r);
  trace.conditions.load = {};
  trace.steps.clear();
  const RigFit fit = rig_of(trace);
  EXPECT_TRUE(fit.per_unit_load);
  const Rig rig = truth(r), per{rig.mass / 50, rig.damping / 50, rig.stiffness / 50};
  expect_rig(fit, per);
  EXPECT_THAT(all(fit.messages), HasSubstr("per newton"));
  trace.friction_kind = FrictionKind::force;
  for (double& f : trace.friction) f *= 50;
  const RigFit force = rig_of(trace);
  EXPECT_FALSE(force.per_unit_load);
  expect_rig(force, rig);
}

TEST(RigFit, ALoadChannelIsFollowed) {
  Recorded r;
  Trace trace = trace_of(r);
  trace.load.resize(trace.size());
  for (std::size_t i = 0; i < trace.size(); ++i) {  // the same force, read with another load
    trace.load[i] = 50 * (1 + 0.3 * std::sin(2 * trace.time[i]));
    trace.friction[i] *= 50 / trace.load[i];
  }
  expect_rig(rig_of(trace), truth(r));
}

TEST(RigFit, RelativeVelocityServesWhenTheDiscTurnsEvenly) {
  const Recorded r;
  const PublishedTest test = published_test(r.radius, r.law);
  Trace trace = trace_of(r);
  for (double& v : trace.velocity) v = test.speed * test.radius - v;
  trace.velocity_kind = VelocityKind::relative;
  trace.conditions.speed = trace.conditions.radius = {};
  trace.steps.clear();
  const RigFit fit = rig_of(trace);
  expect_rig(fit, truth(r));
  EXPECT_THAT(all(fit.messages), HasSubstr("turn evenly"));
  EXPECT_FALSE(fit.stick_slope_stiffness.determined);  // the way of the disc is not known
}

TEST(RigFit, AReversingDiscIsNoHindrance) {
  Recorded r;
  r.speed = reversing_speed(0.42, 0.5);
  r.settle = 0;
  r.duration = 20;
  expect_rig(rig_of(r), truth(r));
}

TEST(RigFit, OneKilohertzWillDo) {
  Recorded r;
  r.rate = 1000;
  r.duration = 20;
  expect_rig(rig_of(r), truth(r));
}

TEST(RigFit, ARecordThatOnlySticksHasAStiffnessAndNoMass) {
  Recorded r;
  r.speed = run_up_speed(0.42, 0.01);
  r.duration = 0.2;  // the first slip comes later
  r.settle = 0;
  const RigFit fit = rig_of(r);
  EXPECT_FALSE(fit.determined);
  EXPECT_THAT(fit.reason, HasSubstr("never slips"));
  EXPECT_FALSE(fit.mass.determined);
  ASSERT_TRUE(fit.stiffness.determined);
  EXPECT_NEAR(fit.stiffness.value, truth(r).stiffness, 0.03 * truth(r).stiffness);
}

TEST(RigFit, SteadySlidingTellsNothing) {
  Recorded r;
  r.speed = constant_speed(30);  // stable at this speed
  const RigFit fit = rig_of(r);
  EXPECT_FALSE(fit.determined);
  EXPECT_THAT(fit.reason, HasSubstr("too little"));
}

TEST(RigFit, NoMotionOrTooFewCyclesSayWhy) {
  const Recorded r;
  Trace fixed = trace_of(r);
  fixed.velocity.clear();
  fixed.velocity_kind = VelocityKind::fixed_block;
  EXPECT_THAT(rig_of(fixed).reason, HasSubstr("stands still"));
  Recorded brief;
  brief.duration = 0.5;
  EXPECT_THAT(rig_of(brief).reason, HasSubstr("fewer than three"));
}

TEST(RigFit, ChannelsOfOppositeSignAreNotPassedOnAsARig) {
  Motion motion = compute_motion(trace_of({}));
  const Segmentation segmentation = find_cycles(motion);
  for (double& mu : motion.friction) mu = -mu;
  const RigFit fit = identify_rig(motion, segmentation);
  EXPECT_FALSE(fit.determined);
  EXPECT_THAT(fit.reason, HasSubstr("wrong sign"));
}

}  // namespace
