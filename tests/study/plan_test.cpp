#include "tribofit/study/plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "diagnosis/ruling.hpp"
#include "fit/fit_laws.hpp"
#include "fit/model_residuals.hpp"
#include "study/limits.hpp"
#include "study/open_question.hpp"
#include "study/simulated_run.hpp"
#include "tribofit/friction/effects/all.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/study/identified.hpp"

namespace tribofit {
namespace {

/// A record of the 15 mm test of [D] with an effect hidden in it, as short and noisy as it takes to leave it open.
/// turns: the disc turns back after half of it.
TraceInput open_record(const std::string& effect, double value, double duration, double rate, double noise,
                       bool turns = false) {
  const PublishedTest test = published_test(0.015, ExponentialLaw{});
  const FrictionModel model(ExponentialLaw{}, {make_effect(effect)});
  std::vector<double> p = test.friction;
  for (std::size_t k = p.size(); k < model.parameters().size(); ++k) {
    const Parameter& q = model.parameters()[k].parameter;
    p.push_back((k == test.friction.size() ? value : q.start) * q.si);
  }
  const SpeedProfile speed =
      turns ? stepped_speed({0, 0.5 * duration}, {test.speed, -test.speed}) : constant_speed(test.speed);
  Drive drive{.speed = speed, .radius = test.radius, .mean_load = test.load};
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

RunPlan plan_of(const DiagnosedTraces& diagnosed, const Means& means, double effort = 0, int threads = 0) {
  PlanOptions options;
  options.means = means;
  options.effort = effort;
  options.threads = threads;
  return plan_runs(diagnosed, options);
}

std::vector<std::string> names_of(const RunPlan& plan) {
  std::vector<std::string> names;
  for (const ModelInQuestion& model : plan.models) names.push_back(model.name);
  return names;
}

/// Friction at break-away.
double break_away_of(const Segmentation& segmentation) {
  std::vector<double> levels;
  for (const Cycle& cycle : segmentation.cycles) levels.push_back(cycle.break_away_friction);
  return median(levels);
}

/// A lag that these few cycles do not distinguish from a delay or a filter of the reading.
const DiagnosedTraces& open_lag() {
  static const DiagnosedTraces diagnosed = diagnose({open_record("frictional-lag", 0.5, 6, 4000, 0.006)});
  return diagnosed;
}

TEST(Plan, ATapSettlesALagOrADelayThatNoSpeedDoes) {
  const Means means{.rates = {50000}, .longest = 5, .tap = true};
  const RunPlan plan = plan_of(open_lag(), means);
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

TEST(Plan, LiftingTheBlockShowsTheZeroOfTheForceSensor) {
  const Means means{.longest = 6, .lift = true};
  const RunPlan plan = plan_of(diagnose({open_record("sensor-offset", 0.02, 12, 4000, 0.006, true)}), means);
  ASSERT_TRUE(plan.answered()) << plan.reason;
  ASSERT_THAT(names_of(plan), testing::Contains("sensor-offset"));
  const PlannedExperiment& best = plan.experiments.front();
  EXPECT_TRUE(best.experiment.lift);
  EXPECT_GT(best.probability, 0.9);
  ASSERT_FALSE(best.predictions.empty());
  for (std::size_t m = 0; m < plan.models.size(); ++m) {  // a zero shows whatever else is in question
    const double zero = plan.models[m].name == "sensor-offset" ? 0.02 : 0;
    EXPECT_LE(best.predictions[0].models[m].lower95, zero);
    EXPECT_GE(best.predictions[0].models[m].upper95, zero);
  }
  const RunPlan lag = plan_of(open_lag(), means);  // neither has a zero
  for (const PlannedExperiment& one : lag.experiments) {
    EXPECT_TRUE(!one.experiment.lift || one.probability == 0);
  }
}

TEST(Plan, SpeedsAloneAreHopelessForALagOrADelay) {
  const RunPlan plan = plan_of(open_lag(), {.speeds = {2 * kRpm}, .longest = 20});
  ASSERT_TRUE(plan.answered()) << plan.reason;
  EXPECT_TRUE(plan.hopeless);
  for (const PlannedExperiment& one : plan.experiments) EXPECT_LT(one.probability, kHopeless);
}

TEST(Plan, DoesNotDependOnThreads) {
  const Means means{.speeds = {8 * kRpm}, .longest = 5};
  const RunPlan one = plan_of(open_lag(), means, 0, 1), two = plan_of(open_lag(), means, 0, 2);
  ASSERT_EQ(one.experiments.size(), two.experiments.size());
  for (std::size_t k = 0; k < one.experiments.size(); ++k) {
    EXPECT_EQ(one.experiments[k].experiment.runs, two.experiments[k].experiment.runs);
    EXPECT_EQ(one.experiments[k].probability, two.experiments[k].probability);
  }
}

TEST(Plan, UsualSpeedsAreThoseAMachineIsSetTo) {
  const RunPlan plan = plan_of(open_lag(), {.longest = 5});
  ASSERT_TRUE(plan.usual_means);
  ASSERT_FALSE(plan.experiments.empty());
  for (const PlannedExperiment& one : plan.experiments) {
    for (const RunConditions& run : one.experiment.runs) {
      if (run.speed == plan.own.speed) continue;
      const double tenths = 10 * run.speed / kRpm;  // of 1, 2, 8 or 16 rpm
      EXPECT_NEAR(tenths, std::round(tenths), 1e-9);
    }
  }
}

TEST(Ruling, AFilterIsNotPreferredToAShortLagInALongRecord) {
  // So many slips are judged by means over 0.4 ms, and over such means a filter does better than the lag that is there.
  const Identification trace = prepare_trace(open_record("frictional-lag", 0.15, 40, 20000, 0.003));
  std::vector<Record> records(3, {&trace.motion, &trace.segmentation});
  const diagnosis::Ruling ruling = diagnosis::rule_between(
      records, ExponentialLaw{}, {}, {make_effect("frictional-lag"), make_effect("force-bandwidth")});
  EXPECT_EQ(ruling.leader, 0U);
  EXPECT_EQ(ruling.effects[0].behind, 0);
}

TEST(Plan, NothingIsSettledWhereAnEffectIsFoundAlone) {
  const DiagnosedTraces diagnosed = diagnose({open_record("frictional-lag", 3, 6, 4000, 0.002)});
  ASSERT_EQ(diagnosed.diagnosis.ladder.size(), 2U);
  ASSERT_TRUE(diagnosed.diagnosis.ladder.back().equivalent.empty());
  const RunPlan plan = plan_of(diagnosed, {});
  EXPECT_EQ(plan.kind, QuestionKind::nothing);
  EXPECT_TRUE(plan.answered());
  EXPECT_TRUE(plan.experiments.empty());
}

TEST(Plan, SaysWhyNothingCanBePlanned) {
  DiagnosedTraces none;
  EXPECT_FALSE(plan_runs(none).reason.empty());
}

TEST(Plan, AnEffectThatIsPossibleIsAsLikelyAsItsPValueAllows) {
  DiagnosedTraces diagnosed = diagnose({open_record("frictional-lag", 0.01, 6, 4000, 0.002)}, IdentifyOptions());
  ASSERT_EQ(diagnosed.diagnosis.ladder.size(), 1U);
  const Identification& trace = diagnosed.traces.front();
  const Record record{&trace.motion, &trace.segmentation};
  const FrictionModel model(diagnosed.diagnosis.law, {make_effect("viscous")});
  const Fit fit = fit_model(model, {&record, 1}, observations_for(model, {&record, 1}), {}, {});
  for (EffectFinding& finding : diagnosed.diagnosis.effects) {
    if (finding.status == EffectStatus::possible) finding.status = EffectStatus::not_supported;
    if (finding.key != "viscous") continue;
    finding.status = EffectStatus::possible;
    finding.p_value = 0.02;
    finding.parameters.assign(fit.parameters.begin() + 3, fit.parameters.end());
  }
  const OpenQuestion question = open_question(diagnosed, {});
  ASSERT_EQ(question.kind, QuestionKind::possible);
  ASSERT_EQ(question.reason, "");
  // Table 1 of Sellke, Bayarri and Berger (2001): a Bayes factor of 0.213 at the least; odds of 4 before.
  EXPECT_NEAR(question.models[1].probability / question.models[0].probability, 0.213 / 4, 2e-4);
}

/// What the run would show must be told from what looks like it: a delay beside a lag, and not a viscous term.
TEST(Plan, WhatIsPossibleIsAskedAboutWithWhatLooksLikeIt) {
  DiagnosedTraces diagnosed = diagnose({open_record("frictional-lag", 0.01, 6, 4000, 0.002)}, IdentifyOptions());
  ASSERT_EQ(diagnosed.diagnosis.ladder.size(), 1U);
  const Identification& trace = diagnosed.traces.front();
  const Record record{&trace.motion, &trace.segmentation};
  const std::map<std::string, double> p_values = {{"viscous", 0.04}, {"channel-delay", 0.03}, {"frictional-lag", 0.02}};
  for (EffectFinding& finding : diagnosed.diagnosis.effects) {
    if (finding.status == EffectStatus::possible) finding.status = EffectStatus::not_supported;
    const auto p_value = p_values.find(finding.key);
    if (p_value == p_values.end()) continue;
    const FrictionModel model(diagnosed.diagnosis.law, {make_effect(finding.key)});
    const Fit fit = fit_model(model, {&record, 1}, observations_for(model, {&record, 1}), {}, {});
    finding.status = EffectStatus::possible;
    finding.p_value = p_value->second;
    finding.parameters.assign(fit.parameters.begin() + 3, fit.parameters.end());
  }
  const OpenQuestion question = open_question(diagnosed, {});
  ASSERT_EQ(question.kind, QuestionKind::possible);
  ASSERT_EQ(question.reason, "");
  ASSERT_EQ(question.models.size(), 3U);
  EXPECT_EQ(question.models[0].name, "frictional-lag");
  EXPECT_EQ(question.models[1].name, "channel-delay");
  EXPECT_TRUE(question.without(2));
  // Bayes factors of 0.213 and 0.286 at the least (Sellke, Bayarri and Berger 2001), and odds of 4 for any of the two.
  const double lag = question.models[0].probability, delay = question.models[1].probability;
  EXPECT_NEAR(delay / lag, 0.213 / 0.286, 2e-3);
  EXPECT_NEAR(question.models[2].probability / (lag + delay), 0.213 / 4, 2e-4);
}

TEST(Plan, NoRunIsSureToNameOrNotToName) {
  EXPECT_NEAR(calibrated_chance(0), kGuesses, 1e-12);
  EXPECT_NEAR(calibrated_chance(1), 1 - kLapses, 1e-12);
  EXPECT_NEAR(calibrated_chance(0.5), 0.5, 0.03);  // between them chances come true as they are expected
}

/// Normal variables that correlate by a half are all positive with a chance of 1 in one more than there are.
TEST(Plan, RivalsHaveInCommonWhatTheTrueModelLeaves) {
  EXPECT_NEAR(chance_of_all({0.5, 0.5}), 1.0 / 3, 1e-4);
  EXPECT_NEAR(chance_of_all({0.5, 0.5, 0.5}), 1.0 / 4, 1e-4);
  for (const double chance : {0.0, 0.1, 0.7, 1.0}) {
    EXPECT_NEAR(chance_of_all({chance}), chance, 1e-4);
    EXPECT_NEAR(chance_of_all({chance, 1}), chance, 1e-4);
  }
  EXPECT_EQ(chance_of_all({}), 1);
}

/// A run-in that this record hardly fixes: the covariance of its fit allows what the record does not.
TEST(Plan, MachinesAreDrawnThatDescribeTheRecord) {
  const DiagnosedTraces diagnosed = diagnose({open_record("run-in", -0.08, 10, 10e3, 0.006)}, IdentifyOptions());
  const Identification& trace = diagnosed.traces.front();
  const Record record{&trace.motion, &trace.segmentation};
  const FrictionModel model(ExponentialLaw{}, {make_effect("run-in")});
  const Fit fit = fit_model(model, {&record, 1}, observations_for(model, {&record, 1}), {}, {});
  const RigFit rig = rig_beside(fit, trace.motion, trace.segmentation, {});
  const IdentifiedMachine known = identified_machine(fit, rig, trace.motion, trace.segmentation);
  ASSERT_EQ(known.reason, "");
  EXPECT_LT(known.scatter.wander, 0.4);  // break-away scatters by itself: that all of it falls is run-in
  const PlausibleDraws draws(known, record, fit);
  const Observations observations = observe(trace.motion, trace.segmentation, model.needs(), 40);
  ModelResiduals residuals(model, observations, all_slips(observations));
  const ModelResiduals::Whitening whitening = residuals.whitening_at(known.machine.parameters.data());
  residuals.whiten(whitening);
  const double least = residuals.white_squares(known.machine.parameters.data());
  const double noise = least / static_cast<double>(observations.size());
  double mean = 0, by_covariance = 0;
  std::set<double> lengths;
  constexpr int kDraws = 200;
  for (std::uint64_t seed = 1; seed <= kDraws; ++seed) {
    const Machine drawn = draws_of(known.machine, known.covariance, 1, seed).front(), machine = draws.draw(seed);
    EXPECT_EQ(machine.parameters, draws.draw(seed).parameters);
    mean += (residuals.white_squares(machine.parameters.data()) - least) / noise / kDraws;
    by_covariance += (residuals.white_squares(drawn.parameters.data()) - least) / noise / kDraws;
    lengths.insert(machine.parameters[4]);
  }
  // Squares over the noise rise by the number of parameters, twice that where the evidence is weakened by 2.
  EXPECT_NEAR(mean, 2 * 5, 4);
  EXPECT_GT(by_covariance, 5 * mean);
  EXPECT_GT(lengths.size(), 50U);
  EXPECT_GT(*lengths.rbegin(), 1.5 * *lengths.begin());  // and they differ
}

/// A contact with one effect, and the record from which a run of it goes on.
struct Contact {
  Machine machine;
  RecordToContinue record;
};

Contact contact_with(const std::string& effect, double value) {
  const PublishedTest test = published_test(0.015, ExponentialLaw{});
  std::vector<double> p = test.friction;
  p.push_back(value);
  Contact out;
  out.machine = {test.rig,  FrictionModel(ExponentialLaw{}, {make_effect(effect)}), p, test.load, test.radius,
                 test.speed};
  out.record.motion = &open_lag().traces[0].motion;
  out.record.rate = out.record.simulated_rate = 4000;
  out.record.reference_load = test.load;
  return out;
}

/// Friction at break-away in a run of it.
double break_away_of(const Contact& contact, double load) {
  const Machine& machine = contact.machine;
  const SimulatedRun run = simulate_run(
      machine, {.radius = machine.radius, .speed = machine.speed, .load = load, .duration = 3, .rate = 4000},
      contact.record, 1);
  EXPECT_EQ(run.motion.conditions.load.value, load);
  EXPECT_EQ(run.motion.load.size(), contact.record.motion->load.size());
  return break_away_of(run.segmentation);
}

/// mu (N/N0)^-p of a run is of N0 of the record: at half the load all friction is 2^p times as much.
TEST(Plan, ARunAtAnotherLoadIsOfTheSameContact) {
  const Contact contact = contact_with("load-dependence", 0.2);
  const double load = contact.machine.load, mu_s = contact.machine.parameters[0];
  EXPECT_NEAR(break_away_of(contact, load), mu_s, 0.002 * mu_s);
  EXPECT_NEAR(break_away_of(contact, 0.5 * load), std::pow(2, 0.2) * mu_s, 0.002 * mu_s);
}

/// Parameters of several records refer to the mean of their temperatures, a run is as warm as its own record.
TEST(Plan, ARunIsAsWarmAsItsRecord) {
  Contact contact = contact_with("temperature-dependence", -0.005);
  Motion warm = *contact.record.motion;
  warm.temperature.assign(warm.size(), 60);
  contact.record.motion = &warm;
  contact.record.reference_temperature = 40;
  const double mu_s = contact.machine.parameters[0];
  EXPECT_NEAR(break_away_of(contact, contact.machine.load), (1 - 0.005 * 20) * mu_s, 0.002 * mu_s);
}

}  // namespace
}  // namespace tribofit
