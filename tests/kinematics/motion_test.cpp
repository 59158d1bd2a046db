// v_r, speed, noise, run-up and corrections against simulated and analytic truth.
#include "tribofit/kinematics/motion.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stick_slip_truth.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

Trace constant_trace(std::size_t n, double v) {
  Trace trace;
  for (std::size_t i = 0; i < n; ++i) trace.time.push_back(1e-3 * static_cast<double>(i));
  trace.velocity.assign(n, v);
  trace.friction.assign(n, 0.4);
  trace.steps = {{0, n, "", {}}};
  return trace;
}

TEST(Motion, RelativeVelocityIsDiscMinusBlock) {
  truth::Rig rig;
  rig.friction_noise = rig.velocity_noise = 0;
  rig.duration = 2;
  const truth::Run run = truth::simulate(rig);
  const Motion motion = compute_motion(run.trace);
  ASSERT_EQ(motion.size(), run.trace.size());
  const double disc = rig.speed() * rig.radius;
  for (std::size_t i = 0; i < motion.size(); i += 97) {
    EXPECT_DOUBLE_EQ(motion.relative_velocity[i], disc - run.trace.velocity[i]);
  }
  EXPECT_EQ(motion.conditions.speed.source, "file");
  EXPECT_EQ(motion.trimmed, 0u);
  EXPECT_TRUE(motion.sticks);
}

TEST(Motion, NoiseOfThePlateauStandsColouredNoise) {
  for (double rho : {0.0, 0.9}) {
    truth::Rig rig;
    rig.noise_correlation = rho;
    const Motion motion = compute_motion(truth::simulate(rig).trace);
    // Successive differences would say 0.0063 mm/s at rho = 0.9.
    EXPECT_NEAR(motion.velocity_noise, 2e-5, 2.5e-6) << "rho " << rho;
  }
}

TEST(Motion, SpeedComesFromThePlateauWhenNobodySaysIt) {
  for (double rpm : {1.0, 4.0, 20.0}) {
    truth::Rig rig;
    rig.rpm = rpm;
    rig.noise_correlation = 0.9;
    Trace trace = truth::simulate(rig).trace;
    trace.conditions.speed = {};
    const Motion motion = compute_motion(std::move(trace));
    EXPECT_NEAR(motion.conditions.speed.value / rig.speed(), 1, 2e-3) << rpm << " rpm";
    EXPECT_EQ(motion.conditions.speed.source, "plateau");
    EXPECT_NEAR(motion.plateau_velocity, 0, 1e-5);
  }
}

TEST(Motion, WithoutPlateauAndSpeedThereIsNoRelativeVelocity) {
  Trace trace = constant_trace(4000, 0);
  for (std::size_t i = 0; i < trace.size(); ++i) trace.velocity[i] = 0.004 * std::sin(30 * trace.time[i]);
  EXPECT_THROW(compute_motion(trace), InputError);
  trace.conditions.radius = {0.015, "file"};
  EXPECT_THROW(compute_motion(trace), InputError);
  trace.conditions.speed = {1, "command line"};
  const Motion motion = compute_motion(trace);
  EXPECT_FALSE(motion.sticks);  // turning points of a sine are no plateaus
  EXPECT_NEAR(motion.relative_velocity[100], 0.015 - trace.velocity[100], 1e-15);
}

TEST(Motion, WrongRadiusShowsInThePlateau) {
  truth::Rig rig;
  Trace trace = truth::simulate(rig).trace;
  trace.conditions.radius.value = 0.0165;
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_NEAR(motion.plateau_velocity, rig.speed() * 0.0015, 1e-5);
  EXPECT_EQ(motion.health.at(8).check, "plateau-speed");
  EXPECT_EQ(motion.health.at(8).status, HealthItem::Status::warning);
}

