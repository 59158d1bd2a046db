/// A finding on a run that was held back, and on two runs together.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "../fit/synthetic.hpp"
#include "diagnosis/diagnose_traces.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace {

using namespace tribofit;

constexpr double kTurnRate = 4;  // [rad/s]

/// A run on a disc whose runout begins at an angle of its own; amplitude: of friction, over friction.
Identification run(double amplitude, double phase, std::uint64_t seed) {
  synthetic::Options options;
  options.noise = 0.003;
  options.seed = seed;
  synthetic::Record made =
      synthetic::make(FrictionModel(ExponentialLaw{}), synthetic::table4_15mm(ExponentialLaw{}), options);
  made.motion.conditions.speed = {kTurnRate, "command line"};
  made.motion.constant_disc_velocity = kTurnRate * made.motion.conditions.radius.value;
  made.motion.disc_angle.clear();
  for (const double time : made.motion.time) made.motion.disc_angle.push_back(kTurnRate * time);
  const auto factor = [&](double time) { return 1 + amplitude * std::cos(kTurnRate * time + phase); };
  for (std::size_t i = 0; i < made.motion.size(); ++i) made.motion.friction[i] *= factor(made.motion.time[i]);
  for (Cycle& cycle : made.segmentation.cycles) cycle.break_away_friction *= factor(cycle.break_away_time);
  Identification out;
  out.path = "run";
  out.motion = made.motion;
  out.segmentation = made.segmentation;
  out.analysed = true;
  return out;
}

Diagnosed diagnosed(const Identification& trace) {
  const Record record = {&trace.motion, &trace.segmentation};
  return diagnose({&record, 1}, {ExponentialLaw{}});
}

TEST(Confirm, TheSameRunoutFromAnotherStartingAngleBearsItOut) {
  const Diagnosed found = diagnosed(run(0.05, 0.4, 1));
  ASSERT_EQ(found.diagnosis.ladder.back().added, "runout");
  ASSERT_EQ(found.diagnosis.verdict, Verdict::effect_found) << found.diagnosis.messages.back();
  Diagnosis diagnosis = found.diagnosis;
  const Confirmation same = diagnosis::confirm(run(0.05, 2.6, 2), found.fits);
  EXPECT_LT(same.final_rmse, 0.6 * same.base_rmse);
  diagnosis::veto({same}, diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::effect_found);
}

TEST(Confirm, ARunWithoutTheEffectVetoes) {
  const Diagnosed found = diagnosed(run(0.05, 0.4, 1));
  Diagnosis diagnosis = found.diagnosis;
  const Confirmation none = diagnosis::confirm(run(0, 0, 3), found.fits);
  EXPECT_GT(none.final_rmse, none.base_rmse);
  diagnosis::veto({none}, diagnosis);
  EXPECT_EQ(diagnosis.verdict, Verdict::unconfirmed);
  ASSERT_FALSE(diagnosis.messages.empty());
  EXPECT_NE(diagnosis.messages.back().find("does not bear out"), std::string::npos);
}

/// A run without the effect whose friction is another by a factor.
Identification run_of_level(double factor, std::uint64_t seed) {
  Identification out = run(0, 0, seed);
  for (double& friction : out.motion.friction) friction *= factor;
  for (Cycle& cycle : out.segmentation.cycles) cycle.break_away_friction *= factor;
  return out;
}

TEST(Confirm, ARunThatTheLawDoesNotPredictVetoesWhereNoEffectWasFound) {
  const Diagnosed found = diagnosed(run(0, 0, 1));
  ASSERT_EQ(found.diagnosis.verdict, Verdict::sufficient);
  for (const double factor : {1.0, 1.1}) {
    Diagnosis diagnosis = found.diagnosis;
    const Confirmation other = diagnosis::confirm(run_of_level(factor, 2), found.fits);
    EXPECT_NEAR(other.floor_rmse, 0.003 * factor, 0.0005);
    diagnosis::veto({other}, diagnosis);
    EXPECT_EQ(diagnosis.verdict, factor == 1 ? Verdict::sufficient : Verdict::unconfirmed) << other.final_rmse;
    if (factor == 1) continue;
    ASSERT_FALSE(diagnosis.messages.empty());
    EXPECT_NE(diagnosis.messages.back().find("run contradicts the law"), std::string::npos);
    EXPECT_NE(diagnosis.messages.back().find("times the noise floor"), std::string::npos);
  }
}

/// The value of a parameter of a fit within four standard errors of the truth.
void expect_parameter(const Fit& fit, const std::string& name, double truth) {
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    if (fit.model.parameters()[k].full_name() != name) continue;
    const FitParameter& p = fit.parameters[k];
    EXPECT_GT(p.std_error, 0) << name;
    EXPECT_LT(p.std_error, 0.05) << name;
    EXPECT_NEAR(p.value, truth, 4 * p.std_error) << name;
    return;
  }
  ADD_FAILURE() << name << " is no parameter of " << fit.model.name();
}

