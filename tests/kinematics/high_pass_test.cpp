// A vibrometer with an undeclared first-order high-pass is noticed and undone; what only looks like one is left alone.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit {
namespace {

const HealthItem& sagging(const Motion& motion) {
  return motion.health.at(2);
}

TEST(HighPass, CornerIsFoundAndTheVelocityRestored) {
  for (double corner : {0.02, 0.1, 0.2, 0.5, 1.0}) {
    for (double rho : {0.0, 0.9}) {
      truth::Rig rig;
      rig.duration = 10;
      rig.noise_correlation = rho;
      rig.scatter = 0.004;
      rig.velocity_noise = 0;
      const truth::Run run = truth::simulate(rig);
      Trace trace = run.trace;
      truth::high_pass(trace.velocity, corner, rig.rate);
      std::mt19937_64 random(7);
      const auto noise = truth::noise(trace.size(), 2e-5, rho, random);
      for (std::size_t i = 0; i < trace.size(); ++i) trace.velocity[i] += noise[i];
      const Motion motion = compute_motion(std::move(trace));
      EXPECT_NEAR(motion.high_pass / corner, 1, corner < 0.05 ? 0.1 : 0.005) << corner << " rho " << rho;
      EXPECT_NEAR(motion.velocity_noise, 2e-5, 3e-6);
      const double disc = rig.speed() * rig.radius;
      double squares = 0;
      for (std::size_t i = 0; i < motion.size(); ++i) {
        const double e = motion.relative_velocity[i] - (disc - run.trace.velocity[i + motion.trimmed]);
        squares += e * e;
      }
      // The noise itself and little beside: the plateau is 6.3 mm/s, the slip 84 mm/s.
      EXPECT_LT(std::sqrt(squares / static_cast<double>(motion.size())), 5e-5) << corner << " rho " << rho;
    }
  }
}

TEST(HighPass, WithoutASpeedThePlateauFollowsFromNoNetDisplacement) {
  truth::Rig rig;
  rig.duration = 20;
  Trace trace = truth::simulate(rig).trace;
  truth::high_pass(trace.velocity, 0.5, rig.rate);
  trace.conditions.speed = {};
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_NEAR(motion.high_pass, 0.5, 0.01);
  EXPECT_NEAR(motion.constant_disc_velocity / (rig.speed() * rig.radius), 1, 0.02);
}

TEST(HighPass, ADeclaredCornerIsTakenAndAZeroErrorDoesNotRunAway) {
  truth::Rig rig;
  rig.duration = 30;
  Trace trace = truth::simulate(rig).trace;
  truth::high_pass(trace.velocity, 0.3, rig.rate);
  for (double& v : trace.velocity) v += 2e-5;  // integrates to 1 mm/s after 30 s
  Instruments instruments;
  instruments.vibrometer.high_pass = Declared{0.3, 0.01};
  const Motion motion = compute_motion(std::move(trace), instruments);
  EXPECT_DOUBLE_EQ(motion.high_pass, 0.3);
  EXPECT_DOUBLE_EQ(motion.high_pass_std_error, 0.01);
  EXPECT_NEAR(motion.plateau_velocity, 0, 2e-5);
  EXPECT_NEAR(motion.velocity_noise, 2e-5, 3e-6);
}

TEST(HighPass, CanBeLeftAsItIs) {
  truth::Rig rig;
  Trace trace = truth::simulate(rig).trace;
  truth::high_pass(trace.velocity, 0.2, rig.rate);
  MotionOptions options;
  options.undo_high_pass = false;
  const Motion motion = compute_motion(std::move(trace), {}, options);
  EXPECT_EQ(motion.high_pass, 0);
  EXPECT_EQ(sagging(motion).status, HealthItem::Status::problem);
}

TEST(HighPass, IsNotSeenWhereThereIsNone) {
  for (double rho : {0.0, 0.9}) {
    for (unsigned seed = 1; seed <= 6; ++seed) {
      truth::Rig rig;
      rig.noise_correlation = rho;
      rig.scatter = 0.004;
      rig.seed = seed;
      Trace trace = truth::simulate(rig).trace;
      if (seed % 2 == 0) trace.conditions.radius.value *= 1.06;  // a wrong radius is no sag
      EXPECT_EQ(compute_motion(std::move(trace)).high_pass, 0);
    }
  }
}

TEST(HighPass, CreepOfTheContactIsNotMistakenForIt) {
  // Bristle with mu << mu_s: v_r = (dmu/dt)/sigma0/(1 - mu/mu_s), about the slope of a 0.1 Hz high-pass on average.
  for (double sigma0 : {10e3, 36e3, 100e3}) {  // 1/m
    truth::Rig rig;
    rig.duration = 10;
    const truth::Run run = truth::simulate(rig);
    Trace trace = run.trace;
    const double slope = rig.stiffness * rig.speed() * rig.radius / rig.load;
    const double disc = rig.speed() * rig.radius;
    for (std::size_t i = 0; i < trace.size(); ++i) {
      if (std::abs(trace.velocity[i] - disc) > 1.5e-4) continue;  // in slip
      const double remaining = std::max(0.02, 1 - trace.friction[i] / rig.static_friction);
      trace.velocity[i] -= slope / sigma0 / remaining;
    }
    EXPECT_EQ(compute_motion(std::move(trace)).high_pass, 0) << sigma0;
  }
}

TEST(HighPass, ARippleOfTheDiscIsNotMistakenForIt) {
  truth::Rig rig;
  rig.duration = 5;  // a third of a revolution: the plateau falls throughout
  const truth::Run run = truth::simulate(rig);
  Trace trace = run.trace;
  const double disc = rig.speed() * rig.radius;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (std::abs(trace.velocity[i] - disc) < 1.5e-4)
      trace.velocity[i] += 0.05 * disc * std::cos(rig.speed() * trace.time[i]);
  }
  EXPECT_EQ(compute_motion(std::move(trace)).high_pass, 0);
}

}  // namespace
}  // namespace tribofit