TEST(Motion, VibrometerPointingTheOtherWayIsNoticed) {
  truth::Rig rig;
  Trace trace = truth::simulate(rig).trace;
  for (double& v : trace.velocity) v = -v;
  for (bool stated : {true, false}) {
    Trace copy = trace;
    if (!stated) copy.conditions.speed = {};
    const Motion motion = compute_motion(std::move(copy));
    EXPECT_NEAR(motion.constant_disc_velocity, rig.speed() * rig.radius, 2e-5);
    EXPECT_NEAR(motion.plateau_velocity, 0, 2e-5);
    ASSERT_FALSE(motion.notes.empty());
  }
  Instruments declared;
  declared.vibrometer.sign = -1;
  EXPECT_NEAR(compute_motion(trace, declared).plateau_velocity, 0, 2e-5);
}

TEST(Motion, RunUpIsTrimmedAndSaid) {
  truth::Rig rig;
  truth::Run run = truth::simulate(rig);
  // The disc starts from rest and reaches its speed after 0.8 s; the block goes with it.
  Trace trace = run.trace;
  const double disc = rig.speed() * rig.radius;
  const auto extra = static_cast<std::size_t>(0.8 * rig.rate);
  std::vector<double> v, mu;
  for (std::size_t i = 0; i < extra; ++i) {
    const double part = static_cast<double>(i) / static_cast<double>(extra);
    v.push_back(disc * part + 2e-5 * std::sin(1.7 * static_cast<double>(i)));
    mu.push_back(0.3 * part * part);
  }
  trace.velocity.insert(trace.velocity.begin(), v.begin(), v.end());
  trace.friction.insert(trace.friction.begin(), mu.begin(), mu.end());
  trace.time.resize(trace.velocity.size());
  for (std::size_t i = 0; i < trace.time.size(); ++i) trace.time[i] = static_cast<double>(i) / rig.rate;
  trace.steps = {{0, trace.size(), "", {}}};
  const Motion motion = compute_motion(trace);
  EXPECT_NEAR(static_cast<double>(motion.trimmed) / rig.rate, 0.784, 0.03);  // 98 % of the ramp
  EXPECT_NEAR(motion.time.front(), static_cast<double>(motion.trimmed) / rig.rate, 1e-9);
  EXPECT_EQ(motion.steps.back().end, motion.size());
  MotionOptions keep;
  keep.trim = false;
  EXPECT_EQ(compute_motion(trace, {}, keep).trimmed, 0u);
}

TEST(Motion, FixedBlockSlidesAtTheSpeedOfTheDiscStepByStep) {
  Trace trace = constant_trace(300, 0);
  trace.velocity.clear();
  trace.velocity_kind = VelocityKind::fixed_block;
  trace.disc_speed.assign(300, 5);
  trace.steps = {{0, 100, "a", {}}, {100, 300, "b", {}}};
  trace.steps[0].conditions.radius = {0.006, "file"};
  trace.steps[1].conditions.radius = {0.009, "file"};
  const Motion motion = compute_motion(trace);
  EXPECT_DOUBLE_EQ(motion.relative_velocity[99], 0.03);
  EXPECT_DOUBLE_EQ(motion.relative_velocity[100], 0.045);
  ASSERT_EQ(motion.steps.size(), 2u);
  EXPECT_EQ(motion.steps[1].label, "b");
  EXPECT_FALSE(motion.sticks);
  EXPECT_NEAR(sliding_distance(motion).back(), 0.1 * 0.03 + 0.199 * 0.045, 1e-4);
  EXPECT_NEAR(disc_angle(motion).back(), 5 * 0.299, 1e-9);
  trace.disc_speed.clear();
  EXPECT_THROW(compute_motion(trace), InputError);
}

