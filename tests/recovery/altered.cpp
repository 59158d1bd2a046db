// Good records of known truth, altered as acquisition does it: the fault is named, what it spoilt takes no part, and
// the parameters stay within their intervals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "../kinematics/stick_slip_truth.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

using Random = std::mt19937_64;

/// What was done to a record, and the check that must name it.
struct Alteration {
  const char* name;
  std::function<void(Trace&, Random&)> apply;
  const char* check;
  const char* sentence;
};

std::size_t any_sample(const Trace& trace, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, trace.size() - 1)(random);
}

/// Cells of a channel that hold this value instead.
std::function<void(Trace&, Random&)> cells(std::vector<double> Trace::*channel, double value, int count = 5) {
  return [=](Trace& trace, Random& random) {
    for (int k = 0; k < count; ++k) (trace.*channel)[any_sample(trace, random)] = value;
  };
}

std::function<void(Trace&, Random&)> spikes(std::vector<double> Trace::*channel, double size) {
  return [=](Trace& trace, Random& random) {
    std::uniform_real_distribution<double> height(0.5, 1.5);
    for (int k = 0; k < 60; ++k) {
      (trace.*channel)[any_sample(trace, random)] += (k % 2 == 0 ? size : -size) * height(random);
    }
  };
}

/// The channel holds one value over a tenth of the record.
std::function<void(Trace&, Random&)> frozen(std::vector<std::vector<double> Trace::*> channels) {
  return [=](Trace& trace, Random&) {
    const std::size_t begin = trace.size() * 2 / 5, end = begin + trace.size() / 10;
    for (const auto channel : channels) {
      for (std::size_t i = begin; i < end; ++i) (trace.*channel)[i] = (trace.*channel)[begin];
    }
  };
}

/// A plug that loses contact now and then, for up to 20 ms.
std::function<void(Trace&, Random&)> loose(std::vector<std::vector<double> Trace::*> channels) {
  return [=](Trace& trace, Random& random) {
    for (int k = 0; k < 8; ++k) {
      const std::size_t begin = any_sample(trace, random);
      const std::size_t length = std::uniform_int_distribution<std::size_t>(5, 400)(random);
      for (const auto channel : channels) {
        for (std::size_t i = begin; i < std::min(trace.size(), begin + length); ++i) (trace.*channel)[i] = 0;
      }
    }
  };
}

std::function<void(Trace&, Random&)> stopped(double from, double to) {
  return [=](Trace& trace, Random& random) {
    const auto n = static_cast<double>(trace.size());
    const auto begin = static_cast<std::size_t>(from * n), end = static_cast<std::size_t>(to * n);
    const double level = trace.friction[begin];
    std::normal_distribution<double> normal;
    for (std::size_t i = begin; i < end; ++i) {
      trace.friction[i] = level + 0.003 * normal(random);
      trace.velocity[i] = 2e-5 * normal(random);
    }
  };
}

std::function<void(Trace&, Random&)> clipped_friction(double limit, double dither) {
  return [=](Trace& trace, Random& random) {
    std::normal_distribution<double> normal(0, 1);
    for (double& mu : trace.friction) mu = mu > limit ? limit + dither * normal(random) : mu;
  };
}

/// The block slips backwards up to `part` of its fastest.
std::function<void(Trace&, Random&)> clipped_velocity(double part, double dither) {
  return [=](Trace& trace, Random& random) {
    const double limit = part * *std::min_element(trace.velocity.begin(), trace.velocity.end());
    std::normal_distribution<double> normal(0, 1);
    for (double& v : trace.velocity) v = v < limit ? limit + dither * normal(random) : v;
  };
}

std::function<void(Trace&, Random&)> rounded(std::vector<double> Trace::*channel, double step) {
  return [=](Trace& trace, Random&) {
    for (double& x : trace.*channel) x = step * std::round(x / step);
  };
}

const auto kFriction = &Trace::friction;
const auto kVelocity = &Trace::velocity;

