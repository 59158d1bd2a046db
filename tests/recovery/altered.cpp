// Good records of known truth, altered as acquisition does it: the fault is named, what it spoilt is not used, and
// the parameters stay within their intervals.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "../kinematics/stick_slip_truth.hpp"
#include "altered_cases.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/kinematics/clock_offset.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

using namespace altered;

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

const HealthItem& item(const Motion& motion, const std::string& check) {
  const auto at =
      std::find_if(motion.health.begin(), motion.health.end(), [&](const HealthItem& i) { return i.check == check; });
  if (at == motion.health.end()) throw std::invalid_argument("no check is called " + check);
  return *at;
}

/// All parameters within half a per cent of the truth, and within four standard errors: there are some seventy of them.
void expect_true(const Identification& trace, const truth::Rig& rig) {
  ASSERT_FALSE(trace.fits.empty());
  const std::vector<double> truth = {rig.static_friction, rig.kinetic_friction, rig.decay};
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const FitParameter& p = trace.fits[trace.best].parameters[k];
    EXPECT_LT(std::abs(p.value - truth[k]), 4 * p.std_error) << p.parameter.name << " " << p.value;
    EXPECT_NEAR(p.value, truth[k], 0.005 * truth[k]) << p.parameter.name;
  }
}

/// Stretches that were altered take no part, and few samples else; a channel that was altered as a whole does.
void expect_marked(const Trace& before, const Trace& after, const Motion& found) {
  if (before.size() != after.size()) return;
  std::size_t altered = 0, marked = 0, both = 0;
  for (std::size_t i = found.trimmed; i < before.size(); ++i) {
    const bool is_altered = before.friction[i] != after.friction[i] || before.velocity[i] != after.velocity[i];
    const bool is_marked = found.has_fault(i - found.trimmed, SampleFault::any);
    altered += is_altered ? 1U : 0U, marked += is_marked ? 1U : 0U, both += is_altered && is_marked ? 1U : 0U;
  }
  const bool everywhere = altered > before.size() / 2;
  EXPECT_LT(marked - both, before.size() / 20);
  EXPECT_TRUE(everywhere ? both < before.size() / 500 : both == altered) << both << " of " << altered;
}

class Altered : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Altered, TheFaultIsNamedAndTheParametersStay) {
  const Alteration alteration = alterations()[GetParam()];
  SCOPED_TRACE(alteration.name);
  const truth::Rig rig = rig_of(11);
  const Trace sound = truth::simulate(rig).trace;
  Trace altered = sound;
  Random random(GetParam());
  alteration.apply(altered, random);
  const Identification found = identified(altered);
  EXPECT_NE(item(found.motion, alteration.check).status, HealthItem::Status::ok);
  for (const Undone& undone : alteration.undone) {
    const Estimate value = undone.found(found.motion);
    EXPECT_NEAR(value.value, undone.truth, 4 * value.std_error);
    EXPECT_LT(value.std_error, 0.15 * std::abs(undone.truth));
  }
  expect_marked(sound, altered, found.motion);
  expect_true(found, rig);
}

/// Each way of computing a filter lets a sine at its corner through at 1/sqrt 2, the more exactly the finer it is
/// sampled.
TEST(Filters, OfAnyDiscretisationHaveTheirCorner) {
  for (const Discretisation how :
       {Discretisation::next_held, Discretisation::last_held, Discretisation::straight, Discretisation::bilinear}) {
    for (const int order : {1, 2}) {
      Trace trace;
      for (int i = 0; i < 20000; ++i) {
        trace.time.push_back(1e-4 * i);
        trace.friction.push_back(std::sin(2 * std::numbers::pi * 100 * trace.time.back()));
      }
      Random random;
      butterworth({kFriction}, order, 100, how)(trace, random);
      const double gain = *std::max_element(trace.friction.begin() + 10000, trace.friction.end());
      EXPECT_NEAR(gain, std::numbers::sqrt2 / 2, how < Discretisation::straight ? 0.03 : 0.002) << order;
    }
  }
}

class BeyondRescue : public ::testing::TestWithParam<std::size_t> {};

TEST_P(BeyondRescue, TheFaultIsAProblem) {
  const Alteration alteration = beyond_rescue()[GetParam()];
  SCOPED_TRACE(alteration.name);
  Trace trace = truth::simulate(rig_of(11)).trace;
  Random random(GetParam());
  alteration.apply(trace, random);
  const Motion motion = compute_motion(std::move(trace));
  EXPECT_EQ(item(motion, alteration.check).status, HealthItem::Status::problem);
}

