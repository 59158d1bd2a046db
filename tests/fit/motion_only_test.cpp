#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"

// A mass on a spring whose base is shaken, of which only the motion is recorded; simulated apart from the library.

namespace tribofit {
namespace {

using ::testing::HasSubstr;

struct Frame {
  double mass = 3.08, stiffness = 1191, damping = 0.67;           // SI
  double static_force = 0.95, kinetic_force = 0.75, decay = 150;  ///< [N], [N], [s/m]
  bool rubs_on_base = false;
  double shake = 1.8e-3, frequency = 1, growth = 1.6;  ///< [m], [Hz]; from the first half to the second
  double duration = 30, rate = 500, noise = 0.5e-6;    ///< [s], [Hz], [m]
  std::uint64_t seed = 1;
};

struct Shaken {
  std::shared_ptr<Trace> trace = std::make_shared<Trace>();
  std::vector<double> velocity, friction;  ///< against what it rubs on [m/s], [N]
};

/// Runge-Kutta of fourth order, twenty steps a sample; what turns round against its counterface rests there while
/// friction can hold it.
class Simulation {
 public:
  explicit Simulation(const Frame& frame) : f_(frame), random_(frame.seed) {}

  Shaken run() {
    constexpr int kSteps = 20;
    const double h = 1 / (kSteps * f_.rate);
    Shaken out;
    Trace& trace = *out.trace;
    for (std::size_t i = 0; i < static_cast<std::size_t>(f_.duration * f_.rate); ++i) {
      trace.time.push_back(static_cast<double>(i) / f_.rate);
      trace.block_position.push_back(x_ + f_.noise * normal_(random_));
      trace.drive_position.push_back(base(t_)[0] + f_.noise * normal_(random_));
      out.velocity.push_back(against());
      out.friction.push_back(sticks_ ? holding() : direction_ * size(against()));
      for (int k = 0; k < kSteps; ++k) step(h);
    }
    trace.path = "simulated";
    trace.kind = RecordKind::motion_only;
    trace.velocity_kind = VelocityKind::relative;
    trace.spring.mass = {f_.mass, "test"};
    trace.spring.stiffness = {f_.stiffness, "test"};
    trace.spring.damping = {f_.damping, "test"};
    trace.steps = {{0, trace.time.size(), "", {}}};
    return out;
  }

 private:
  /// Displacement, velocity, acceleration of the base.
  std::array<double, 3> base(double t) const {
    const double w = 2 * std::numbers::pi * f_.frequency;
    const double a = f_.shake * (t < f_.duration / 2 ? 1 : f_.growth);
    return {a * std::sin(w * t), a * w * std::cos(w * t), -a * w * w * std::sin(w * t)};
  }
  double size(double v) const {
    return f_.kinetic_force + (f_.static_force - f_.kinetic_force) * std::exp(-f_.decay * std::abs(v));
  }
  double against() const { return sticks_ ? 0 : f_.rubs_on_base ? v_ - base(t_)[1] : v_; }
  /// What keeps the mass where it is.
  double holding() const {
    const auto y = base(t_);
    const double v = f_.rubs_on_base ? y[1] : 0, a = f_.rubs_on_base ? y[2] : 0;
    return -(f_.mass * a + f_.damping * (v - y[1]) + f_.stiffness * (x_ - y[0]));
  }
  double acceleration(double t, double x, double v) const {
    const auto y = base(t);
    const double v_r = f_.rubs_on_base ? v - y[1] : v;
    return -(f_.damping * (v - y[1]) + f_.stiffness * (x - y[0]) + direction_ * size(v_r)) / f_.mass;
  }

  void step(double h) {
    if (sticks_) {
      if (f_.rubs_on_base) x_ += base(t_ + h)[0] - base(t_)[0];
      t_ += h;
      v_ = f_.rubs_on_base ? base(t_)[1] : 0;
      if (std::abs(holding()) <= f_.static_force) return;
      direction_ = holding() > 0 ? 1 : -1;
      sticks_ = false;
      return;
    }
    double slope[4][2], x = x_, v = v_;
    for (int k = 0; k < 4; ++k) {
      slope[k][0] = v;
      slope[k][1] = acceleration(t_ + (k == 0 ? 0 : k < 3 ? h / 2 : h), x, v);
      const double part = k < 2 ? h / 2 : h;
      x = x_ + part * slope[k][0];
      v = v_ + part * slope[k][1];
    }
    x_ += h / 6 * (slope[0][0] + 2 * slope[1][0] + 2 * slope[2][0] + slope[3][0]);
    v_ += h / 6 * (slope[0][1] + 2 * slope[1][1] + 2 * slope[2][1] + slope[3][1]);
    t_ += h;
    if (direction_ * against() > 0) return;
    v_ = f_.rubs_on_base ? base(t_)[1] : 0;
    sticks_ = std::abs(holding()) <= f_.static_force;
    if (!sticks_) direction_ = holding() > 0 ? 1 : -1;
  }