const std::vector<Alteration>& alterations() {
  static const std::vector<Alteration> list = {
      {"friction: five cells of -9999", cells(kFriction, -9999), "drop-outs", "marker value"},
      {"velocity: five cells of 1e38", cells(kVelocity, 1e38), "drop-outs", "marker value"},
      {"friction: five cells of 9.9E37", cells(kFriction, 9.9e37), "drop-outs", "marker value"},
      {"friction: a hundred cells of 9999", cells(kFriction, 9999, 100), "drop-outs", "marker value"},
      {"friction: lone spikes", spikes(kFriction, 0.3), "drop-outs", "lone sample"},
      {"velocity: lone spikes", spikes(kVelocity, 0.04), "drop-outs", "lone sample"},
      {"friction: frozen for a tenth", frozen({kFriction}), "drop-outs", "friction repeats one value"},
      {"velocity: frozen for a tenth", frozen({kVelocity}), "drop-outs", "velocity repeats one value"},
      {"both: frozen for a tenth", frozen({kFriction, kVelocity}), "drop-outs", "repeats one value"},
      {"friction: a loose plug", loose({kFriction}), "drop-outs", "friction repeats one value"},
      {"both: a loose plug", loose({kFriction, kVelocity}), "drop-outs", "repeats one value"},
      {"machine stopped at the end", stopped(0.85, 1), "drop-outs", "stands still"},
      {"machine stopped at the start", stopped(0, 0.15), "drop-outs", "stands still"},
      {"friction: clipped at 0.5, dither 2e-4", clipped_friction(0.5, 2e-4), "clipping", "mu_s"},
      {"friction: clipped at 0.5, dither 1e-3", clipped_friction(0.5, 1e-3), "clipping", "mu_s"},
      {"friction: clipped at 0.4", clipped_friction(0.4, 2e-4), "clipping", "mu_s"},
      {"velocity: clipped at 0.7, dither", clipped_velocity(0.7, 5e-6), "clipping", "alpha"},
      {"velocity: clipped at 0.95, dither", clipped_velocity(0.95, 2e-5), "clipping", "alpha"},
      {"velocity: clipped at 0.5", clipped_velocity(0.5, 0), "clipping", "alpha"},
      {"velocity: eight bits", rounded(kVelocity, 0.8e-3), "resolution", "steps of 0.8 mm/s"},
      {"friction: seven bits", rounded(kFriction, 0.004), "resolution", "steps of 0.004"},
  };
  return list;
}

truth::Rig rig_of(unsigned seed) {
  truth::Rig rig;
  rig.duration = 10;
  rig.scatter = 0.004;
  rig.seed = seed;
  return rig;
}

Identification identified(Trace trace) {
  IdentifyOptions options;
  options.laws = {Law(ExponentialLaw{})};
  options.published_protocol = false;
  Identification out = prepare_trace({"altered", {}, std::make_shared<const Trace>(std::move(trace))}, options);
  fit_trace(options, out);
  return out;
}

const HealthItem& item(const Identification& trace, const std::string& check) {
  return *std::find_if(trace.motion.health.begin(), trace.motion.health.end(),
                       [&](const HealthItem& i) { return i.check == check; });
}

/// All parameters within four standard errors of the truth: there are some seventy of them.
void expect_true(const Identification& trace, const truth::Rig& rig) {
  ASSERT_FALSE(trace.fits.empty());
  const std::vector<double> truth = {rig.static_friction, rig.kinetic_friction, rig.decay};
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const FitParameter& p = trace.fits[trace.best].parameters[k];
    EXPECT_LT(std::abs(p.value - truth[k]), 4 * p.std_error) << p.parameter.name << " " << p.value;
    EXPECT_LT(p.std_error, 0.03 * truth[k]) << p.parameter.name;
  }
}

