/// What the diagnosis looks for and where, on records made with a known truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "../fit/synthetic.hpp"
#include "diagnosis/candidates.hpp"
#include "diagnosis/nearby_models.hpp"
#include "diagnosis/probes.hpp"
#include "diagnosis/trial.hpp"
#include "fit/spectral_lines.hpp"

namespace {

using namespace tribofit;
using namespace tribofit::diagnosis;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double kSearchNoise = 0.003;
constexpr double kTurn = 2 * std::numbers::pi;

Channels channels() {
  Channels needs;
  needs.acceleration = needs.angle = needs.distance = needs.stick_time = needs.lead = true;
  return needs;
}

synthetic::Record plain(std::uint64_t seed = 1) {
  synthetic::Options options;
  options.noise = kSearchNoise;
  options.seed = seed;
  return synthetic::make(FrictionModel(ExponentialLaw{}), synthetic::table4_15mm(ExponentialLaw{}), options);
}

/// Adds `more(time, velocity)` to friction wherever the block slips.
template <class F>
void add_in_slip(synthetic::Record& record, F more) {
  for (const Cycle& cycle : record.segmentation.cycles) {
    for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
      record.motion.friction[i] += more(record.motion.time[i], record.motion.relative_velocity[i]);
    }
  }
}

std::string reason(const std::vector<Candidate>& all, const std::string& key) {
  for (const Candidate& candidate : all) {
    if (candidate.info.key == key) return candidate.untestable;
  }
  return "not a candidate";
}

TEST(Candidates, SayWhyTheDataCannotShowThem) {
  const synthetic::Record made = plain();
  const Record record = {&made.motion, &made.segmentation};
  const Observations observations = observe(made.motion, made.segmentation, channels());
  const auto all = candidates(std::span(&record, 1), observations, {});
  EXPECT_THAT(reason(all, "temperature-dependence"), HasSubstr("temperature channel"));
  EXPECT_THAT(reason(all, "load-dependence"), HasSubstr("load channel"));
  EXPECT_THAT(reason(all, "asymmetry"), HasSubstr("one direction"));
  EXPECT_THAT(reason(all, "sensor-offset"), HasSubstr("one direction"));
  EXPECT_THAT(reason(all, "runout"), HasSubstr("revolutions"));  // 8 s at 4 rpm
  EXPECT_THAT(reason(all, "ageing"), HasSubstr("stick times"));
  for (const char* key : {"viscous", "stribeck-exponent", "frictional-lag", "rate-state", "drift", "ringing"}) {
    EXPECT_THAT(reason(all, key), IsEmpty()) << key;
  }
  EXPECT_EQ(reason(all, "radius-offset"), "not a candidate");  // kinematics answers for it
}

TEST(Candidates, ARecordThatNeverSticksHasNoBreakAway) {
  synthetic::Record made = plain();
  made.segmentation.kind = MotionKind::always_slipping;
  for (Cycle& cycle : made.segmentation.cycles) cycle.stick = {};
  const Record record = {&made.motion, &made.segmentation};
  const Observations observations = observe(made.motion, made.segmentation, channels());
  const auto all = candidates(std::span(&record, 1), observations, {});
  for (const char* key : {"ringing", "contact-spin"}) EXPECT_THAT(reason(all, key), HasSubstr("break-away")) << key;
}

TEST(CompetingLaws, AreAllOfTheListUnlessTheUserHasChosenOne) {
  const std::vector<Law> all = competing_laws({Law(ExponentialLaw{}), Law(FractionalLaw{})}, {});
  EXPECT_EQ(all.size(), law_catalogue().size());
  EXPECT_EQ(competing_laws({Law(GaussianLaw{})}, {}), std::vector<Law>{Law(GaussianLaw{})});
}

TEST(CompetingLaws, AreThoseOnWhichTheEffectsOfTheUserCanAct) {
  const std::vector<Effect> shape = {make_effect("stribeck-exponent")};
  const std::vector<Law> laws = competing_laws({Law(ExponentialLaw{}), Law(FractionalLaw{})}, shape);
  EXPECT_EQ(std::count(laws.begin(), laws.end(), Law(CoulombLaw{})), 0);
  EXPECT_EQ(std::count(laws.begin(), laws.end(), Law(ExponentialLaw{})), 1);
}