TEST(Motion, DeclaredGainZeroAndDelayAreCorrected) {
  truth::Rig rig;
  rig.friction_noise = rig.velocity_noise = 0;
  rig.duration = 2;
  const truth::Run run = truth::simulate(rig);
  Trace trace = run.trace;
  const std::size_t late = 23;  // samples
  for (std::size_t i = trace.size(); i-- > 0;) trace.velocity[i] = 0.95 * run.trace.velocity[i >= late ? i - late : 0];
  for (double& mu : trace.friction) mu = 1.02 * mu + 0.01;
  Instruments instruments;
  instruments.vibrometer.gain = Declared{0.95, 0.01};
  instruments.vibrometer.delay = Declared{static_cast<double>(late) / rig.rate, 0};
  instruments.force_sensor.zero = Declared{0.01, 0};
  instruments.force_sensor.gain = Declared{1.02, 0};
  const Motion motion = compute_motion(trace, instruments);
  const double disc = rig.speed() * rig.radius;
  EXPECT_LT(motion.size(), run.trace.size());  // the end that nobody measured is gone
  for (std::size_t i = 100; i < motion.size(); i += 61) {
    EXPECT_NEAR(motion.relative_velocity[i], disc - run.trace.velocity[i], 1e-9);
    EXPECT_NEAR(motion.friction[i], run.trace.friction[i], 1e-12);
  }
}

TEST(Motion, DelayOfPartOfASampleIsInterpolated) {
  const double rate = 1000, delay = 0.37e-3;
  Trace trace = constant_trace(4000, 0);
  trace.velocity_kind = VelocityKind::relative;
  const auto truth = [](double t) { return 0.05 + 0.02 * std::sin(40 * t); };
  for (std::size_t i = 0; i < trace.size(); ++i) trace.velocity[i] = truth(trace.time[i] - delay);
  Instruments instruments;
  instruments.vibrometer.delay = Declared{delay, 0};
  for (double sign : {1.0, -1.0}) {
    for (std::size_t i = 0; i < trace.size(); ++i) trace.velocity[i] = truth(trace.time[i] - sign * delay);
    instruments.vibrometer.delay->value = sign * delay;
    const Motion motion = compute_motion(trace, instruments);
    for (std::size_t i = 10; i + 10 < motion.size(); i += 17) {
      EXPECT_NEAR(motion.relative_velocity[i], truth(motion.time[i]), 1e-7) << sign;
    }
  }
  EXPECT_NEAR(compute_motion(trace).step, 1 / rate, 1e-12);
}

TEST(Motion, MassBelowTheSensorIsAddedBack) {
  truth::Rig rig;
  rig.friction_noise = rig.velocity_noise = 0;
  const truth::Run run = truth::simulate(rig);
  Trace trace = run.trace;
  const double mass = 0.1;
  for (std::size_t i = 1; i + 1 < trace.size(); ++i) {
    const double a = (run.trace.velocity[i + 1] - run.trace.velocity[i - 1]) * rig.rate / 2;
    trace.friction[i] -= mass * a / rig.load;
  }
  Instruments instruments;
  instruments.force_sensor.mass_below = Declared{mass, 0.01};
  const Motion motion = compute_motion(trace, instruments);
  std::size_t smooth = 0, close = 0;
  for (std::size_t i = 50; i + 50 < motion.size(); ++i) {
    ++smooth;
    close += std::abs(motion.friction[i] - run.trace.friction[i]) < 5e-4 ? 1u : 0u;
  }
  // All but the few samples at re-stick, where the acceleration jumps.
  EXPECT_GT(static_cast<double>(close), 0.97 * static_cast<double>(smooth));
}

TEST(Motion, AccelerationAngleAndDistanceOfAKnownMotion) {
  Trace trace = constant_trace(5000, 0);
  const double w = 20;
  for (std::size_t i = 0; i < trace.size(); ++i) trace.velocity[i] = 0.002 * std::sin(w * trace.time[i]);
  trace.conditions.radius = {0.01, "file"};
  trace.conditions.speed = {2, "file"};
  const Motion motion = compute_motion(trace);
  const std::vector<double> a = block_acceleration(motion, 5);
  for (std::size_t i = 0; i < a.size(); i += 37) {
    // A parabola over 11 ms attenuates by (w h)^2/10 (3 m^2+3 m-1)/... < 0.1 %; the ends are less exact.
    EXPECT_NEAR(a[i], 0.002 * w * std::cos(w * motion.time[i]), i < 5 || i + 5 >= a.size() ? 4e-4 : 8e-5);
  }
  EXPECT_NEAR(disc_angle(motion).back(), 2 * motion.time.back(), 1e-12);
  EXPECT_NEAR(sliding_distance(motion).back(),
              0.02 * motion.time.back() - 0.002 / w * (1 - std::cos(w * motion.time.back())), 1e-8);
}

