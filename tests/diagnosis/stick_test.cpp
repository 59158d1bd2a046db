/// Creep in stick as evidence, on records made with a known truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "../fit/synthetic.hpp"
#include "fit/stick_evidence.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/oscillator/presets.hpp"
#include "tribofit/oscillator/rig.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/pipeline.hpp"

namespace {

using namespace tribofit;

constexpr double kDiscSpeed = 0.419, kUnit = 0.003;

/// Sticks of 0.1 s with noise of v_r that is correlated from sample to sample, and `creep(time in stick)` on top.
template <class F>
Observations sticks_with(double colour, std::uint64_t seed, bool high_pass, F creep) {
  synthetic::Options options;
  options.cycles = 400;
  options.seed = seed;
  synthetic::Record made = synthetic::make(FrictionModel(ExponentialLaw{}), {0.509, 0.318, 52.14}, options);
  boost::random::mt19937_64 engine(seed);
  synthetic::ColouredNoise noise(colour, engine);
  for (const Cycle& cycle : made.segmentation.cycles) {
    for (std::size_t i = cycle.stick.begin; i < cycle.stick.end; ++i) {
      const double t = static_cast<double>(i - cycle.stick.begin) * made.motion.step;
      made.motion.relative_velocity[i] = creep(t) + 2e-5 * noise();
    }
  }
  if (high_pass) made.motion.high_pass = 0.1;
  Observations out = observe(made.motion, made.segmentation);
  add_stick_evidence(made.motion, made.segmentation, kUnit, out);
  return out;
}

/// Mean square of the weighted rows over the square of their unit: 1 for noise alone.
double size_of(const Observations& observations) {
  const auto weights = stick_weights(observations);
  double squares = 0, rows = 0;
  for (const StickCreep& stick : observations.sticks) {
    squares += (weights[0] * stick_velocities(stick, 0)).squaredNorm();
    rows += static_cast<double>(weights[0].rows());
  }
  return squares / rows / (kUnit * kUnit);
}

TEST(StickEvidence, NoiseOfAnyColourCountsForItsUnit) {
  for (const double colour : {0.0, 0.9, 0.98}) {
    const auto rigid = sticks_with(colour, 7, false, [](double) { return 0.0; });
    // 400 sticks of 5 rows: the mean square is known to 1/sqrt(1000) = 3 %.
    EXPECT_NEAR(size_of(rigid), 1, 0.1) << colour;
  }
}

TEST(StickEvidence, AConstantGapIsNoCreep) {
  const auto rigid = sticks_with(0.9, 7, false, [](double) { return 0.0; });
  const auto gap = sticks_with(0.9, 7, false, [](double) { return 3e-4; });
  EXPECT_NEAR(size_of(gap), size_of(rigid), 1e-9);
  const auto ramp = sticks_with(0.9, 7, false, [](double t) { return 3e-3 * t; });
  EXPECT_GT(size_of(ramp), 10 * size_of(rigid));
}

TEST(StickEvidence, BehindAHighPassARampIsNoCreepEither) {
  const auto rigid = sticks_with(0.9, 7, true, [](double) { return 0.0; });
  const auto ramp = sticks_with(0.9, 7, true, [](double t) { return 3e-4 + 3e-3 * t; });
  EXPECT_NEAR(size_of(ramp), size_of(rigid), 1e-9);
  const auto bent = sticks_with(0.9, 7, true, [](double t) { return 0.3 * t * t; });
  EXPECT_GT(size_of(bent), 10 * size_of(rigid));
}

TEST(StickEvidence, ALawThatIsWrongByAPartBindsNoCloserThanThat) {
  const auto creeping = sticks_with(0.9, 7, false, [](double t) { return 3e-3 * t; });
  const auto rigid = sticks_with(0.9, 7, false, [](double) { return 0.0; });
  const auto worth = [](const Observations& o) {  // of all sticks together, in standard deviations squared
    const Eigen::MatrixXd weights = stick_weights(o, {0, 0.3})[0];
    double squares = 0;
    for (const StickCreep& stick : o.sticks) squares += (weights * stick_velocities(stick, 0)).squaredNorm();
    return squares / (kUnit * kUnit) - static_cast<double>(weights.rows()) * static_cast<double>(o.sticks.size());
  };
  EXPECT_LT(worth(creeping), 6 / (0.3 * 0.3));
  EXPECT_GT(stick_weights(rigid, {0, 0.3})[0].squaredNorm() / stick_weights(rigid)[0].squaredNorm(), 0.8);
}

TEST(StickEvidence, IsSilentWhereNoiseIsNotKnown) {
  Observations few = sticks_with(0, 7, false, [](double) { return 0.0; });
  few.stick_noise[0].covariance.clear();
  EXPECT_EQ(stick_weights(few)[0].rows(), 0);
}

/// A record at 15 mm and the published speed.
TraceInput hidden_run(const FrictionModel& model, const std::vector<double>& p, const Rig& rig, double load,
                      double duration, Sensors sensors) {
  Drive drive;
  drive.radius = 0.015;
  drive.mean_load = load;
  drive.speed = constant_speed(kDiscSpeed);
  SimulationOptions options;
  options.duration = duration;
  options.rate = 10e3;
  options.settle = 3;
  options.scatter = {0.004, 0};
  options.seed = 11;
  sensors.seed = 12;
  SimulatedRecording hidden = simulate_recording(model, p, rig, drive, options, sensors);
  TraceInput input;
  input.trace = std::make_shared<const Trace>(std::move(hidden.recording.trace));
  return input;
}

/// The diagnosis of a record of the published 15 mm rig.
DiagnosedTraces diagnose_hidden(const std::string& key, const std::vector<double>& effect, double colour,
                                double velocity_noise = 2e-5, double duration = 10,
                                const Rig& rig = rig_with_damping_ratio(0.85, 16.2e3, 0.02)) {
  std::vector<double> p = {0.509, 0.318, 52.14};
  p.insert(p.end(), effect.begin(), effect.end());
  Sensors sensors;
  sensors.friction_noise = 0.003;
  sensors.velocity_noise = velocity_noise;
  sensors.noise_colour = colour;
  const FrictionModel model(ExponentialLaw{}, {make_effect(key)});
  return diagnose({hidden_run(model, p, rig, 50, duration, sensors)}, IdentifyOptions());
}

EffectFinding finding_of(const DiagnosedTraces& result, const std::string& key) {
  for (const EffectFinding& found : result.diagnosis.effects) {
    if (found.key == key) return found;
  }
  return {};
}

TEST(StickEvidence, NamesASpinThatHardlyShowsInSlip) {
  for (const double colour : {0.0, 0.9}) {
    const DiagnosedTraces result = diagnose_hidden("contact-spin", {0.5e-3}, colour);
    const EffectFinding spin = finding_of(result, "contact-spin");
    ASSERT_EQ(spin.status, EffectStatus::found) << colour << ": " << spin.reason;
    EXPECT_NEAR(spin.parameters[0].value, 0.5e-3, 0.05e-3);
    EXPECT_EQ(finding_of(result, "radius-offset").status, EffectStatus::not_supported);
    EXPECT_EQ(finding_of(result, "bristle").status == EffectStatus::found, false);
    const auto& where = result.diagnosis.where;
    EXPECT_TRUE(
        std::any_of(where.begin(), where.end(), [](const Share& s) { return s.variable == ResidualVariable::stick; }));
  }
}

/// It trails off at re-stick, as behind an amplifier, and its plateau is off omega r.
TEST(StickEvidence, AWideSpinIsNoLowPass) {
  for (const double radius : {2e-3, 4e-3}) {
    const DiagnosedTraces result = diagnose_hidden("contact-spin", {radius}, 0.5);
    const EffectFinding spin = finding_of(result, "contact-spin");
    ASSERT_EQ(spin.status, EffectStatus::found) << radius << ": " << spin.reason;
    EXPECT_NEAR(spin.parameters[0].value, radius, 0.02 * radius);
    for (const char* filter : {"velocity-bandwidth", "force-bandwidth", "radius-offset"})
      EXPECT_NE(finding_of(result, filter).status, EffectStatus::found) << filter;
  }
}

/// Behind noise of v_r friction that goes on to change after re-stick, as the contact does, is no filter of the sensor.
TEST(StickEvidence, ANoisySpinIsNoLowPass) {
  const DiagnosedTraces result = diagnose_hidden("contact-spin", {4e-3}, 0, 2e-4, 20);
  const EffectFinding spin = finding_of(result, "contact-spin");
  ASSERT_EQ(spin.status, EffectStatus::found) << spin.reason;
  EXPECT_NEAR(spin.parameters[0].value, 4e-3, 0.02 * 4e-3);
  EXPECT_NE(finding_of(result, "force-bandwidth").status, EffectStatus::found);
  EXPECT_FALSE(result.traces.front().motion.friction_low_pass.any());
}

/// Without noise a law of creep that is wrong explains most of what v_r shows in stick and leaves far more than noise.
TEST(StickEvidence, AQuietVelocityShowsABristleAndNoSpin) {
  for (const double noise : {0.0, 2e-6}) {
    const DiagnosedTraces result = diagnose_hidden("bristle", {6e4, 1}, 0, noise, 20);
    const EffectFinding bristle = finding_of(result, "bristle");
    ASSERT_EQ(bristle.status, EffectStatus::found) << noise << ": " << bristle.reason;
    // Before friction of a contact that creeps was read where its lead ends, and not on the line of a rigid stick:
    // 59.3 +- 0.2.
    EXPECT_NEAR(bristle.parameters[0].value, 6e4, 0.008 * 6e4) << noise;
    EXPECT_NE(finding_of(result, "contact-spin").status, EffectStatus::found) << noise;
    EXPECT_EQ(result.diagnosis.verdict, Verdict::effect_found) << noise;
  }
}

/// A filter smooths what noise of v_r does to friction, a delay does not: it is the truth nevertheless.
TEST(StickEvidence, NoiseOfVelocityMakesNoFilterOfADelay) {
  const DiagnosedTraces result = diagnose_hidden("channel-delay", {1e-3}, 0, 2e-4, 60);
  const EffectFinding delay = finding_of(result, "channel-delay");
  ASSERT_EQ(delay.status, EffectStatus::found) << delay.reason;
  EXPECT_NEAR(delay.parameters[0].value, 1e-3, 0.005 * 1e-3);  // 2 % late where a straight line leads between samples
}

/// Mains hum of half a period in a slip: sticks show its frequency, which slips confuse with one that differs from it
/// by that of stick-slip, and the noise beside it.
TEST(StickEvidence, ShowsTheFrequencyOfHum) {
  const Rig fast = rig_with_damping_ratio(0.2, 30e3, 0.02);
  const DiagnosedTraces result = diagnose_hidden("interference", {0.01, 50, 0}, 0, 1e-4, 20, fast);
  const EffectFinding hum = finding_of(result, "interference");
  ASSERT_EQ(hum.status, EffectStatus::found) << hum.reason;
  EXPECT_NEAR(hum.parameters[0].value, 0.01, 2e-4);
  EXPECT_NEAR(hum.parameters[1].value, 50, 1e-3);
  EXPECT_EQ(result.diagnosis.verdict, Verdict::effect_found);
}

TEST(StickEvidence, AWrongRadiusIsNoCreep) {
  const DiagnosedTraces result = diagnose_hidden("radius-offset", {0.97}, 0.9);
  EXPECT_EQ(finding_of(result, "radius-offset").status, EffectStatus::found);
  EXPECT_EQ(finding_of(result, "contact-spin").status, EffectStatus::not_supported);
  EXPECT_EQ(finding_of(result, "bristle").status, EffectStatus::not_supported);
}

/// A wrong radius would move the plateaus of both runs alike: that of half the load, whose sticks are short, is further
/// from omega r.
TEST(StickEvidence, PlateausThatDisagreeAreCreep) {
  const FrictionModel model(ExponentialLaw{}, {make_effect("bristle")});
  const Rig rig = rig_with_damping_ratio(0.946, 14978, 0.02);
  Sensors sensors;
  sensors.friction_noise = 0.008;
  sensors.velocity_noise = 5e-5;
  std::vector<TraceInput> inputs;
  for (const double load : {50.0, 25.0})
    inputs.push_back(hidden_run(model, {0.49, 0.388, 47.1, 1e5, 1}, rig, load, 7, sensors));
  const DiagnosedTraces result = diagnose(inputs, IdentifyOptions());
  const EffectFinding bristle = finding_of(result, "bristle");
  ASSERT_EQ(bristle.status, EffectStatus::found) << bristle.reason;
  EXPECT_NEAR(bristle.parameters[0].value, 1e5, 0.1 * 1e5);  // 7 % low: in short sticks the block rings on
  for (const Identification& trace : result.traces) {
    EXPECT_LT(trace.motion.plateau_ratio, 1);
    EXPECT_EQ(trace.motion.plateau_correction, PlateauCorrection::none);
  }
}

TEST(StickEvidence, RigidMemoriesAreNoBristle) {
  for (const auto& [key, p] : {std::pair<std::string, std::vector<double>>("rate-state", {50e-6, 0}),
                               std::pair<std::string, std::vector<double>>("frictional-lag", {1e-3})}) {
    const DiagnosedTraces result = diagnose_hidden(key, p, 0.9);
    EXPECT_EQ(finding_of(result, key).status, EffectStatus::found) << key;
    EXPECT_NE(finding_of(result, "bristle").status, EffectStatus::found) << key;
    EXPECT_NE(finding_of(result, "bristle").status, EffectStatus::equivalent) << key;
  }
}

}  // namespace