  Frame f_;
  double t_ = 0, x_ = 0, v_ = 0;
  int direction_ = 1;
  bool sticks_ = true;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

Identification prepared(const Shaken& shaken) {
  return prepare_trace({"simulated", {}, shaken.trace});
}

TEST(MotionOnly, VelocityAndFrictionAreWithinTheirStatedErrors) {
  for (const bool on_base : {false, true}) {
    const Frame frame{.rubs_on_base = on_base, .frequency = on_base ? 4.0 : 1.0};
    const Shaken shaken = Simulation(frame).run();
    const Motion motion = compute_motion(*shaken.trace);
    ASSERT_EQ(motion.size(), shaken.velocity.size());
    EXPECT_EQ(motion.spring.counterface, on_base ? Counterface::base : Counterface::ground);
    std::vector<double> v, f;
    for (std::size_t i = 0; i < motion.size(); ++i) {
      if (motion.has_fault(i, SampleFault::any)) continue;
      v.push_back((motion.relative_velocity[i] - shaken.velocity[i]) / motion.velocity_std_error[i]);
      f.push_back((motion.friction[i] - shaken.friction[i]) / motion.friction_std_error[i]);
    }
    EXPECT_GT(v.size(), motion.size() / 2);
    for (std::vector<double>* pulls : {&v, &f}) {
      double mean = 0, squares = 0;
      for (const double z : *pulls) mean += z / static_cast<double>(pulls->size());
      EXPECT_LT(std::abs(mean), 0.2);
      std::sort(pulls->begin(), pulls->end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
      pulls->resize(pulls->size() - pulls->size() / 100);  // beside the kinks
      for (const double z : *pulls) squares += z * z / static_cast<double>(pulls->size());
      EXPECT_LT(std::sqrt(squares), 2) << (pulls == &v ? "velocity" : "friction") << (on_base ? " on base" : "");
    }
  }
}

TEST(MotionOnly, LawAndLevelsAreThoseOfTheSimulation) {
  const Frame frame;
  Identification result = prepared(Simulation(frame).run());
  EXPECT_EQ(kind_of_record(result.motion, result.segmentation), RecordKind::motion_only);
  ASSERT_TRUE(result.friction_levels);
  ASSERT_EQ(result.friction_levels->levels.size(), 2U);
  const auto& small = result.friction_levels->levels[0];
  const auto& large = result.friction_levels->levels[1];
  EXPECT_LT(small.fastest_peak, large.slowest_peak * 1.0001);
  EXPECT_GT(large.fastest_peak, 1.3 * small.slowest_peak);
  EXPECT_NEAR(small.friction.value, frame.kinetic_force, 0.05 * frame.kinetic_force);
  EXPECT_NEAR(large.friction.value, frame.kinetic_force, 0.03 * frame.kinetic_force);
  ASSERT_GT(result.friction_levels->bins.size(), 8U);
  for (const auto& bin : result.friction_levels->bins) {
    const double truth = frame.kinetic_force +
                         (frame.static_force - frame.kinetic_force) * std::exp(-frame.decay * std::abs(bin.velocity));
    EXPECT_NEAR(std::abs(bin.friction.value), truth, 0.04 * truth) << bin.velocity;
  }
  IdentifyOptions options;
  options.laws = {ExponentialLaw{}};
  fit_trace(options, result);
  ASSERT_TRUE(result.analysed);
  const std::vector<FitParameter>& found = result.fits.at(result.best).parameters;
  EXPECT_NEAR(found.at(0).value, frame.static_force, 0.04 * frame.static_force);
  EXPECT_NEAR(found.at(1).value, frame.kinetic_force, 0.02 * frame.kinetic_force);
  EXPECT_NEAR(found.at(2).value, frame.decay, 0.2 * frame.decay);
}

TEST(MotionOnly, ZerosOfTheDisplacementsDoNotMatter) {
  const Shaken shaken = Simulation({}).run();
  const Motion plain = compute_motion(*shaken.trace);
  for (double& x : shaken.trace->block_position) x += 0.3e-3;  // 0.36 N of the spring
  const Motion moved = compute_motion(*shaken.trace);
  for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_NEAR(plain.friction[i], moved.friction[i], 1e-6) << i;
}

TEST(MotionOnly, WhatIsNotKnownIsAskedForAndNoRigIsFound) {
  const Shaken shaken = Simulation({.duration = 4}).run();
  const RigIdentification rig = identify_rig({"simulated", {}, shaken.trace});
  EXPECT_FALSE(rig.rig.determined);
  EXPECT_THAT(rig.rig.reason, HasSubstr("stated mass"));
  shaken.trace->spring.mass = {};
  try {
    compute_motion(*shaken.trace);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.advice(), HasSubstr("--mass"));
  }
}

}  // namespace
}  // namespace tribofit