TEST(Motion, FrictionRecordedWithTheOtherSignIsTurned) {
  Trace trace = constant_trace(3000, 0);
  trace.velocity_kind = VelocityKind::relative;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    trace.velocity[i] = 0.1 * std::sin(4 * trace.time[i]);
    trace.friction[i] = trace.velocity[i] > 0 ? -0.3 : 0.3;
  }
  const Motion motion = compute_motion(trace);
  EXPECT_GT(motion.friction[200] * motion.relative_velocity[200], 0);
}

TEST(Motion, DegenerateRecordsAreNoAccident) {
  EXPECT_THROW(compute_motion(constant_trace(1, 0)), InputError);
  for (std::size_t n : {2u, 3u, 10u, 100u}) {
    for (double v : {0.0, 0.006, -0.1}) {
      Trace trace = constant_trace(n, v);
      trace.conditions.radius = {0.015, "file"};
      trace.conditions.speed = {0.4, "file"};
      const Motion motion = compute_motion(trace);
      EXPECT_EQ(motion.size(), n);
      EXPECT_EQ(motion.health.size(), 11u);
      EXPECT_NEAR(motion.relative_velocity.back(), 0.006 - v, 1e-15);
    }
  }
}

TEST(Motion, AZeroInNewtonsIsDividedByTheLoad) {
  truth::Rig rig;
  rig.duration = 2;
  const Trace trace = truth::simulate(rig).trace;
  Instruments instruments;
  instruments.force_sensor.zero = Declared{0.5, 0};
  instruments.force_sensor.zero_is_force = true;
  const Motion nominal = compute_motion(trace, instruments);
  EXPECT_NEAR(nominal.friction[100], trace.friction[100] - 0.01, 1e-12);
  Trace measured = trace;
  measured.load.assign(trace.size(), 40);
  EXPECT_NEAR(compute_motion(measured, instruments).friction[100], trace.friction[100] - 0.0125, 1e-12);
  Trace unknown = trace;
  unknown.conditions.load = {};
  EXPECT_THROW(compute_motion(unknown, instruments), InputError);
}

TEST(Motion, TheStepIsThatBetweenTheGaps) {
  truth::Rig rig;
  rig.duration = 2;
  Trace trace = truth::simulate(rig).trace;
  for (std::size_t i = trace.size() / 2; i < trace.size(); ++i) trace.time[i] += 5;
  EXPECT_NEAR(compute_motion(std::move(trace)).step, 1 / rig.rate, 1e-12);
}

TEST(Motion, ValidButUselessDataAreNoError) {
  for (std::size_t n : {2u, 3u, 5u, 10u, 4000u}) {
    Trace trace = constant_trace(n, 0);
    trace.conditions.radius = {0.015, "command line"};
    const Motion zero = compute_motion(trace);
    EXPECT_EQ(zero.size(), n);
    EXPECT_FALSE(zero.conditions.speed.known());
    EXPECT_EQ(zero.relative_velocity[n - 1], 0);
    EXPECT_EQ(zero.friction[0], 0.4) << "no direction is known";
    EXPECT_FALSE(zero.notes.empty());
    trace.friction.assign(n, 0);
    EXPECT_EQ(compute_motion(trace).friction, trace.friction);
    if (n > 10) continue;
    for (std::size_t i = 0; i < n; ++i) trace.velocity[i] = 1e-3 * static_cast<double>((i * 7) % 5) - 1e-3;
    EXPECT_EQ(compute_motion(trace).size(), n);
    trace.conditions.speed = {0.4, "command line"};
    const Motion driven = compute_motion(trace);
    ASSERT_EQ(driven.size(), n);
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR(driven.relative_velocity[i], 0.4 * 0.015 - trace.velocity[i], 1e-15);
  }
}

}  // namespace
}  // namespace tribofit