TEST(Together, RunsShareARunoutButNotItsStartingAngle) {
  const Identification first = run(0.05, 0.4, 1), second = run(0.05, 2.6, 2);
  const Record both[] = {{&first.motion, &first.segmentation}, {&second.motion, &second.segmentation}};
  const Diagnosed found = diagnose(both, {ExponentialLaw{}});
  ASSERT_EQ(found.diagnosis.ladder.size(), 2u);
  EXPECT_EQ(found.diagnosis.ladder.back().added, "runout");
  EXPECT_EQ(found.diagnosis.verdict, Verdict::effect_found);
  ASSERT_FALSE(found.diagnosis.where.empty());
  EXPECT_EQ(found.diagnosis.where[0].variable, ResidualVariable::angle);
  const Fit& fit = found.fits.back();
  expect_parameter(fit, "runout.A", 0.05);
  expect_parameter(fit, "runout.phase", 0.4);
  expect_parameter(fit, "runout.phase[2]", 2.6);
  // Each record is predicted with the phase that it has.
  for (std::size_t r = 0; r < 2; ++r) {
    const std::vector<double> model = predict(fit, *both[r].motion, *both[r].segmentation, r);
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < model.size(); ++i) {
      if (!std::isfinite(model[i])) continue;
      squares += (model[i] - both[r].motion->friction[i]) * (model[i] - both[r].motion->friction[i]);
      count += 1;
    }
    EXPECT_LT(std::sqrt(squares / count), 1.1 * 0.003) << "record " << r;
  }
  // A third run is tried with a phase of its own.
  const Confirmation third = diagnosis::confirm(run(0.05, -1.5, 4), found.fits);
  EXPECT_LT(third.final_rmse, 0.6 * third.base_rmse);
}

/// Runs whose law differs by factors of mu_k and 1/alpha, as those of the published disc did at its radii.
std::vector<diagnosis::PreparedTrace> runs_of(const std::vector<double>& factors, std::vector<Effect> effects,
                                              const std::vector<double>& values) {
  std::vector<diagnosis::PreparedTrace> traces;
  std::uint64_t seed = 20;
  for (const double factor : factors) {
    synthetic::Options options;
    options.noise = 0.003;
    options.seed = ++seed;
    std::vector<double> p = synthetic::table4_15mm(ExponentialLaw{});
    p[1] *= factor;
    p[2] /= factor;
    p.insert(p.end(), values.begin(), values.end());
    const synthetic::Record made = synthetic::make(FrictionModel(ExponentialLaw{}, effects), p, options);
    Identification trace;
    trace.path = "run";
    trace.motion = made.motion;
    trace.segmentation = made.segmentation;
    trace.analysed = true;
    traces.push_back({trace, {}, [trace](const MotionOptions&) { return trace; }});
  }
  return traces;
}

Diagnosis diagnosis_of(std::vector<diagnosis::PreparedTrace> traces) {
  IdentifyOptions options;
  options.laws = {ExponentialLaw{}};
  return diagnosis::diagnose_traces(std::move(traces), options, {}).diagnosis;
}

TEST(DifferingRuns, NoEffectIsNamedFromLawsThatDifferFromRunToRun) {
  const Diagnosis differ = diagnosis_of(runs_of({0.9, 1, 1.2}, {}, {}));
  EXPECT_EQ(differ.verdict, Verdict::unexplained);
  EXPECT_TRUE(differ.runs_differ);
  EXPECT_EQ(differ.ladder.size(), 1U);
  for (const EffectFinding& effect : differ.effects) EXPECT_NE(effect.status, EffectStatus::found) << effect.key;
  ASSERT_FALSE(differ.messages.empty());
  EXPECT_NE(differ.messages.front().find("differs from run to run"), std::string::npos) << differ.messages.front();
  EXPECT_EQ(diagnosis_of(runs_of({1, 1, 1}, {}, {})).verdict, Verdict::sufficient);
}

TEST(DifferingRuns, AnEffectOfEveryRunIsSaid) {
  const Diagnosis differ = diagnosis_of(runs_of({0.9, 1, 1.2}, {make_effect("frictional-lag")}, {2e-3}));
  ASSERT_FALSE(differ.messages.empty());
  EXPECT_NE(differ.messages.front().find("with frictional-lag in every one"), std::string::npos)
      << differ.messages.front();
  const Diagnosis same = diagnosis_of(runs_of({1, 1, 1}, {make_effect("frictional-lag")}, {2e-3}));
  EXPECT_EQ(same.verdict, Verdict::effect_found);
  EXPECT_EQ(same.ladder.back().added, "frictional-lag");
}

}  // namespace
