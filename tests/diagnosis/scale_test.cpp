/// The rig's scales do not decide: the same record in other seconds is the same diagnosis, and noise is no effect.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "../fit/synthetic.hpp"
#include "fit/starts.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"

namespace {

using namespace tribofit;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Keys on the ladder above the base law.
std::vector<std::string> names(const Diagnosis& diagnosis) {
  std::vector<std::string> out;
  for (const Rung& rung : diagnosis.ladder) {
    if (!rung.added.empty()) out.push_back(rung.added);
  }
  return out;
}

/// A record of a rig that is `slower` times slower: t -> S t, v -> v/S.
synthetic::Options on_a_rig(double slower) {
  synthetic::Options options;
  options.rate /= slower;
  options.stick_time *= slower;
  options.slip_time *= slower;
  options.peak /= slower;
  options.noise = 0.003;
  return options;
}

TEST(Scale, ASlowerOrFasterRigWithTheSameLagGetsTheSameName) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("frictional-lag")});
  for (const double slower : {1000.0, 30.0, 1.0, 0.05, 0.01}) {
    const double tau = 2e-3 * slower;
    const synthetic::Record made = synthetic::make(model, {0.509, 0.318, 52.14 * slower, tau}, on_a_rig(slower));
    const Record record = {&made.motion, &made.segmentation};
    const Diagnosed out = diagnose({&record, 1}, {ExponentialLaw{}, FractionalLaw{}});
    EXPECT_THAT(names(out.diagnosis), ElementsAre("frictional-lag")) << slower;
    const FitParameter& found = out.fits.back().parameters.back();
    EXPECT_NEAR(found.value, tau, 4 * found.std_error) << slower;
    EXPECT_LT(found.std_error, 0.05 * tau) << slower;
  }
}

TEST(Scale, BoundsGoWithTheScalesOfTheRecord) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("frictional-lag"), make_effect("bristle")});
  const auto bounds = [&](double slower) {
    const synthetic::Record made =
        synthetic::make(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14 * slower}, on_a_rig(slower));
    return bounds_of(model, observe(made.motion, made.segmentation, model.needs()));
  };
  const Bounds here = bounds(1), slow = bounds(30);
  const std::size_t tau = model.offset_of("frictional-lag"), stiffness = model.offset_of("bristle");
  EXPECT_NEAR(slow.upper[tau] / here.upper[tau], 30, 1e-6);
  EXPECT_NEAR(slow.upper[stiffness] / here.upper[stiffness], 1, 1e-6);  // lengths are the same
}

TEST(Scale, BoundsOfSeveralRecordsHoldThoseOfEach) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("heating")});
  const auto seen = [&](double slower) {
    const synthetic::Record made =
        synthetic::make(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14 * slower}, on_a_rig(slower));
    return observe(made.motion, made.segmentation, model.needs());
  };
  const Bounds fast = bounds_of(model, seen(1)), slow = bounds_of(model, seen(30));
  const Bounds both = bounds_of(model, join({seen(1), seen(30)}));
  const std::size_t time = model.offset_of("heating") + 1;
  EXPECT_LT(fast.lower[time], slow.lower[time]);
  EXPECT_DOUBLE_EQ(both.lower[time], fast.lower[time]);
  EXPECT_DOUBLE_EQ(both.upper[time], slow.upper[time]);
}

/// Friction that rises by two fifths, or falls by as much, over a record is a drift still.
TEST(Scale, AStrongDriftIsNamed) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("drift")});
  const double duration =
      synthetic::make(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, on_a_rig(1)).motion.duration();
  for (const double change : {0.4, -0.4}) {
    const double d = change / duration;
    const synthetic::Record made = synthetic::make(model, {0.509, 0.318, 52.14, d}, on_a_rig(1));
    const Record record = {&made.motion, &made.segmentation};
    const Diagnosed out = diagnose({&record, 1}, {ExponentialLaw{}, FractionalLaw{}});
    EXPECT_THAT(names(out.diagnosis), ElementsAre("drift")) << change;
    const FitParameter& found = out.fits.back().parameters.back();
    EXPECT_NEAR(found.value, d, 0.005 * std::abs(d)) << change;
  }
}