INSTANTIATE_TEST_SUITE_P(All, BeyondRescue, ::testing::Range<std::size_t>(0, beyond_rescue().size()));

/// Sound records of other speeds and rates, short sticks and few samples among them.
TEST(NotAltered, OtherSpeedsAndRatesHaveNoProblem) {
  for (const double rpm : {1.0, 16.0, 60.0, 120.0}) {
    for (const double rate : {20e3, 5e3}) {
      truth::Rig rig = rig_of(12);
      rig.rpm = rpm;
      rig.rate = rate;
      const Motion motion = compute_motion(truth::simulate(rig).trace);
      for (const HealthItem& i : motion.health) {
        EXPECT_NE(i.status, HealthItem::Status::problem) << rpm << " " << rate << " " << i.check << ": " << i.message;
      }
    }
  }
}

/// Down to sticks of ten samples nothing is off and nothing is found.
TEST(NotAltered, ShortSticksLeaveNoBias) {
  for (const double rpm : {120.0, 180.0, 210.0}) {
    for (const double rate : {20e3, 5e3}) {
      truth::Rig rig = rig_of(12);
      rig.rpm = rpm, rig.rate = rate, rig.duration = 4;
      SCOPED_TRACE(std::to_string(rpm) + " rpm at " + std::to_string(rate) + " Hz");
      const Identification found = identified(truth::simulate(rig).trace);
      expect_true(found, rig);
      EXPECT_EQ(item(found.motion, "plateau-speed").status, HealthItem::Status::ok);
      EXPECT_EQ(item(found.motion, "channel-delay").status, HealthItem::Status::ok);
      EXPECT_FALSE(found.motion.velocity_low_pass.any());
    }
  }
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
  const auto problems = {rounded(kVelocity, 3.2e-3), clipped_velocity(0.6, 5e-6), clipped_friction(0.45, 1e-3),
                         averaged({kFriction, kVelocity}, 1e-3), low_passed_twice({kVelocity}, 500)};
  for (const auto& alter : problems) {
    Trace trace = truth::simulate(rig_of(11)).trace;
    Random random;
    alter(trace, random);
    const DiagnosedTraces found = diagnose({{"altered", {}, std::make_shared<const Trace>(std::move(trace))}});
    EXPECT_NE(found.diagnosis.verdict, Verdict::effect_found);
    for (const EffectFinding& effect : found.diagnosis.effects) {
      EXPECT_NE(effect.status, EffectStatus::found) << effect.key;
      EXPECT_NE(effect.status, EffectStatus::equivalent) << effect.key;
    }
  }
}

/// What was found in the readings and undone is named, and nothing else.
TEST(Diagnosed, NamesWhatWasDoneToTheReadings) {
  struct Done {
    std::function<void(Trace&, Random&)> alter;
    std::vector<std::string> names;
  };
  const std::vector<Done> all = {
      {shifted(2e-4), {"velocity-offset"}},
      {shifted(-1e-3), {"velocity-offset"}},
      {low_passed({kVelocity}, 500), {"velocity-bandwidth"}},
      {low_passed({kFriction, kVelocity}, 300), {"force-bandwidth", "velocity-bandwidth"}},
      {low_passed({kFriction}, 500), {"force-bandwidth"}},
      {compressed(0.1), {"velocity-compression"}},
      {clocks_apart(100), {"clock-drift"}},
  };
  for (const Done& done : all) {
    Trace trace = truth::simulate(rig_of(11)).trace;
    Random random;
    done.alter(trace, random);
    const DiagnosedTraces found = diagnose({{"altered", {}, std::make_shared<const Trace>(std::move(trace))}});
    EXPECT_EQ(found.diagnosis.verdict, Verdict::effect_found) << done.names[0];
    std::vector<std::string> names;
    for (const EffectFinding& effect : found.diagnosis.effects) {
      if (effect.status == EffectStatus::found || effect.status == EffectStatus::equivalent)
        names.push_back(effect.key);
    }
    EXPECT_THAT(names, ::testing::UnorderedElementsAreArray(done.names));
  }
}

/// Of the long list, of which altered_benchmark runs all.
AlteredCase altered_case(const std::string& name) {
  const std::vector<AlteredCase> all = altered_cases();
  const auto at = std::find_if(all.begin(), all.end(), [&](const AlteredCase& one) { return one.name == name; });
  if (at == all.end()) throw std::invalid_argument("no altered record is called " + name);
  return *at;
}

