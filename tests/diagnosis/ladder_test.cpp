/// The search for law and effects, on small records and on made-up results, whose truth is known in both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "../fit/synthetic.hpp"
#include "diagnosis/findings.hpp"
#include "diagnosis/nearby_models.hpp"
#include "diagnosis/stepwise.hpp"

namespace {

using namespace tribofit;
using namespace tribofit::diagnosis;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

constexpr double kNoise = 0.003;

Candidate candidate(const std::string& name) {
  return {make_effect(name), describe(make_effect(name)), {}, {}};
}

std::vector<Candidate> candidates_of(const std::vector<std::string>& names) {
  std::vector<Candidate> out;
  for (const std::string& name : names) out.push_back(candidate(name));
  return out;
}

/// A record of known truth and what its diagnosis shares.
struct Made {
  synthetic::Record made;
  Record record;
  Observations fine, coarse;
  DiagnosisContext context;

  explicit Made(const std::vector<Effect>& truth = {}, const std::vector<double>& values = {})
      : made(make(truth, values)),
        record{&made.motion, &made.segmentation},
        fine(observe(made.motion, made.segmentation, channels(), 100)),
        coarse(observe(made.motion, made.segmentation, channels(), 40)),
        context(std::span(&record, 1), fine, coarse, kNoise, 0.002) {}
  Made(const Made&) = delete;
  Made& operator=(const Made&) = delete;
  static Channels channels() {
    Channels needs;
    needs.acceleration = needs.distance = needs.stick_time = needs.lead = true;
    return needs;
  }
  static synthetic::Record make(const std::vector<Effect>& truth, const std::vector<double>& values) {
    synthetic::Options options;
    options.cycles = 30;
    options.rate = 5e3;
    options.noise = kNoise;
    options.scatter = 0.002;
    std::vector<double> p = synthetic::table4_15mm(ExponentialLaw{});
    p.insert(p.end(), values.begin(), values.end());
    return synthetic::make(FrictionModel(ExponentialLaw{}, truth), p, options);
  }

