// Break-away between samples: bias and scatter of time and friction level, and whether the stated errors are honest.
#include <gtest/gtest.h>

#include <cmath>

#include "../kinematics/stick_slip_truth.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {
namespace {

struct Errors {
  double bias = 0, scatter = 0, normalised = 0;  // mean, standard deviation, root mean square over the stated error
};

Errors errors_of(const std::vector<double>& deviation, const std::vector<double>& stated) {
  Errors e;
  const auto n = static_cast<double>(deviation.size());
  for (double d : deviation) e.bias += d / n;
  for (std::size_t k = 0; k < deviation.size(); ++k) {
    e.scatter += (deviation[k] - e.bias) * (deviation[k] - e.bias) / n;
    e.normalised += deviation[k] * deviation[k] / (stated[k] * stated[k]) / n;
  }
  e.scatter = std::sqrt(e.scatter);
  e.normalised = std::sqrt(e.normalised);
  return e;
}

struct Case {
  double correlation, scatter, decay;
  bool coulomb;
};

class BreakAway : public testing::TestWithParam<Case> {};

TEST_P(BreakAway, TimeAndFrictionAgainstTruth) {
  const Case c = GetParam();
  truth::Rig rig;
  rig.noise_correlation = c.correlation;
  rig.scatter = c.scatter;
  rig.decay = c.decay;
  rig.coulomb = c.coulomb;
  rig.duration = 20;
  const truth::Run run = truth::simulate(rig);
  const Segmentation s = find_cycles(compute_motion(run.trace));
  ASSERT_EQ(s.cycles.size(), run.break_away_time.size());
  std::vector<double> time, time_error, friction, friction_error, restick;
  for (std::size_t k = 0; k < s.cycles.size(); ++k) {
    time.push_back(s.cycles[k].break_away_time - run.break_away_time[k]);
    time_error.push_back(s.cycles[k].break_away_time_std_error);
    friction.push_back(s.cycles[k].break_away_friction - run.break_away_friction[k]);
    friction_error.push_back(s.cycles[k].break_away_friction_std_error);
    if (s.cycles[k].slip_complete) restick.push_back(s.cycles[k].restick_time - run.restick_time[k]);
  }
  const Errors t = errors_of(time, time_error), mu = errors_of(friction, friction_error);
  const bool white = c.correlation == 0;
  EXPECT_LT(std::abs(t.bias), white ? 0.05e-3 : 0.2e-3);  // a sample is 0.05 ms
  EXPECT_LT(t.scatter, white ? 0.02e-3 : 0.05e-3);
  EXPECT_LT(std::abs(mu.bias), 5e-4);
  EXPECT_LT(mu.scatter, white ? 2.5e-4 : 1e-3);
  EXPECT_GT(mu.normalised, 0.75);
  EXPECT_LT(mu.normalised, 1.35);
  EXPECT_LT(t.normalised, 2.5);
  const Errors r = errors_of(restick, std::vector<double>(restick.size(), 1.0));
  EXPECT_LT(std::abs(r.bias), 0.02e-3);
  EXPECT_LT(r.scatter, 0.02e-3);
}

INSTANTIATE_TEST_SUITE_P(Twins, BreakAway,
                         testing::Values(Case{0, 0, 52.14, false}, Case{0, 0.004, 52.14, false},
                                         Case{0, 0.02, 52.14, false}, Case{0.9, 0, 52.14, false},
                                         Case{0.9, 0.004, 52.14, false}, Case{0, 0.004, 32.37, false},
                                         Case{0.9, 0.004, 32.37, false}, Case{0, 0.004, 52.14, true},
                                         Case{0.9, 0.004, 52.14, true}));

TEST(BreakAwayTime, AStepOfTheDiscAtOneSpoilsNoOther) {
  for (unsigned seed : {1U, 2U, 3U}) {
    for (double ratio : {2.0, 4.0}) {
      truth::Rig rig;
      rig.rate = 5000;
      rig.rpm = 2;
      rig.duration = 12;
      rig.scatter = 0.003;
      rig.seed = seed;
      // The disc steps a little after a break-away in the middle, before the velocity has grown.
      const truth::Run even = truth::simulate(rig);
      const std::size_t stepping = even.break_away_time.size() / 2;
      rig.step_at = even.break_away_time[stepping] + 1e-3;
      rig.speed_ratio = ratio;
      truth::Run run = truth::simulate(rig);
      for (double t : run.trace.time) run.trace.disc_speed.push_back(rig.disc(t) / rig.radius);
      run.trace.conditions.speed = {};
      const Segmentation s = find_cycles(compute_motion(run.trace));
      ASSERT_EQ(s.cycles.size(), run.break_away_time.size());
      double before = 0, after = 0;
      for (std::size_t k = 0; k < s.cycles.size(); ++k) {
        const double off = s.cycles[k].break_away_time - run.break_away_time[k];
        EXPECT_LT(std::abs(off), k == stepping ? 2e-3 : 0.5e-3) << k;  // a sample is 0.2 ms
        if (k != stepping) (k < stepping ? before : after) += off;
      }
      EXPECT_LT(std::abs(before) / static_cast<double>(stepping), 0.1e-3) << ratio;
      EXPECT_LT(std::abs(after) / static_cast<double>(s.cycles.size() - stepping - 1), 0.1e-3) << ratio;
    }
  }
}

TEST(BreakAwayTime, FollowsAPureShiftOfTheRecordBetweenSamples) {
  // The same motion sampled with clocks a third of a sample apart must give the same instants.
  truth::Rig rig;
  rig.friction_noise = rig.velocity_noise = 0;
  const truth::Run run = truth::simulate(rig);
  const Segmentation whole = find_cycles(compute_motion(run.trace));
  truth::Rig slower = rig;
  slower.rate = 5000;
  const Segmentation coarse = find_cycles(compute_motion(truth::simulate(slower).trace));
  ASSERT_EQ(whole.cycles.size(), coarse.cycles.size());
  for (std::size_t k = 0; k < whole.cycles.size(); ++k) {
    EXPECT_NEAR(whole.cycles[k].break_away_time, coarse.cycles[k].break_away_time, 1e-4);
  }
}

TEST(BreakAwayTime, CreepBeforeASlipStaysInTheStick) {
  truth::Rig rig;
  rig.duration = 10;
  const truth::Run run = truth::simulate(rig);
  Trace trace = run.trace;
  const double disc = rig.speed() * rig.radius;
  const double slope = rig.stiffness * disc / rig.load;
  for (std::size_t i = 0; i < trace.size(); ++i) {
    if (std::abs(trace.velocity[i] - disc) > 1.5e-4) continue;
    trace.velocity[i] -= slope / 100e3 / std::max(0.02, 1 - trace.friction[i] / rig.static_friction);
  }
  const Segmentation s = find_cycles(compute_motion(std::move(trace)));
  ASSERT_EQ(s.cycles.size(), run.break_away_time.size());
  for (std::size_t k = 1; k < s.cycles.size(); ++k) {
    EXPECT_NEAR(s.cycles[k].break_away_time, run.break_away_time[k], 8e-3);  // of a stick of 170 ms
  }
}

}  // namespace
}  // namespace tribofit