class Altered : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Altered, TheFaultIsNamedAndTheParametersStay) {
  const Alteration& alteration = alterations()[GetParam()];
  SCOPED_TRACE(alteration.name);
  const truth::Rig rig = rig_of(11);
  Trace trace = truth::simulate(rig).trace;
  Random random(GetParam());
  alteration.apply(trace, random);
  const Identification found = identified(std::move(trace));
  const HealthItem& named = item(found, alteration.check);
  EXPECT_NE(named.status, HealthItem::Status::ok);
  EXPECT_THAT(named.message, ::testing::HasSubstr(alteration.sentence));
  expect_true(found, rig);
}

INSTANTIATE_TEST_SUITE_P(All, Altered, ::testing::Range<std::size_t>(0, alterations().size()));

TEST(NotAltered, ASoundRecordLosesNoSample) {
  for (const unsigned seed : {11U, 12U, 13U}) {
    const truth::Rig rig = rig_of(seed);
    const Identification found = identified(truth::simulate(rig).trace);
    EXPECT_TRUE(found.motion.faults.empty());
    EXPECT_TRUE(found.segmentation.left_out.empty());
    expect_true(found, rig);
  }
}

/// What the plateau of a coarse velocity is off omega r is no finding.
TEST(NotAltered, ARoundedPlateauIsNotOff) {
  for (const double step : {0.8e-3, 1e-3, 3.2e-3}) {
    Trace trace = truth::simulate(rig_of(11)).trace;
    Random random;
    rounded(kVelocity, step)(trace, random);
    const Motion motion = compute_motion(std::move(trace));
    EXPECT_LT(std::abs(motion.plateau_ratio - 1), 5 * motion.plateau_ratio_std_error) << step;
  }
}

TEST(Diagnosed, NamesNoEffectWhileAProblemStands) {
  const auto problems = {rounded(kVelocity, 3.2e-3), clipped_velocity(0.6, 5e-6), clipped_friction(0.45, 1e-3)};
  for (const auto& alter : problems) {
    Trace trace = truth::simulate(rig_of(11)).trace;
    Random random;
    alter(trace, random);
    const DiagnosedTraces found = diagnose({{"altered", {}, std::make_shared<const Trace>(std::move(trace))}});
    EXPECT_NE(found.diagnosis.verdict, Verdict::effect_found);
    EXPECT_THAT(found.diagnosis.messages,
                ::testing::Contains(::testing::HasSubstr("effects that look like it are not named")));
    for (const EffectFinding& effect : found.diagnosis.effects) {
      EXPECT_NE(effect.status, EffectStatus::found) << effect.key;
      EXPECT_NE(effect.status, EffectStatus::equivalent) << effect.key;
    }
  }
}

/// A v_r that was measured is held against rest in stick and omega r.
TEST(NotAltered, AMeasuredVelocityIsHeldAgainstRestAndOmegaR) {
  const truth::Rig rig = rig_of(11);
  const double disc = rig.speed() * rig.radius;
  const auto check = [&](double gain, double zero) {
    Trace trace = truth::simulate(rig).trace;
    trace.velocity_kind = VelocityKind::relative;
    for (double& v : trace.velocity) v = gain * (disc - v) + zero;
    const Motion motion = compute_motion(std::move(trace));
    return *std::find_if(motion.health.begin(), motion.health.end(),
                         [](const HealthItem& i) { return i.check == "plateau-speed"; });
  };
  EXPECT_EQ(check(1, 0).status, HealthItem::Status::ok) << check(1, 0).message;
  const HealthItem zero = check(1, 1e-3), gain = check(2, 0), block = check(-1, disc);
  for (const HealthItem& i : {zero, gain, block}) EXPECT_EQ(i.status, HealthItem::Status::problem) << i.message;
  EXPECT_THAT(zero.message, ::testing::HasSubstr("zero"));
  EXPECT_THAT(gain.message, ::testing::HasSubstr("2 times the truth"));
  EXPECT_THAT(block.message, ::testing::HasSubstr("name the column v_b"));
}

}  // namespace
}  // namespace tribofit