  /// Squares that one row of noise leaves.
  double unit() const { return kNoise * kNoise; }
  /// Differences in that unit that decide nothing, and that leave no doubt: chance makes them d^2 -+ 2 d, 4 is one
  /// standard deviation from none, 200 seven; of the squares of the noise a thousandth shows on no plot, a hundredth
  /// does.
  double within_chance() const { return std::min(4.0, 1e-3 * context.fine.samples); }
  double beyond_doubt() const { return std::max(200.0, 1e-2 * context.fine.samples); }
};

std::vector<std::string> keys_on(const Ladder& ladder, const std::vector<Candidate>& all) {
  std::vector<std::string> keys;
  for (const LadderStep& step : ladder.steps) {
    if (step.added) keys.push_back(all[*step.added].info.key);
  }
  return keys;
}

// ---------------------------------------------------------------------------------------------------------- choose

/// A candidate that passes and leaves so many units of noise.
CandidateResult passing(const Made& made, std::size_t candidate, double units, std::size_t parameters) {
  CandidateResult out;
  out.candidate = candidate;
  out.trial.p.assign(parameters, 0.0);
  out.trial.usable = out.passes = out.by_level = true;         // by level: there is no model to fit to more values
  out.trial.squares = made.context.fine.values * made.unit();  // the noise of a row is one unit
  out.trial.held_out_squares = units * made.unit();
  return out;
}

TEST(Choose, TheSimplestOfThoseThatDoAsWellLeadsAndTheOthersAreItsGroup) {
  const Made made;
  const std::vector<Candidate> all = candidates_of({"ringing", "viscous", "drift", "heating"});
  const double near = made.within_chance(), far = made.beyond_doubt();
  std::vector<CandidateResult> judged = {passing(made, 0, 9000, 7), passing(made, 1, 9000 + near, 4),
                                         passing(made, 2, 9000 + far, 4), passing(made, 3, 9000 - 2 * far, 5)};
  judged[3].passes = false;
  const Choice choice = choose(made.context, judged, all);
  ASSERT_TRUE(choice.leader);
  EXPECT_EQ(*choice.leader, 1u);
  EXPECT_THAT(choice.group, ElementsAre(0u)) << "drift is worse, heating did not pass";
}

TEST(Choose, NothingLeadsWhereNothingPasses) {
  const Made made;
  const std::vector<Candidate> all = candidates_of({"viscous"});
  std::vector<CandidateResult> judged = {passing(made, 0, 9000, 4)};
  judged[0].passes = false;
  EXPECT_FALSE(choose(made.context, judged, all).leader);
}

TEST(Choose, AFormOfAnEffectHasTheNameOnlyWhereTheDataDistinguishIt) {
  const Made made;
  const std::vector<Candidate> all = candidates_of({"rate-state:healing", "rate-state"});
  for (const bool is_clear : {false, true}) {
    const double lead = is_clear ? made.beyond_doubt() : made.within_chance();
    std::vector<CandidateResult> judged = {passing(made, 0, 9000 - lead, 5), passing(made, 1, 9000, 5)};
    const Choice choice = choose(made.context, judged, all);
    ASSERT_TRUE(choice.leader);
    EXPECT_EQ(*choice.leader, is_clear ? 0u : 1u);
    EXPECT_THAT(choice.group, IsEmpty()) << is_clear;
  }
}

TEST(Choose, WhatADeclaredInstrumentLeavesRoomForNeedsNoOtherName) {
  const Made made;
  std::vector<Candidate> all = candidates_of({"frictional-lag", "channel-delay"});
  all[1].allowed = AllowedRange{-1e-3, 1e-3, false};  // a bound is no reason for a name
  std::vector<CandidateResult> judged = {passing(made, 0, 9000, 4), passing(made, 1, 9000 + made.within_chance(), 4)};
  EXPECT_EQ(choose(made.context, judged, all).leader, 0u);
  all[1].allowed->is_uncertainty = true;
  Choice choice = choose(made.context, judged, all);
  EXPECT_EQ(choice.leader, 1u);
  EXPECT_THAT(choice.group, IsEmpty());
  judged[1] = passing(made, 1, 9000 + made.beyond_doubt(), 4);
  choice = choose(made.context, judged, all);
  EXPECT_EQ(choice.leader, 0u) << "it does not explain as much";
}

// ----------------------------------------------------------------------------------------------------------- climb

Ladder climbed(const Made& made, const std::vector<Law>& laws, const std::vector<Candidate>& all) {
  return climb(made.context, laws, {}, all, Limits(), {});
}

TEST(Climb, FindsWhatIsTrueAndNothingMore) {
  const std::vector<Candidate> all = candidates_of({"drift", "viscous"});
  const double sigma = 0.3, drift = 0.004;  // s/m, 1/s
  const Made only_viscous({Viscous()}, {sigma}), both({Viscous(), Drift()}, {sigma, drift});
  for (const Made* made : {&only_viscous, &both}) {
    const Ladder ladder = climbed(*made, {ExponentialLaw()}, all);
    std::vector<std::string> truth = {"viscous"};
    if (made == &both) truth.emplace_back("drift");
    EXPECT_THAT(keys_on(ladder, all), ::testing::UnorderedElementsAreArray(truth));
    const Trial& top = ladder.top();
    EXPECT_NEAR(top.p[top.model.offset_of("viscous")], sigma, 0.05 * sigma);
  }
}

TEST(Climb, DistinguishesALagFromADelayBesideADrift) {
  const std::vector<Candidate> all = candidates_of({"channel-delay", "frictional-lag", "drift"});
  const double tau = 3e-3, drift = 0.004;
  const Made made({FrictionalLag(), Drift()}, {tau, drift});
  const Ladder ladder = climbed(made, {ExponentialLaw()}, all);
  EXPECT_THAT(keys_on(ladder, all), UnorderedElementsAre("frictional-lag", "drift"));
  for (const LadderStep& step : ladder.steps) EXPECT_THAT(step.equivalent, IsEmpty()) << "the data distinguish them";
  const Trial& top = ladder.top();
  EXPECT_NEAR(top.p[top.model.offset_of("frictional-lag")], tau, 0.05 * tau);
}

/// With viscous friction of as much as the drop at the fastest slip another law is the nearest one as long as it stands
/// alone.
TEST(Climb, ChoosesTheLawAnewWithEveryEffect) {
  const double sigma = 2;  // s/m
  const std::vector<Candidate> all = candidates_of({"viscous", "stribeck-exponent", "frictional-lag"});
  const Made made({Viscous()}, {sigma});
  const Ladder ladder = climbed(made, competing_laws({ExponentialLaw(), FractionalLaw()}, {}), all);
  EXPECT_EQ(ladder.top().model.law(), Law(ExponentialLaw()));
  EXPECT_THAT(keys_on(ladder, all), ElementsAre("viscous"));
  EXPECT_THAT(ladder.rivals, IsEmpty());
}

/// Every cycle's friction is higher or lower as a whole, by 2 %, as that of real pads is.
TEST(Climb, ALevelThatScattersIsNoOtherLaw) {
  Made made;
  std::mt19937 random(5);
  std::normal_distribution<double> scatter(0, 0.02);
  for (Cycle& cycle : made.made.segmentation.cycles) {
    const double level = 1 + scatter(random);
    cycle.break_away_friction *= level;
    for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) made.made.motion.friction[i] *= level;
  }
  made.fine = observe(made.made.motion, made.made.segmentation, Made::channels(), 100);
  made.coarse = observe(made.made.motion, made.made.segmentation, Made::channels(), 40);
  const std::vector<Candidate> all = candidates_of({"viscous", "stribeck-exponent", "frictional-lag", "drift"});
  const Ladder ladder = climbed(made, competing_laws({ExponentialLaw(), FractionalLaw()}, {}), all);
  EXPECT_EQ(ladder.top().model.law(), Law(ExponentialLaw()));
  EXPECT_THAT(keys_on(ladder, all), IsEmpty());
  EXPECT_NEAR(ladder.top().p[1], synthetic::table4_15mm(ExponentialLaw{})[1], 0.01);
}

