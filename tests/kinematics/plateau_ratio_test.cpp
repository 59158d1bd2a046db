// A plateau of v_b that is not omega r: measured whatever the contact does in stick, corrected when asked.
#include <gtest/gtest.h>

#include <cmath>

#include "stick_slip_truth.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {
namespace {

struct Case {
  Trace recorded, truth;
  truth::Rig rig;
};

Case make(double ratio, double gain, unsigned seed = 1) {
  Case made;
  made.rig.duration = 8;
  made.rig.scatter = 0.004;
  made.rig.seed = seed;
  made.recorded = made.truth = truth::simulate(made.rig).trace;
  made.recorded.conditions.radius.value /= ratio;
  for (double& v : made.recorded.velocity) v *= gain;
  return made;
}

double error_of(const Motion& motion, const Case& made) {
  double squares = 0;
  const double disc = made.rig.speed() * made.rig.radius;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    squares += std::pow(motion.relative_velocity[i] - (disc - made.truth.velocity[i + motion.trimmed]), 2);
  }
  return std::sqrt(squares / static_cast<double>(motion.size()));
}

Motion corrected(Case made, PlateauCorrection correction) {
  MotionOptions options;
  options.plateau = correction;
  return compute_motion(std::move(made.recorded), {}, options);
}

TEST(PlateauRatio, IsMeasuredAndLeftAlone) {
  for (double ratio : {0.9, 0.95, 1.0, 1.05, 1.1}) {
    const Case made = make(ratio, 1);
    const Motion motion = compute_motion(made.recorded);
    EXPECT_NEAR(motion.plateau_ratio, ratio, 2e-4) << ratio;
    EXPECT_GT(motion.plateau_ratio_std_error, 0);
    EXPECT_LT(motion.plateau_ratio_std_error, 1e-3);
    EXPECT_EQ(motion.plateau_correction, PlateauCorrection::none);
    EXPECT_EQ(motion.corrected_ratio, 1);
    const double stated = made.rig.speed() * made.rig.radius / ratio;
    EXPECT_DOUBLE_EQ(motion.constant_disc_velocity, stated);
    EXPECT_NEAR(motion.plateau_velocity, stated * (1 - ratio), 1e-5);
  }
}

TEST(PlateauRatio, StickIsFoundWhateverItIs) {
  for (double ratio : {0.9, 0.95, 1.05, 1.1}) {
    for (bool gain : {false, true}) {
      const Case made = make(gain ? 1 : ratio, gain ? ratio : 1);
      const std::size_t truth = find_cycles(compute_motion(made.truth)).cycles.size();
      EXPECT_EQ(find_cycles(compute_motion(made.recorded)).cycles.size(), truth) << ratio << gain;
    }
  }
}

TEST(PlateauRatio, RadiusAndGainAreCorrectedWhenAsked) {
  for (double ratio : {0.92, 1.08}) {
    const Case radius = make(ratio, 1), gain = make(1, ratio);
    const Motion by_radius = corrected(radius, PlateauCorrection::radius);
    EXPECT_LT(error_of(by_radius, radius), 5e-6);
    EXPECT_NEAR(by_radius.constant_disc_velocity, radius.rig.speed() * radius.rig.radius, 2e-6);
    EXPECT_NEAR(by_radius.plateau_velocity, 0, 5e-6);
    EXPECT_EQ(by_radius.corrected_ratio, by_radius.plateau_ratio);
    EXPECT_FALSE(by_radius.notes.empty());
    const Motion by_gain = corrected(gain, PlateauCorrection::gain);
    // The noise was read through the same gain: 0.02 mm/s times what is put right, times the slip's 0.1 %.
    EXPECT_LT(error_of(by_gain, gain), 5e-6);
    EXPECT_NEAR(by_gain.velocity_noise, 2e-5, 3e-6);
    EXPECT_NEAR(by_gain.plateau_velocity, 0, 5e-6);
    // Each leaves the other's error in slip.
    EXPECT_GT(error_of(corrected(gain, PlateauCorrection::radius), gain), 5e-4);
  }
}

TEST(PlateauRatio, BehindAHighPassItFollowsFromNoNetDisplacement) {
  for (double ratio : {0.93, 1.0, 1.06}) {
    Case made = make(ratio, 1);
    truth::high_pass(made.recorded.velocity, 0.2, made.rig.rate);
    const Motion motion = compute_motion(made.recorded);
    ASSERT_GT(motion.high_pass, 0);
    EXPECT_NEAR(motion.plateau_ratio, ratio, 3e-3);
    EXPECT_NEAR(motion.plateau_ratio, ratio, 4 * motion.plateau_ratio_std_error);
    EXPECT_LT(error_of(corrected(made, PlateauCorrection::radius), made), 5e-5) << ratio;
    Case gain = make(1, ratio);
    truth::high_pass(gain.recorded.velocity, 0.2, gain.rig.rate);
    EXPECT_LT(error_of(corrected(gain, PlateauCorrection::gain), gain), 5e-5) << ratio;
  }
}

TEST(PlateauRatio, CreepOfABristleIsTakenOff) {
  for (double sigma0 : {12e3, 36e3, 200e3}) {  // 1/m
    for (double ratio : {0.95, 1.0}) {
      Case made = make(ratio, 1);
      Trace& trace = made.recorded;
      const double disc = made.rig.speed() * made.rig.radius;
      const double rise = made.rig.stiffness * disc / made.rig.load;
      double creep = 0, count = 0, slipped = 0;
      const std::vector<double> rigid = trace.velocity;
      const auto slips = [&](std::size_t i) { return std::abs(rigid[i] - disc) > 1.5e-4; };
      for (std::size_t i = 0; i < trace.size(); ++i) {
        if (slips(i)) {
          slipped += disc - rigid[i];
          continue;
        }
        const double v = rise / sigma0 / std::max(0.02, 1 - made.truth.friction[i] / made.rig.static_friction);
        trace.velocity[i] -= v;
        creep += v, count += 1;
      }
      // The spring holds the block, which slips by as much less.
      for (std::size_t i = 0; i < trace.size(); ++i) {
        if (slips(i)) trace.velocity[i] += creep / slipped * (disc - rigid[i]);
      }
      const Motion motion = compute_motion(trace);
      const double mean_creep = creep / count / disc;
      EXPECT_NEAR(motion.plateau_ratio, ratio, 0.002 + 0.15 * mean_creep) << sigma0 << " creep " << mean_creep;
    }
  }
}

TEST(PlateauRatio, IsUnknownWhereNothingWasStatedOrMeasuredDirectly) {
  Case made = make(1, 1);
  Trace unstated = made.recorded;
  unstated.conditions.speed = {};
  EXPECT_TRUE(std::isnan(compute_motion(unstated).plateau_ratio));
  Trace relative = made.recorded;
  relative.velocity_kind = VelocityKind::relative;
  for (double& v : relative.velocity) v = made.rig.speed() * made.rig.radius - v;
  EXPECT_TRUE(std::isnan(compute_motion(relative).plateau_ratio));
}

}  // namespace
}  // namespace tribofit
