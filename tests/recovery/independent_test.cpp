/// The diagnosis on records of a simulation that shares nothing with the library: see independent_rig.hpp.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "independent_rig.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"

namespace {

using namespace tribofit;
using independent::Rig;

DiagnosedTraces diagnosis_of(const Rig& rig) {
  const TraceInput input = {"independent", {}, std::make_shared<const Trace>(independent::Simulation(rig).run())};
  return diagnose(std::vector<TraceInput>{input}, IdentifyOptions{});
}

/// The truth within twice the 95 % interval, and the interval at most half as wide as the truth is large.
void expect_recovered(const FitParameter& p, double truth) {
  const double lower = p.lower95 - 0.5 * (p.upper95 - p.lower95), upper = p.upper95 + 0.5 * (p.upper95 - p.lower95);
  EXPECT_TRUE(lower <= truth && truth <= upper)
      << p.parameter.name << " = " << p.value << " (" << p.lower95 << " .. " << p.upper95 << "), truth " << truth;
  EXPECT_LT(p.upper95 - p.lower95, 0.5 * std::abs(truth)) << p.parameter.name;
}

void expect_law_recovered(const DiagnosedTraces& diagnosed, const Rig& rig) {
  EXPECT_EQ(diagnosed.diagnosis.law, rig.fractional ? Law(FractionalLaw{}) : Law(ExponentialLaw{}));
  ASSERT_FALSE(diagnosed.rungs.empty());
  const Fit& last = diagnosed.rungs.back();
  ASSERT_GE(last.parameters.size(), 3u);
  expect_recovered(last.parameters[0], rig.mu_s);
  expect_recovered(last.parameters[1], rig.mu_k);
  expect_recovered(last.parameters[2], rig.decay);
}

std::string ladder(const Diagnosis& diagnosis) {
  std::string text;
  for (const Rung& rung : diagnosis.ladder) {
    text += rung.added + " ";
    for (const std::string& other : rung.equivalent) text += "|" + other + " ";
  }
  return text;
}

struct Empty {
  const char* name;
  Rig rig;
};
void PrintTo(const Empty& empty, std::ostream* out) {
  *out << empty.name;
}

class EmptyRecord : public testing::TestWithParam<Empty> {};

TEST_P(EmptyRecord, IsSufficient) {
  const Rig& rig = GetParam().rig;
  const DiagnosedTraces diagnosed = diagnosis_of(rig);
  EXPECT_EQ(diagnosed.diagnosis.verdict, Verdict::sufficient) << ladder(diagnosed.diagnosis);
  EXPECT_EQ(diagnosed.diagnosis.ladder.size(), 1u) << ladder(diagnosed.diagnosis);
  expect_law_recovered(diagnosed, rig);
}

/// A pad on a stiff holder that is driven to and fro: it breaks away between two samples at each reversal.
Rig reciprocating(double amplitude, double frequency, std::uint64_t seed) {
  Rig rig = {.mass = 0.2, .stiffness = 2e6, .damping_ratio = 1.5};
  rig.swing = frequency, rig.speed = amplitude / rig.radius, rig.reads_relative = true;
  rig.mu_s = 0.5, rig.mu_k = 0.3, rig.decay = 52, rig.scatter = 0.002;
  rig.duration = 12 / std::min(1.0, frequency), rig.rate = 2000 * std::max(1.0, frequency / 2), rig.seed = seed;
  return rig;
}

/// A simulation as people make it first: nothing but the law and the rig.
Rig noiseless(double scatter, double rate, bool fractional) {
  Rig rig;
  rig.friction_noise = rig.velocity_noise = 0;
  rig.scatter = scatter, rig.rate = rate, rig.fractional = fractional;
  rig.decay = fractional ? 80 : 50;
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Independent, EmptyRecord,
                         testing::Values(Empty{"exponential", {.seed = 11}},
                                         Empty{"fractional", {.fractional = true, .decay = 80, .seed = 12}},
                                         Empty{"both_directions", {.swing = 0.15, .duration = 24, .seed = 13}},
                                         Empty{"reciprocating", reciprocating(0.02, 1, 14)},
                                         Empty{"slowly_reciprocating", reciprocating(0.02, 0.5, 15)},
                                         Empty{"quickly_reciprocating", reciprocating(0.05, 2, 16)},
                                         Empty{"noiseless", noiseless(0.006, 10000, false)},
                                         Empty{"noiseless_coarse", noiseless(0.006, 5000, true)},
                                         Empty{"noiseless_fine", noiseless(0.006, 20000, true)},
                                         Empty{"periodic", noiseless(0, 10000, true)},
                                         Empty{"periodic_coarse", noiseless(0, 5000, false)}),
                         [](const auto& empty) { return empty.param.name; });

struct Loaded {
  const char* key;
  double truth;  ///< of its first parameter [SI]
  Rig rig;
};

void PrintTo(const Loaded& loaded, std::ostream* out) {
  *out << loaded.key;
}

class LoadedRecord : public testing::TestWithParam<Loaded> {};

TEST_P(LoadedRecord, NamesWhatIsHidden) {
  const Loaded& hidden = GetParam();
  const DiagnosedTraces diagnosed = diagnosis_of(hidden.rig);
  const Diagnosis& diagnosis = diagnosed.diagnosis;
  EXPECT_EQ(diagnosis.verdict, Verdict::effect_found);
  ASSERT_EQ(diagnosis.ladder.size(), 2u) << ladder(diagnosis);
  const Rung& rung = diagnosis.ladder[1];
  EXPECT_LE(rung.equivalent.size(), 3u) << ladder(diagnosis);
  if (rung.added != hidden.key) {
    EXPECT_EQ(std::count(rung.equivalent.begin(), rung.equivalent.end(), hidden.key), 1) << ladder(diagnosis);
    return;
  }
  const auto found = std::find_if(diagnosis.effects.begin(), diagnosis.effects.end(),
                                  [&](const EffectFinding& f) { return f.key == hidden.key; });
  ASSERT_NE(found, diagnosis.effects.end());
  ASSERT_FALSE(found->parameters.empty());
  const auto& parameters = diagnosed.rungs.back().parameters;
  const auto own =
      std::find_if(parameters.begin(), parameters.end(), [&](const FitParameter& p) { return p.effect == hidden.key; });
  ASSERT_NE(own, parameters.end());
  expect_recovered(*own, hidden.truth);
  expect_law_recovered(diagnosed, hidden.rig);
}

INSTANTIATE_TEST_SUITE_P(
    Independent, LoadedRecord,
    testing::Values(Loaded{"viscous", 1.3, {.viscous = 1.3, .seed = 21}},
                    Loaded{"frictional-lag", 1.5e-3, {.lag = 1.5e-3, .seed = 22}},
                    Loaded{"drift", 0.0015, {.drift = 0.0015, .duration = 40, .rate = 2000, .seed = 23}},
                    Loaded{
                        "runout", 0.05, {.runout = 0.05, .runout_phase = 1, .duration = 40, .rate = 2000, .seed = 24}},
                    Loaded{"asymmetry", 1.12, {.swing = 0.15, .ratio = 1.12, .duration = 24, .rate = 5000, .seed = 25}},
                    Loaded{"channel-delay", 1e-3, {.delay = 1e-3, .seed = 26}},
                    Loaded{"force-bandwidth", 150, {.low_pass = 150, .seed = 27}}),
    [](const auto& hidden) {
      std::string name = hidden.param.key;
      std::replace(name.begin(), name.end(), '-', '_');
      return name;
    });

/// Friction that drops at once is the hardest to sample; a law that falls steeply does as well, but not another level.
TEST(Noiseless, CoulombFrictionIsRecovered) {
  for (const double rate : {5000.0, 20000.0}) {
    for (const double scatter : {0.0, 0.004}) {
      Rig rig = noiseless(scatter, rate, false);
      rig.decay = 1e7;
      const DiagnosedTraces diagnosed = diagnosis_of(rig);
      const Diagnosis& diagnosis = diagnosed.diagnosis;
      EXPECT_EQ(diagnosis.verdict, Verdict::sufficient) << rate << ", " << scatter << ": " << ladder(diagnosis);
      const auto& rivals = diagnosis.rival_laws;
      EXPECT_TRUE(diagnosis.law == Law(CoulombLaw{}) ||
                  std::find(rivals.begin(), rivals.end(), Law(CoulombLaw{})) != rivals.end());
      const std::vector<FitParameter>& p = diagnosed.rungs.back().parameters;
      EXPECT_NEAR(p.at(0).value, rig.mu_s, 1e-4 + 3 * scatter / std::sqrt(50.0)) << rate;
      EXPECT_NEAR(p.at(1).value, rig.mu_k, 1e-4) << rate;
    }
  }
}

Rig with_ratio(Rig rig, double ratio) {
  rig.ratio = ratio;
  return rig;
}

INSTANTIATE_TEST_SUITE_P(Reciprocating, LoadedRecord,
                         testing::Values(Loaded{"asymmetry", 1.15, with_ratio(reciprocating(0.02, 1, 31), 1.15)}),
                         [](const auto& hidden) { return std::string(hidden.param.key); });

/// A velocity with much noise: 0.5 mm/s is a tenth of the disc's speed, as a vibrometer far from its target has it.
/// What is fitted to it as it was read is off by several standard errors.
Rig with_noisy_velocity(Rig rig) {
  rig.velocity_noise = 0.5e-3, rig.rate = 20000, rig.scatter = 0.004, rig.duration = 15;
  return rig;
}

INSTANTIATE_TEST_SUITE_P(
    NoisyVelocity, LoadedRecord,
    testing::Values(Loaded{"viscous", 0.5,
                           with_noisy_velocity({.fractional = true, .decay = 95, .viscous = 0.5, .seed = 41})},
                    Loaded{"channel-delay", 0.5e-3, with_noisy_velocity({.delay = 0.5e-3, .seed = 42})},
                    Loaded{"channel-delay", -0.3e-3, with_noisy_velocity({.delay = -0.3e-3, .seed = 43})}),
    [](const auto& hidden) {
      return (hidden.index == 0 ? "viscous" : hidden.index == 1 ? "late" : "early");
    });

/// Friction that is read before the velocity has jumped already where the last samples of a slip seem to be.
INSTANTIATE_TEST_SUITE_P(
    Early, LoadedRecord,
    testing::Values(Loaded{"channel-delay", -0.3e-3, {.delay = -0.3e-3, .rate = 20000, .seed = 43}},
                    Loaded{"channel-delay", -1e-3, {.delay = -1e-3, .seed = 44}}),
    [](const auto& hidden) { return (hidden.index == 0 ? "a_little" : "by_much"); });

}  // namespace