// --------------------------------------------------------------------------------------------------------- findings

/// A result of one effect alone beside the base, at the starts of its parameters.
CandidateResult result(const std::vector<Candidate>& all, std::size_t k, double p_value, bool passes) {
  CandidateResult out;
  out.candidate = k;
  out.trial.model = FrictionModel(ExponentialLaw{}, {all[k].effect});
  for (const auto& slot : out.trial.model.parameters()) {
    out.trial.p.push_back(slot.parameter.start * slot.parameter.si);
    out.trial.at_bound.push_back(false);
  }
  out.trial.usable = true;
  out.fall = 1;
  out.size = 0.01;
  out.p_value = p_value;
  out.passes = passes;
  return out;
}

Fit fit_with(const std::vector<Effect>& effects, double held_out) {
  Fit fit;
  fit.model = FrictionModel(ExponentialLaw{}, effects);
  fit.error.held_out_rmse = held_out;
  for (const auto& slot : fit.model.parameters()) {
    FitParameter parameter;
    parameter.parameter = slot.parameter;
    parameter.effect = slot.effect;
    parameter.value = 42;
    fit.parameters.push_back(parameter);
  }
  return fit;
}

const EffectFinding& finding_of(const std::vector<EffectFinding>& findings, const std::string& key) {
  for (const EffectFinding& finding : findings) {
    if (finding.key == key) return finding;
  }
  throw std::out_of_range(key);
}

TEST(Findings, SayWhatBecameOfEveryCandidate) {
  const Made made;
  std::vector<Candidate> all =
      candidates_of({"frictional-lag", "channel-delay", "viscous", "drift", "runout", "run-in", "heating"});
  all[4].untestable = "the disc angle is not known";
  Ladder ladder;
  ladder.steps.resize(2);
  ladder.steps[1].added = 0;
  ladder.steps[1].equivalent = {1};
  ladder.steps[1].judged = {result(all, 0, 1e-9, true), result(all, 1, 1e-9, true), result(all, 2, 1e-9, false),
                            result(all, 3, 0.3, false), result(all, 6, 1e-9, true)};
  ladder.steps[1].judged[2].plausible = false;
  ladder.last = {result(all, 2, 1e-9, false), result(all, 3, 0.4, false), result(all, 6, 0.8, false)};
  ladder.last[0].plausible = false;
  ladder.withdrawn = {5};
  const std::vector<Fit> fits = {fit_with({}, 0.010), fit_with({all[0].effect}, 0.005)};
  const std::vector<EffectFinding> found = findings_of(made.context, ladder, all, fits, 0.003);
  ASSERT_EQ(found.size(), all.size());

  const EffectFinding& lag = finding_of(found, "frictional-lag");
  EXPECT_EQ(lag.status, EffectStatus::found);
  EXPECT_DOUBLE_EQ(lag.held_out_rmse, 0.005);
  EXPECT_NEAR(lag.error_reduction, (0.010 * 0.010 - 0.005 * 0.005) / (0.010 * 0.010 - 0.003 * 0.003), 1e-12);
  ASSERT_EQ(lag.parameters.size(), 1u);
  EXPECT_EQ(lag.parameters[0].value, 42) << "of the final fit, not of the trial";

  EXPECT_EQ(finding_of(found, "channel-delay").status, EffectStatus::equivalent);
  EXPECT_THAT(finding_of(found, "channel-delay").reason, HasSubstr("frictional-lag"));
  EXPECT_EQ(finding_of(found, "viscous").status, EffectStatus::not_supported);
  EXPECT_THAT(finding_of(found, "viscous").reason, HasSubstr("plausible"));
  EXPECT_EQ(finding_of(found, "drift").status, EffectStatus::not_supported);
  EXPECT_THAT(finding_of(found, "drift").reason, HasSubstr("0.4"));
  EXPECT_EQ(finding_of(found, "runout").status, EffectStatus::untestable);
  EXPECT_EQ(finding_of(found, "runout").reason, all[4].untestable);
  EXPECT_EQ(finding_of(found, "heating").status, EffectStatus::superseded) << "it passed beside the base law only";
}

