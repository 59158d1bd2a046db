#include "tribofit/study/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

/// A record of the 15 mm test of [D] with an effect hidden in it, as short and noisy as it takes to leave it open.
TraceInput open_record(const std::string& effect, double value, double duration, double rate, double noise) {
  const PublishedTest test = published_test(0.015, ExponentialLaw{});
  const FrictionModel model(ExponentialLaw{}, {make_effect(effect)});
  std::vector<double> p = test.friction;
  for (std::size_t k = p.size(); k < model.parameters().size(); ++k) {
    const Parameter& q = model.parameters()[k].parameter;
    p.push_back((k == test.friction.size() ? value : q.start) * q.si);
  }
  Drive drive{.speed = constant_speed(test.speed), .radius = test.radius, .mean_load = test.load};
  SimulationOptions options;
  options.duration = duration;
  options.rate = rate;
  options.settle = settling_time(test.rig, drive, p);
  options.scatter = {0.008, 0};
  Sensors sensors;
  sensors.friction_noise = noise;
  sensors.velocity_noise = 0.02e-3;
  auto trace = std::make_shared<Trace>(simulate_recording(model, p, test.rig, drive, options, sensors).recording.trace);
  trace->path = effect + ".csv";
  return {trace->path, {}, trace};
}

struct Planned {
  DiagnosedTraces diagnosed;
  RunPlan plan;
};

Planned plan_of(const TraceInput& input, const Means& means, double effort = 0, int threads = 0) {
  Planned out;
  out.diagnosed = diagnose({input});
  PlanOptions options;
  options.means = means;
  options.effort = effort;
  options.threads = threads;
  out.plan = plan_runs(out.diagnosed, options);
  return out;
}

std::vector<std::string> names_of(const RunPlan& plan) {
  std::vector<std::string> names;
  for (const ModelInQuestion& model : plan.models) names.push_back(model.name);
  return names;
}

/// A lag that these few cycles do not distinguish from a delay or a filter of the reading.
const TraceInput& open_lag() {
  static const TraceInput input = open_record("frictional-lag", 0.5, 6, 4000, 0.006);
  return input;
}

TEST(Plan, ATapSettlesALagOrADelayThatNoSpeedDoes) {
  const Means means{.speeds = {2 * kRpm, 8 * kRpm}, .rates = {50000}, .longest = 60, .tap = true};
  const RunPlan plan = plan_of(open_lag(), means).plan;
  ASSERT_TRUE(plan.answered()) << plan.reason;
  ASSERT_EQ(plan.kind, QuestionKind::group);
  EXPECT_THAT(names_of(plan), testing::Contains("frictional-lag"));
  ASSERT_FALSE(plan.experiments.empty());
  EXPECT_GT(plan.experiments.front().experiment.tap, 0);
  EXPECT_GT(plan.experiments.front().probability, 0.9);
  double sum = 0;
  for (const ModelInQuestion& model : plan.models) sum += model.probability;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(Plan, SpeedsAloneAreHopelessForALagOrADelay) {
  const RunPlan plan = plan_of(open_lag(), {.speeds = {2 * kRpm}, .longest = 20}).plan;
  ASSERT_TRUE(plan.answered()) << plan.reason;
  EXPECT_TRUE(plan.hopeless);
  for (const PlannedExperiment& one : plan.experiments) EXPECT_LT(one.probability, kHopeless);
}

TEST(Plan, DoesNotDependOnThreads) {
  const Means means{.speeds = {2 * kRpm}, .longest = 10};
  const RunPlan one = plan_of(open_lag(), means, 0, 1).plan, two = plan_of(open_lag(), means, 0, 2).plan;
  ASSERT_EQ(one.experiments.size(), two.experiments.size());
  for (std::size_t k = 0; k < one.experiments.size(); ++k) {
    EXPECT_EQ(one.experiments[k].experiment.runs, two.experiments[k].experiment.runs);
    EXPECT_EQ(one.experiments[k].probability, two.experiments[k].probability);
  }
}

TEST(Plan, NothingIsSettledWhereAnEffectIsFoundAlone) {
  const Planned planned = plan_of(open_record("frictional-lag", 3, 6, 4000, 0.002), {});
  ASSERT_EQ(planned.diagnosed.diagnosis.ladder.size(), 2U);
  ASSERT_TRUE(planned.diagnosed.diagnosis.ladder.back().equivalent.empty());
  EXPECT_EQ(planned.plan.kind, QuestionKind::nothing);
  EXPECT_TRUE(planned.plan.answered());
  EXPECT_TRUE(planned.plan.experiments.empty());
}

TEST(Plan, SaysWhyNothingCanBePlanned) {
  DiagnosedTraces none;
  EXPECT_FALSE(plan_runs(none).reason.empty());
}

}  // namespace
}  // namespace tribofit
