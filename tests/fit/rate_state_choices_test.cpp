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
    for (std::size_t s = 0; s < analysis.steps.size(); ++s) {
      const VelocityStep& step = analysis.steps[s];
      EXPECT_EQ(step.recorded, kSteps[s + 1].begin);
      EXPECT_NEAR(step.time, late[s + 1].begin, 0.01) << s;
      EXPECT_NEAR(step.time, late[s + 1].begin, 4 * step.time_std_error) << s;
    }
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

/// A drive that runs up over seconds is a flight of stairs in its record, and its last ones nearly are sliding.
TEST(RateState, RampsAndRunUpsMakeOneStep) {
  for (const bool settles : {false, true}) {
    const RateStateMachine machine = machine_of(StateEvolution::ageing, 5);
    const auto stairs = [&](double width) {
      std::vector<LoadPointPhase> out = {{0, 2e-6}};
      for (const auto& [begin, from, to] : {std::array{60.0, 2e-6, 10e-6}, std::array{100.0, 10e-6, 2e-6}}) {
        for (double t = 0; t < (settles ? 12 : 6); t += width) {
          const double part = settles ? 1 - std::exp(-(t + 0.5 * width) / 1.5) : (t + 0.5 * width) / 6;
          out.push_back({begin + t, from + (to - from) * part, true});
        }
        out.push_back({begin + (settles ? 12 : 6), to});
      }
      return out;
    };
    Motion motion = motion_from(machine, stairs(0.05), times_until(160, 20), 1e-4);
    motion.load_point = stairs(0.5);
    const RateStateAnalysis analysis = fit_rate_state(motion, together());
    ASSERT_TRUE(analysis.fitted()) << analysis.reason;
    ASSERT_EQ(analysis.steps.size(), 2U);
    EXPECT_NEAR(analysis.steps[0].before, 2e-6, 1e-8);
    EXPECT_NEAR(analysis.steps[0].after, 10e-6, 5e-7);
    EXPECT_TRUE(analysis.is_answered());
    expect_recovered(analysis.fits[0], machine, 0.03, 0.05);
  }
}

/// Slides of one length, up and down in threefold steps, are all slides.
TEST(RateState, SlidesOfOneLengthAreNoRamp) {
  std::vector<LoadPointPhase> phases;
  double t = 0;
  for (const double speed : {1e-6, 3e-6, 10e-6, 30e-6, 10e-6, 3e-6, 1e-6}) {
    phases.push_back({t, speed});
    t += 100e-6 / speed;
  }
  const RateStateAnalysis analysis =
      fit_rate_state(motion_from(machine_of(StateEvolution::ageing, 5), phases, times_until(t, 20), 1e-4), together());
  EXPECT_EQ(analysis.steps.size(), 6U);
}

/// A run-up before the first sliding and after a hold, and a run-down before it, are no steps either.
TEST(RateState, RampsBesideRestsAndEndsMakeNoSteps) {
  std::vector<LoadPointPhase> phases;
  const auto ramp = [&](double begin, double from, double to) {
    for (int k = 0; k < 4; ++k) phases.push_back({begin + 0.1 * k, from + (to - from) * (k + 0.5) / 4, true});
  };
  ramp(0, 0, 10e-6);
  phases.push_back({0.4, 10e-6});
  ramp(40, 10e-6, 0);
  phases.push_back({40.4, 0});
  ramp(60, 0, 10e-6);
  phases.push_back({60.4, 10e-6});
  const RateStateMachine machine = machine_of(StateEvolution::ageing, 5);
  const RateStateAnalysis analysis =
      fit_rate_state(motion_from(machine, phases, times_until(100, 20), 1e-4), together());
  ASSERT_EQ(analysis.steps.size(), 1U) << analysis.reason;
  EXPECT_NEAR(analysis.steps[0].hold, 19.6, 1e-9);
  EXPECT_EQ(analysis.reference_speed, 10e-6);
  EXPECT_GT(analysis.steps[0].from, 20) << "friction still answers the run-up";
  ASSERT_TRUE(analysis.fitted());
  expect_recovered(analysis.fits[0], machine, 0.03, 0.05);
}

/// Unequal slides in a row, of which those between are short beside the first and the last.
TEST(RateState, ShortSlidesAreNoRamp) {
  const std::vector<LoadPointPhase> phases = {{0, 10e-6}, {600, 20e-6}, {700, 50e-6}, {800, 100e-6}};
  const RateStateAnalysis analysis = fit_rate_state(
      motion_from(machine_of(StateEvolution::ageing, 5), phases, times_until(1400, 2), 1e-4), together());
  EXPECT_EQ(analysis.steps.size(), 3U);
}

/// An answer far above the noise of a sample is one, however much the noise wanders.
TEST(RateState, DriftDoesNotHideAnAnswer) {
  Motion motion = motion_from(machine_of(StateEvolution::ageing, 5), {{0, 2e-6}, {60, 20e-6}, {80, 2e-6}},
                              times_until(140, 20), 2e-3);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  double wanders = 0;
  for (double& mu : motion.friction) {
    wanders += -wanders / 1200 + 2e-3 * std::sqrt(2.0 / 1200) * normal(generator);
    mu += wanders;
  }
  EXPECT_TRUE(fit_rate_state(motion, together()).is_answered());
}

TEST(RateState, AllValuesHeldIsAFitToo) {
  RateStateOptions options = together();
  const RateStateMachine machine = machine_of(StateEvolution::ageing, 5);
  const auto& p = machine.parameters;
  options.given = {{"a", std::nullopt, GivenParameter::Bounds{p.a, p.a}},
                   {"b", std::nullopt, GivenParameter::Bounds{p.b[0], p.b[0]}},
                   {"D_c", std::nullopt, GivenParameter::Bounds{p.distance[0], p.distance[0]}},
                   {"k", std::nullopt, GivenParameter::Bounds{p.stiffness, p.stiffness}}};
  const RateStateAnalysis analysis = fit_rate_state(motion_from(machine, kSteps, times_until(250, 20), 1e-4), options);
  ASSERT_TRUE(analysis.fitted()) << analysis.reason;
  EXPECT_NEAR(analysis.fits[0].error.rmse, 1e-4, 5e-6);
  EXPECT_TRUE(std::isnan(analysis.answer_p_value));
}

TEST(RateState, NoiseThatAnswersNothingSaysNothing) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Motion motion;
    motion.time = times_until(140, 20);
    motion.relative_velocity.assign(motion.size(), 0.0);
    motion.load_point = {{0, 2e-6}, {60, 20e-6}, {80, 2e-6}};
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    double wanders = 0;
    for (std::size_t i = 0; i < motion.time.size(); ++i) {
      wanders += -0.02 * wanders + (seed % 2 == 0 ? 4e-5 : 0.0) * normal(generator);
      motion.friction.push_back(0.6 + 2e-4 * normal(generator) + wanders);
    }
    const RateStateAnalysis analysis = fit_rate_state(motion, together());
    EXPECT_FALSE(analysis.is_answered()) << seed << ": p " << analysis.answer_p_value;
  }
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
  const double ratio = machine.parameters.stiffness / critical_stiffness(machine.parameters, 2);
  EXPECT_GT(ratio, fit.stiffness_ratio_lower95);
  EXPECT_LT(ratio, fit.stiffness_ratio_upper95);
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
  EXPECT_NEAR(analysis.fits[0].error.rmse, 2e-4, 3e-6);
  EXPECT_NEAR(analysis.fits[0].error.held_out_rmse, 2e-4, 3e-6);
}

}  // namespace tribofit