/// Ten records of 200 samples: a constant force with noise at ten constant speeds.
std::vector<TraceInput> constant_friction(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<TraceInput> inputs;
  for (int k = 0; k < 10; ++k) {
    auto trace = std::make_shared<Trace>();
    trace->path = "run-" + std::to_string(k);
    trace->friction_kind = FrictionKind::force;
    trace->velocity_kind = VelocityKind::relative;
    for (std::size_t i = 0; i < 200; ++i) {
      trace->time.push_back(0.005 * static_cast<double>(i));
      trace->friction.push_back(15 + 1.6 * normal(engine));
      trace->velocity.push_back(0.01 + 0.01 * k + 5e-5 * normal(engine));
    }
    trace->steps.resize(1);
    trace->steps[0].end = trace->size();
    inputs.push_back({trace->path, {}, trace});
  }
  return inputs;
}

/// Speed steps in a random order, 0.5 to 200 mm/s; friction mu(v in mm/s) with white noise.
TraceInput speed_steps(const std::function<double(double)>& mu, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> speeds;
  for (int k = 0; k < 24; ++k) speeds.push_back(0.5 * std::pow(400.0, k / 23.0));
  std::shuffle(speeds.begin(), speeds.end(), engine);
  auto trace = std::make_shared<Trace>();
  trace->path = "steps";
  trace->velocity_kind = VelocityKind::relative;
  for (const double v : speeds) {
    for (int i = 0; i < 300; ++i) {
      trace->time.push_back(0.01 * static_cast<double>(trace->time.size()));
      trace->friction.push_back(mu(v) + 0.003 * normal(engine));
      trace->velocity.push_back(1e-3 * (v + 0.01 * normal(engine)));
    }
  }
  trace->steps.resize(1);
  trace->steps[0].end = trace->size();
  return {trace->path, {}, trace};
}

Floor floor_of(const Law& law, const std::function<double(double)>& mu, std::uint64_t seed) {
  IdentifyOptions options;
  options.laws = {law};
  Identification trace = prepare_trace(speed_steps(mu, seed), options);
  fit_trace(options, trace);
  return trace.fits.at(0).floor;
}

/// What a wrong law leaves at the steps of speed is no 1/f noise, and no part of the noise floor. This friction is
/// another at each of the speeds, by no law.
TEST(SlowNoise, AWrongLawDoesNotRaiseTheNoiseFloor) {
  const auto mu = [](double v) { return 0.3 + 0.02 * std::sin(1e4 * v); };
  int raised = 0;
  constexpr int kRecords = 20;
  for (int seed = 1; seed <= kRecords; ++seed) {
    const Floor floor = floor_of(CoulombLaw{}, mu, static_cast<std::uint64_t>(seed));
    EXPECT_NEAR(floor.noise, 0.003, 0.0005) << seed;
    EXPECT_NEAR(std::sqrt(floor.rmse * floor.rmse - floor.slow_noise * floor.slow_noise), 0.003, 0.0005) << seed;
    raised += floor.slow_noise > 0 ? 1 : 0;  // all noise is white
  }
  EXPECT_LE(raised, 2);
}

/// Friction that wanders as no noise of the law's does is not described by a law with a noise floor, however little few
/// swings say of their own size: such a law is not called enough.
TEST(SlowNoise, AWanderFarAboveTheNoiseFloorIsUnexplained) {
  int large = 0, slow = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const TraceInput input = speed_steps([](double v) { return 0.3 + 0.2 * std::exp(-0.05 * v); }, seed);
    auto trace = std::make_shared<Trace>(*input.trace);
    std::mt19937_64 engine(100 + seed);
    std::normal_distribution<double> normal;
    double wander = 0;
    for (double& friction : trace->friction) friction += wander += 0.0008 * normal(engine);
    const Diagnosis out = diagnose(std::vector<TraceInput>{{trace->path, {}, trace}}).diagnosis;
    if (!(out.ladder.back().held_out_rmse > 2 * out.floor_rmse)) continue;
    ++large;
    EXPECT_EQ(out.verdict, Verdict::unexplained) << seed << ": " << out.ladder.back().held_out_rmse / out.floor_rmse;
    for (const std::string& message : out.messages) {
      if (message.find("wanders slowly") != std::string::npos) ++slow;
    }
  }
  EXPECT_GE(large, 6);
  EXPECT_GE(slow, 1);
}