/// What is left of the friction of a record when the true law is taken away.
std::vector<double> residual_of_truth(const Observations& observations) {
  const std::vector<double> p = synthetic::table4_15mm(ExponentialLaw{});
  std::vector<double> residual;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const double mu = p[1] + (p[0] - p[1]) * std::exp(-p[2] * std::abs(observations.velocity[i]));
    residual.push_back(observations.friction[i] - mu);
  }
  return residual;
}

TEST(Lines, ALineOfFixedFrequencyIsFoundMoreFinelyThanTheRecordResolves) {
  constexpr double kFrequency = 97.31;
  synthetic::Record made = plain();
  for (std::size_t i = 0; i < made.motion.size(); ++i) {
    made.motion.friction[i] += 0.003 * std::cos(kTurn * kFrequency * made.motion.time[i] + 0.4);
  }
  const Record record = {&made.motion, &made.segmentation};
  const Observations observations = observe(made.motion, made.segmentation, {}, 400);
  const SpectralLines lines = strongest_lines(record, observations, residual_of_truth(observations), 5, 2000);
  EXPECT_NEAR(lines.frequencies.at(0), kFrequency, 0.3 / made.motion.duration());
  EXPECT_GT(lines.places, 100);
}

TEST(Lines, RingingIsFoundByItsPhaseAtBreakAway) {
  constexpr double kFrequency = 412;
  synthetic::Record made = plain();
  for (const Cycle& cycle : made.segmentation.cycles) {
    for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
      const double t = made.motion.time[i] - cycle.break_away_time;
      made.motion.friction[i] += 0.01 * std::exp(-0.02 * kTurn * kFrequency * t) * std::cos(kTurn * kFrequency * t);
    }
  }
  const Observations observations = observe(made.motion, made.segmentation, {}, 1000);
  const SpectralLines lines =
      strongest_ringing(observations, residual_of_truth(observations), lowest_ringing(observations));
  EXPECT_NEAR(lines.frequencies.at(0), kFrequency, 0.03 * kFrequency);
}

/// Probes of a record beside the exponential law fitted to it.
std::vector<Probe> probes_of(const synthetic::Record& made) {
  const Record record = {&made.motion, &made.segmentation};
  const Observations fine = observe(made.motion, made.segmentation, channels(), 200);
  const Observations coarse = observe(made.motion, made.segmentation, channels(), 40);
  const DiagnosisContext context(std::span(&record, 1), fine, coarse, kSearchNoise, 0.004);
  const FrictionModel model(ExponentialLaw{});
  const Trial trial = try_base(context, context.fine, model);
  return probe_all(context, try_model(context, context.coarse, model, trial.p), trial, residual_of(context, trial));
}

const Probe& largest(const std::vector<Probe>& probes) {
  return *std::max_element(probes.begin(), probes.end(),
                           [](const Probe& a, const Probe& b) { return a.fall < b.fall; });
}

TEST(Probes, AHumpGoesWithTheVelocity) {
  synthetic::Record made = plain();
  add_in_slip(made, [](double, double v) { return 0.02 * std::exp(-std::pow((v - 0.04) / 0.008, 2)); });
  const std::vector<Probe> probes = probes_of(made);
  const Probe& found = largest(probes);
  EXPECT_EQ(found.variable, ResidualVariable::velocity);
  EXPECT_LT(found.p_value, 1e-3);
}

TEST(Probes, ASwingGoesWithTimeAndItsPeriodIsFound) {
  constexpr double kPeriod = 1.7;
  synthetic::Record made = plain();
  add_in_slip(made, [](double t, double) { return 0.015 * std::cos(kTurn * t / kPeriod); });
  const std::vector<Probe> probes = probes_of(made);
  const Probe& found = largest(probes);
  EXPECT_EQ(found.variable, ResidualVariable::time);
  EXPECT_LT(found.p_value, 1e-3);
  EXPECT_NEAR(found.period, kPeriod, 0.1);
}

TEST(Probes, NothingStandsOutWhereNothingIsHidden) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Probe> probes = probes_of(plain(seed));
    for (const Probe& probe : probes) {
      const bool stands_out = probe.p_value * static_cast<double>(probes.size()) < 0.01 && probe.size > 0.05;
      EXPECT_FALSE(stands_out) << to_string(probe.variable) << ' ' << seed;
    }
  }
}

}  // namespace