TEST(Diagnosed, IsNotConfidentAndWrong) {
  for (const char* name : {"friction: clipped at 0.45, dither 0.002 (6 rpm, S = 0.05)",
                           "velocity: zero off by 2 mm/s (2 rpm)", "5 % of samples lost, 10 each (6 rpm, S = 0.05)",
                           "averaged in blocks of 40 (4 rpm)", "load swings by 20 % in 7 s (4 rpm)"}) {
    const Judged judged = judge(altered_case(name));
    EXPECT_NE(judged.outcome, Outcome::wrong) << name << judged.text;
  }
}

TEST(Diagnosed, OffersALoadThatNobodyRecorded) {
  const Judged judged = judge(altered_case("load swings by 20 % in 7 s (4 rpm)"));
  EXPECT_THAT(judged.possible, ::testing::Contains("load-dependence"));
}

/// An amplifier that follows no faster is seen in either channel.
TEST(NotAltered, OnlyASlewLimitHasOne) {
  for (const Channel channel : {kFriction, kVelocity}) {
    Trace trace = truth::simulate(rig_of(11)).trace;
    Random random;
    slew_limited({channel}, 0.5)(trace, random);
    const Identification found = identified(std::move(trace));
    EXPECT_EQ(item(found.motion, "clipping").status, HealthItem::Status::problem);
  }
  const Identification sound = identified(truth::simulate(rig_of(11)).trace);
  EXPECT_EQ(item(sound.motion, "clipping").status, HealthItem::Status::ok);
}

/// A v_r that was measured is held against rest in stick and omega r; a zero is taken off.
TEST(NotAltered, AMeasuredVelocityIsHeldAgainstRestAndOmegaR) {
  const truth::Rig rig = rig_of(11);
  const double disc = rig.speed() * rig.radius;
  const auto moved = [&](double gain, double zero) {
    Trace trace = truth::simulate(rig).trace;
    trace.velocity_kind = VelocityKind::relative;
    for (double& v : trace.velocity) v = gain * (disc - v) + zero;
    return compute_motion(std::move(trace));
  };
  const auto status = [](const Motion& motion) { return item(motion, "plateau-speed").status; };
  EXPECT_EQ(status(moved(1, 0)), HealthItem::Status::ok);
  const Motion zero = moved(1, 1e-3);
  EXPECT_EQ(status(zero), HealthItem::Status::warning);
  EXPECT_NEAR(std::abs(zero.velocity_zero.value), 1e-3, 1e-5);
  EXPECT_EQ(status(moved(1.05, 0)), HealthItem::Status::warning);
  EXPECT_EQ(status(moved(2, 0)), HealthItem::Status::problem);
  EXPECT_THAT(item(moved(-1, disc), "plateau-speed").message, ::testing::HasSubstr("name the column v_b"));
}

/// The offset between two records that begin at these times [s] and have clocks of their own.
ClockOffset joined(const Trace& friction, double friction_from, const Trace& velocity, double velocity_from) {
  const auto part = [](const std::vector<double>& channel, double from, double step) {
    return std::vector<double>(channel.begin() + static_cast<std::ptrdiff_t>(from / step + 0.5), channel.end());
  };
  const auto clock = [&](const Trace& trace, double from) {
    std::vector<double> time = part(trace.time, from, trace.interval());
    for (double& t : time) t -= from;
    return time;
  };
  return estimate_clock_offset(
      clock(friction, friction_from), part(friction.friction, friction_from, friction.interval()),
      clock(velocity, velocity_from), part(velocity.velocity, velocity_from, velocity.interval()));
}

TEST(Joined, ALateStartIsFound) {
  const Trace trace = truth::simulate(rig_of(11)).trace;
  for (const double late : {0.1, 0.7, 1.3, 3.0, 5.0}) {
    EXPECT_NEAR(joined(trace, 0, trace, late).offset, late, 1e-4) << late;
    EXPECT_NEAR(joined(trace, late, trace, 0).offset, -late, 1e-4) << late;
  }
}

TEST(Joined, RecordsOfDifferentRunsAreRefused) {
  const Trace trace = truth::simulate(rig_of(11)).trace;
  for (const unsigned seed : {12U, 13U, 14U}) {
    EXPECT_THROW(joined(trace, 0, truth::simulate(rig_of(seed)).trace, 0), InputError) << seed;
  }
  truth::Rig faster = rig_of(11);
  faster.rpm = 8;
  EXPECT_THROW(joined(trace, 0, truth::simulate(faster).trace, 0), InputError);
}

}  // namespace
}  // namespace tribofit