/// Another law of the list says with fewer parameters what one of the first laws says with an effect.
TEST(BaseLaw, TheLawsOfTheListCompete) {
  const std::vector<std::pair<std::string, std::function<double(double)>>> truths = {
      {"logarithmic", [](double v) { return 0.4 - 0.02 * std::log(v); }},
      {"logarithmic", [](double v) { return 0.3 + 0.01 * std::log(v); }},
      {"gaussian", [](double v) { return 0.3 + 0.2 * std::exp(-v * v / 400); }},
      {"exponential", [](double v) { return 0.3 + 0.2 * std::exp(-0.05 * v); }},
      {"fractional", [](double v) { return 0.3 + 0.2 / (1 + 0.05 * v); }}};
  for (const auto& [law, mu] : truths) {
    const Diagnosis out = diagnose(std::vector<TraceInput>{speed_steps(mu, 7)}).diagnosis;
    EXPECT_EQ(to_string(out.law), law);
    EXPECT_THAT(names(out), IsEmpty()) << law;
    EXPECT_EQ(out.verdict, Verdict::sufficient) << law;
  }
}

/// The true law is the one reported, or named beside it; where friction falls by many times its noise it is alone.
TEST(BaseLaw, LawsThatTheDataDoNotDistinguishAreNamed) {
  constexpr int kRecords = 20;
  int kept = 0, alone = 0, several = 0;
  for (std::uint64_t seed = 1; seed <= kRecords; ++seed) {
    const auto told = [&](double drop) {
      const auto mu = [drop](double v) { return 0.3 + drop * std::exp(-0.05 * v); };
      return diagnose(std::vector<TraceInput>{speed_steps(mu, seed)}).diagnosis;
    };
    const Diagnosis faint = told(0.0015), clear = told(0.2);
    const auto& rivals = faint.rival_laws;
    const bool named = std::find(rivals.begin(), rivals.end(), Law(ExponentialLaw{})) != rivals.end();
    kept += named || faint.law == Law(ExponentialLaw{}) ? 1 : 0;
    several += rivals.empty() ? 0 : 1;
    alone += clear.rival_laws.empty() && clear.law == Law(ExponentialLaw{}) ? 1 : 0;
  }
  EXPECT_GE(kept, kRecords - 3);  // one in twenty is clearly worse by chance
  EXPECT_GE(several, kRecords - 3);
  EXPECT_EQ(alone, kRecords);
}

/// The textbook Stribeck curve whose viscous part is the larger: without a break-away to hold it the law alone takes
/// the place of the rise, and must be let go again.
TEST(BaseLaw, AStrongViscousPartIsFoundBesideTheStribeckFall) {
  for (const double sigma : {0.0005, 0.002, -0.0005}) {
    const auto mu = [sigma](double v) { return 0.35 + 0.15 * std::exp(-v / 8) + sigma * v; };
    const DiagnosedTraces out = diagnose(std::vector<TraceInput>{speed_steps(mu, 3)});
    EXPECT_EQ(to_string(out.diagnosis.law), "exponential") << sigma;
    EXPECT_THAT(names(out.diagnosis), ElementsAre("viscous")) << sigma;
    const FitParameter& found = out.fits.back().parameters.back();
    EXPECT_NEAR(found.value, 1e3 * sigma, 4 * found.std_error) << sigma;
    EXPECT_LT(out.diagnosis.ladder.back().held_out_rmse, 1.1 * out.diagnosis.floor_rmse) << sigma;
  }
}

/// Steady points in both directions, as of a gear or a joint in N: friction over speed in parts of the fastest, and a
/// zero that is off.
TraceInput gear(const std::function<double(double)>& friction, double zero, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  auto trace = std::make_shared<Trace>();
  trace->path = "gear";
  trace->kind = RecordKind::points;
  trace->friction_kind = FrictionKind::force;
  trace->velocity_kind = VelocityKind::relative;
  for (int k = 0; k < 120; ++k) {
    const double part = 0.005 * std::pow(200.0, (k / 2) / 59.0), sign = k % 2 == 0 ? 1 : -1;
    trace->time.push_back(k);
    trace->velocity.push_back(sign * 0.3 * part);
    trace->friction.push_back(sign * friction(part) + zero + 0.1 * normal(engine));
  }
  trace->steps = {{0, trace->size(), "", {}}};
  return {trace->path, {}, trace};
}