TEST(Findings, AWithdrawnEffectIsNotFound) {
  const Made made;
  const std::vector<Candidate> all = candidates_of({"run-in", "drift"});
  Ladder ladder;
  ladder.steps.resize(1);
  ladder.last = {result(all, 0, 1e-9, true), result(all, 1, 0.5, false)};
  ladder.withdrawn = {0};
  const std::vector<EffectFinding> found = findings_of(made.context, ladder, all, {fit_with({}, 0.010)}, 0.003);
  EXPECT_EQ(finding_of(found, "run-in").status, EffectStatus::not_supported);
  EXPECT_THAT(finding_of(found, "run-in").reason, HasSubstr("left is larger than what it explains"));
}

/// Beside a base law that leaves twice the squares of the noise.
TEST(Findings, WhatMayExplainMuchAndIsNotProvenIsPossible) {
  const Made made;
  const std::vector<Candidate> all = candidates_of({"viscous", "drift", "run-in", "heating", "asymmetry"});
  const double noise = made.context.noise_squares();
  Ladder ladder;
  ladder.steps.resize(1);
  ladder.steps[0].trial.held_out_squares = 2 * noise;
  ladder.last = {result(all, 0, 0.02, false), result(all, 1, 0.02, false), result(all, 2, 0.2, false),
                 result(all, 3, 0.02, false), result(all, 4, 1e-6, false)};
  for (CandidateResult& judged : ladder.last) {
    judged.fall = 0.5 * noise;
    judged.size = 0.5;
  }
  ladder.last[1].fall = 0.1 * noise;  // little of what is above the noise
  ladder.last[3].plausible = ladder.last[4].plausible = false;
  ladder.last[4].trial.at_bound.assign(ladder.last[4].trial.model.parameters().size(), true);
  const std::vector<EffectFinding> found = findings_of(made.context, ladder, all, {fit_with({}, 0.010)}, 0.003);
  EXPECT_EQ(finding_of(found, "viscous").status, EffectStatus::possible);
  EXPECT_THAT(finding_of(found, "viscous").reason, HasSubstr(all[0].info.experiment)) << "what would prove it";
  EXPECT_EQ(finding_of(found, "drift").status, EffectStatus::not_supported);
  EXPECT_EQ(finding_of(found, "run-in").status, EffectStatus::not_supported) << "what it explains may well be chance";
  EXPECT_EQ(finding_of(found, "heating").status, EffectStatus::not_supported);
  EXPECT_EQ(finding_of(found, "asymmetry").status, EffectStatus::possible) << "its bounds alone are against it";
}

TEST(Findings, TheFormOnTheLadderStandsForItsEffect) {
  const Made made;
  const std::vector<Candidate> all = candidates_of({"rate-state:healing", "rate-state"});
  Ladder ladder;
  ladder.steps.resize(2);
  ladder.steps[1].added = 0;
  ladder.steps[1].judged = {result(all, 0, 1e-9, true), result(all, 1, 1e-9, false)};
  const std::vector<Fit> fits = {fit_with({}, 0.010), fit_with({all[0].effect}, 0.004)};
  const std::vector<EffectFinding> found = findings_of(made.context, ladder, all, fits, 0.003);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].key, "rate-state");
  EXPECT_EQ(found[0].status, EffectStatus::found);
}

}  // namespace
