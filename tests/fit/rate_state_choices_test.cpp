#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "rate_state_records.hpp"

// What is chosen from the data: times of the steps, the number of state variables.

namespace tribofit {

/// Drives run up and have play: friction that answers a fifth of a second late is no softer machine.
TEST(RateState, StepsThatFrictionAnswersLateAreMoved) {
  for (const StateEvolution evolution : state_evolutions) {
    const RateStateMachine machine = machine_of(evolution, 20);
    std::vector<LoadPointPhase> late = kSteps;
    for (std::size_t i = 1; i < late.size(); ++i) late[i].begin += i % 2 == 0 ? 0.13 : 0.2;
    Motion motion = motion_from(machine, late, times_until(250, 20), 1e-4);
    motion.load_point = kSteps;
    const RateStateAnalysis analysis = fit_rate_state(motion, together());
    ASSERT_TRUE(analysis.fitted()) << analysis.reason;
    expect_recovered(analysis.fits[evolution == StateEvolution::ageing ? 0 : 1], machine, 0.03, 0.05);
    for (std::size_t s = 0; s < analysis.steps.size(); ++s)
      EXPECT_NEAR(analysis.steps[s].time, late[s + 1].begin, 0.01) << s;
    EXPECT_THAT(analysis.messages, ::testing::Contains(::testing::HasSubstr("moved by up to 0.2 s")));
  }
}

/// Both ends of a hold: at rest friction goes on to fall, and the slope behind it is that of the machine.
TEST(RateState, HoldsThatFrictionAnswersLateAreMoved) {
  for (const StateEvolution evolution : state_evolutions) {
    const RateStateMachine machine = machine_of(evolution, 5);
    const std::vector<LoadPointPhase> recorded = {{0, 10e-6}, {20, 0}, {30, 10e-6}, {60, 0}, {120, 10e-6}};
    std::vector<LoadPointPhase> late = recorded;
    for (std::size_t i = 1; i < late.size(); ++i) late[i].begin += i % 2 == 0 ? 0.06 : 0.17;
    Motion motion = motion_from(machine, late, times_until(160, 20), 1e-4);
    motion.load_point = recorded;
    const RateStateAnalysis analysis = fit_rate_state(motion, together());
    ASSERT_TRUE(analysis.fitted()) << analysis.reason;
    expect_recovered(analysis.fits[evolution == StateEvolution::ageing ? 0 : 1], machine, 0.03, 0.05);
    ASSERT_EQ(analysis.steps.size(), 2U);
    for (std::size_t s = 0; s < 2; ++s) {
      EXPECT_NEAR(analysis.steps[s].time, late[1 + 2 * s].begin, 0.02) << s;
      EXPECT_NEAR(analysis.steps[s].time + analysis.steps[s].hold, late[2 + 2 * s].begin, 0.02) << s;
    }
  }
}

TEST(RateState, StepsThatFrictionAnswersAtOnceStayWhereTheyAre) {
  const RateStateAnalysis analysis = fit_rate_state(
      motion_from(machine_of(StateEvolution::ageing, 20), kSteps, times_until(250, 20), 1e-4), together());
  ASSERT_TRUE(analysis.fitted()) << analysis.reason;
  for (std::size_t s = 0; s < analysis.steps.size(); ++s) EXPECT_EQ(analysis.steps[s].time, kSteps[s + 1].begin) << s;
}

/// Where a line over the displacement can pass for the slow state, its sign hangs on the second.
TEST(RateState, ASecondStateIsFoundWhereItIs) {
  RateStateMachine machine = machine_of(StateEvolution::ageing, 20, 0.012, 0.010);
  machine.parameters.stiffness = 1e-2 / kMicrometre;
  machine.states = 2;
  machine.parameters.b[1] = 0.007;
  machine.parameters.distance[1] = 200 * kMicrometre;
  const std::vector<LoadPointPhase> phases = {{0, 2e-6}, {60, 10e-6}};
  const RateStateAnalysis analysis =
      fit_rate_state(motion_from(machine, phases, times_until(200, 20), 2e-4), together());
  ASSERT_TRUE(analysis.fitted()) << analysis.reason;
  ASSERT_EQ(analysis.states, 2U);
  const RateStateFit& fit = analysis.fits[0];
  const std::array<double, 6> truth = {0.012, 0.010, 10e-6, 0.007, 200e-6, 1e4};
  for (std::size_t k = 0; k < truth.size(); ++k)
    EXPECT_NEAR(fit.parameters[k].value, truth[k], 4 * fit.parameters[k].std_error) << fit.parameters[k].parameter.name;
  EXPECT_LT(fit.rate_dependence_upper95, 0);
}

/// What wanders is much like the answer of a second state.
TEST(RateState, OneStateIsLeftAlone) {
  Motion motion = motion_from(machine_of(StateEvolution::slip, 5), kSteps, times_until(250, 20), 1e-4);
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  double wanders = 0;
  for (double& friction : motion.friction) {
    wanders = 0.975 * wanders + 4.4e-5 * normal(generator);
    friction += wanders;
  }
  const RateStateAnalysis analysis = fit_rate_state(motion, together());
  EXPECT_EQ(analysis.states, 1U);
  EXPECT_EQ(analysis.second_state, SecondState::not_needed);
  EXPECT_GT(analysis.states_p_value, 1e-8);
}

/// A drive that takes a while to reach the speed passes as it does, and later than is said: its ramp moves as a whole.
TEST(RateState, RampsThatFrictionAnswersLateAreMovedWhole) {
  const RateStateMachine machine = machine_of(StateEvolution::ageing, 20);
  const std::vector<LoadPointPhase> recorded = {{0, 2e-6}, {60, 6e-6}, {60.4, 10e-6}, {100, 6e-6}, {100.4, 2e-6}};
  std::vector<LoadPointPhase> late = recorded;
  for (std::size_t i = 1; i < late.size(); ++i) late[i].begin += 0.5;
  Motion motion = motion_from(machine, late, times_until(160, 20), 1e-4);
  motion.load_point = recorded;
  std::vector<RateStateAnalysis> analyses;
  for (const int threads : {1, 2}) {
    RateStateOptions options = together();
    options.threads = threads;
    analyses.push_back(fit_rate_state(motion, options));
  }
  const RateStateAnalysis& analysis = analyses.front();
  ASSERT_TRUE(analysis.fitted()) << analysis.reason;
  expect_recovered(analysis.fits[0], machine, 0.03, 0.05);
  for (std::size_t s = 0; s < 2; ++s) EXPECT_NEAR(analysis.steps[s].time, late[1 + 2 * s].begin, 0.02) << s;
  for (std::size_t k = 0; k < 4; ++k)
    EXPECT_EQ(analysis.fits[0].parameters[k].value, analyses.back().fits[0].parameters[k].value);
}

/// A load point that is said to turn where it does not is no reason to trust what fits best as far off as is allowed.
TEST(RateState, ATimeThatIsHeldByWhatIsKnownOfItIsSaid) {
  const RateStateMachine machine = machine_of(StateEvolution::ageing, 20);
  const std::vector<LoadPointPhase> stated = {{0, 2e-6}, {60, 10e-6}, {64, 2e-6}};
  std::vector<LoadPointPhase> late = stated;
  late[1].begin += 0.5;
  Motion motion = motion_from(machine, late, times_until(120, 20), 1e-4);
  motion.load_point = stated;
  motion.load_point_source = LoadPointSource::stated;
  const RateStateAnalysis analysis = fit_rate_state(motion, together());
  EXPECT_THAT(analysis.messages, ::testing::Contains(::testing::HasSubstr("as far as its time may be wrong")));
}

TEST(RateState, HoldsOfOneLengthHaveNoHealingRate) {
  const std::vector<LoadPointPhase> phases = {{0, 10e-6},  {20, 0},  {30, 10e-6},     {60, 0},
                                              {70, 10e-6}, {100, 0}, {110.001, 10e-6}};
  const Motion motion = motion_from(machine_of(StateEvolution::ageing, 5), phases, times_until(150, 20), 1e-4);
  const RateStateAnalysis analysis = fit_rate_state(motion, together());
  ASSERT_TRUE(analysis.healing.has_value());
  EXPECT_EQ(analysis.healing->holds.size(), 3U);
  EXPECT_TRUE(std::isnan(analysis.healing->per_decade.value));
}

/// A bound that holds b says nothing of whether friction falls with speed.
TEST(RateState, AtABoundStabilityIsNotKnown) {
  RateStateOptions options = together();
  options.given = {{"b", std::nullopt, GivenParameter::Bounds{0.03, 0.05}}};
  const Motion motion = motion_from(machine_of(StateEvolution::ageing, 5), kSteps, times_until(250, 20), 1e-4);
  const RateStateAnalysis analysis = fit_rate_state(motion, options);
  ASSERT_TRUE(analysis.fitted()) << analysis.reason;
  const RateStateFit& fit = analysis.fits[analysis.best];
  ASSERT_TRUE(fit.parameters[1].at_bound);
  EXPECT_TRUE(std::isnan(fit.rate_dependence.value));
  EXPECT_TRUE(std::isnan(fit.stiffness_ratio));
}

/// What is fitted are means of neighbours; what is left is that of the samples.
TEST(RateState, ErrorsAreThoseOfTheSamples) {
  const Motion motion = motion_from(machine_of(StateEvolution::ageing, 5), kSteps, times_until(250, 200), 2e-4);
  const RateStateAnalysis analysis = fit_rate_state(motion, together());
  ASSERT_TRUE(analysis.fitted()) << analysis.reason;
  EXPECT_NEAR(analysis.fits[0].rmse, 2e-4, 3e-6);
  EXPECT_NEAR(analysis.fits[0].held_out_rmse, 2e-4, 3e-6);
}

}  // namespace tribofit