/// Friction that falls by 4 N and grows again by up to ten times as much with speed, whatever the law of the fall.
TEST(BaseLaw, TheFallIsFoundBelowViscousFrictionOfManyTimesItsSize) {
  const std::vector<std::pair<std::string, std::function<double(double)>>> falls = {
      {"gaussian", [](double v) { return std::exp(-std::pow(v / 0.1, 2)); }},
      {"exponential", [](double v) { return std::exp(-v / 0.1); }},
      {"fractional", [](double v) { return 1 / (1 + v / 0.05); }}};
  int records = 0, right = 0;
  for (const auto& [law, fall] : falls) {
    for (const double grows : {0.5, 2.0, 10.0}) {
      for (const double zero : {0.0, 1.5}) {
        const auto friction = [&, &f = fall](double v) { return 5 + 4 * f(v) + 4 * grows * v; };
        const Diagnosis d = diagnose({gear(friction, zero, static_cast<std::uint64_t>(++records))}).diagnosis;
        const bool in_set =
            to_string(d.law) == law ||
            std::ranges::any_of(d.rival_laws, [&, &name = law](const Law& l) { return to_string(l) == name; });
        std::vector<std::string> expected = {"viscous"};
        if (zero != 0) expected.insert(expected.begin(), "sensor-offset");
        std::vector<std::string> found = names(d);
        std::sort(found.begin(), found.end());
        right += in_set && found == expected ? 1 : 0;
      }
    }
  }
  EXPECT_GE(right, records - 1);
}

/// A straight line is no part of a Stribeck curve.
TEST(BaseLaw, FrictionThatFallsInAStraightLineIsConstantWithNegativeViscousFriction) {
  const DiagnosedTraces out = diagnose({speed_steps([](double v) { return 0.3 - 0.0006 * v; }, 4)});
  EXPECT_EQ(to_string(out.diagnosis.law), "coulomb");
  EXPECT_THAT(names(out.diagnosis), ElementsAre("viscous"));
  const FitParameter& found = out.fits.back().parameters.back();
  EXPECT_NEAR(found.value, -0.6, 4 * found.std_error);
}

/// Strokes over 40 s while the zero of the force sensor drifts by a seventh of the friction.
TEST(Measurement, AZeroThatDriftsIsToldFromFrictionThatDrifts) {
  std::mt19937_64 engine(6);
  std::normal_distribution<double> normal;
  auto trace = std::make_shared<Trace>();
  trace->path = "strokes";
  trace->velocity_kind = VelocityKind::relative;
  for (int i = 0; i < 8000; ++i) {
    const double t = 0.005 * i, v = 0.02 * std::sin(2 * std::numbers::pi * 0.5 * t);
    const double mu = std::copysign(0.22 + 0.13 * std::exp(-std::abs(v) / 0.012), v);
    trace->time.push_back(t);
    trace->velocity.push_back(v + 2e-5 * normal(engine));
    trace->friction.push_back(mu + 0.001 * t + 0.003 * normal(engine));
  }
  trace->steps = {{0, trace->size(), "", {}}};
  const DiagnosedTraces out = diagnose({{trace->path, {}, trace}});
  EXPECT_THAT(names(out.diagnosis), ElementsAre("zero-drift"));
  const FitParameter& found = out.fits.back().parameters.back();
  EXPECT_NEAR(found.value, 0.001, 4 * found.std_error);
}

TEST(Noise, ConstantFrictionAtConstantSpeedsHasNoEffect) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const DiagnosedTraces result = diagnose(constant_friction(seed));
    EXPECT_THAT(names(result.diagnosis), IsEmpty()) << seed;
    EXPECT_GT(result.diagnosis.ladder.at(0).held_out_rmse, 1.5) << seed;  // no less than the noise that was put in
    for (const EffectFinding& finding : result.diagnosis.effects) {
      const bool memory = finding.key == "bristle" || finding.key == "rate-state" || finding.key == "frictional-lag";
      if (!memory) continue;
      EXPECT_EQ(finding.status, EffectStatus::untestable) << finding.key;
    }
  }
}

}  // namespace
