/// What a disc that pauses and a load that follows friction show, on records simulated with a known truth.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/oscillator/rig.hpp"
#include "tribofit/oscillator/simulate_recording.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/segmentation/load_coupling.hpp"

namespace {

using namespace tribofit;

constexpr double kOmega = 0.419, kMuS = 0.509;

struct Simulated {
  std::shared_ptr<const Trace> trace;
  Motion motion;
  Segmentation segmentation;
};

/// 30 s of the published 15 mm rig.
Simulated make(const std::vector<Effect>& effects, const std::vector<double>& values, const Drive& given,
               double scatter) {
  Drive drive = given;
  drive.radius = 0.015;
  drive.mean_load = 50;
  std::vector<double> p = {kMuS, 0.318, 52.14};
  p.insert(p.end(), values.begin(), values.end());
  SimulationOptions options;
  options.duration = 30;
  options.rate = 5e3;
  options.settle = 3;
  options.scatter = {scatter, 0};
  options.seed = 21;
  Sensors sensors;
  sensors.friction_noise = 0.001;
  sensors.velocity_noise = 2e-5;
  sensors.seed = 22;
  const FrictionModel model(ExponentialLaw{}, effects);
  SimulatedRecording hidden =
      simulate_recording(model, p, rig_with_damping_ratio(0.85, 16.2e3, 0.02), drive, options, sensors);
  Simulated simulated;
  simulated.trace = std::make_shared<const Trace>(std::move(hidden.recording.trace));
  simulated.motion = compute_motion(Trace(*simulated.trace));
  simulated.segmentation = find_cycles(simulated.motion);
  return simulated;
}

Drive steady() {
  Drive drive;
  drive.speed = constant_speed(kOmega);
  return drive;
}

Drive with_pauses() {
  Drive drive;
  std::vector<Pause> pauses;
  for (double t = 1.3, length = 0.3; t < 27; t += length + 1.1, length = length < 2 ? 1.6 * length : 0.3) {
    pauses.push_back({t, length});
  }
  drive.speed = stepped_speed({0}, {kOmega}, pauses);
  return drive;
}

double correlation(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = static_cast<double>(x.size());
  double mx = 0, my = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / n;
    my += y[i] / n;
  }
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    yy += (y[i] - my) * (y[i] - my);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return xy / std::sqrt(xx * yy);
}

TEST(LoadCoupling, ComesBackFromTheLoadChannel) {
  for (const double kappa : {-0.2, -0.1, 0.1, 0.2}) {
    Simulated simulated = make({make_effect("load-coupling")}, {kappa}, steady(), 0.004);
    ASSERT_FALSE(simulated.motion.load.empty());
    const Estimate found = load_coupling(simulated.motion, simulated.segmentation);
    EXPECT_NEAR(found.value, kappa, 0.005) << kappa;
    uncouple_load(found.value, simulated.motion);
    for (const double load : simulated.motion.load) ASSERT_NEAR(load, 50, 0.25);
  }
}

TEST(LoadCoupling, ALoadThatSwingsByItselfIsNone) {
  Drive drive = steady();
  drive.load = [](double t) { return 50 + 20 * std::sin(2 * std::numbers::pi * t / 17); };
  const Simulated simulated = make({}, {}, drive, 0.004);
  const Estimate found = load_coupling(simulated.motion, simulated.segmentation);
  EXPECT_LT(std::abs(found.value), 4 * found.std_error + 0.01);
}

/// Friction rises over most of a cycle, and so does this load, which is turned up by a tenth within the record.
TEST(LoadCoupling, ALoadThatIsRampedIsNone) {
  for (const double rise : {0.2, -0.2}) {
    Drive drive = steady();
    drive.load = [rise](double t) { return 50 + rise * t; };
    const Simulated simulated = make({}, {}, drive, 0.004);
    const Estimate found = load_coupling(simulated.motion, simulated.segmentation);
    EXPECT_LT(std::abs(found.value), 4 * found.std_error + 0.001) << rise;
  }
}

TEST(ChangePoint, IsFoundWithIntervalsThatHoldIt) {
  for (const double when : {9.37, 14.05, 21.62}) {
    const Simulated simulated = make({make_effect("step")}, {0.02, when}, steady(), 0.004);
    const FrictionModel model(ExponentialLaw{}, {make_effect("step")});
    const Fit fit = fit_model(model, simulated.motion, simulated.segmentation,
                              observe(simulated.motion, simulated.segmentation, model.needs(), 1000));
    ASSERT_EQ(fit.parameters.size(), 5u);
    const FitParameter &delta = fit.parameters[3], &time = fit.parameters[4];
    EXPECT_NEAR(delta.value, 0.02, 5e-4) << when;
    EXPECT_LT(delta.upper95 - delta.lower95, 0.002) << "not its bounds";
    EXPECT_LE(time.lower95, when);
    EXPECT_GE(time.upper95, when);
    EXPECT_LT(time.upper95 - time.lower95, 0.5) << "two cycles";
  }
}

TEST(Pauses, BreakAwayAfterAPauseIsReadFromTheStretchThatPulls) {
  const Simulated simulated = make({}, {}, with_pauses(), 0);
  int after_pause = 0;
  for (const Cycle& cycle : simulated.segmentation.cycles) {
    if (!std::isfinite(cycle.break_away_friction)) continue;
    EXPECT_NEAR(cycle.break_away_friction, kMuS, 0.003) << cycle.break_away_time;
    after_pause += cycle.stick_time > 0.4 ? 1 : 0;
  }
  EXPECT_GE(after_pause, 8);
}

TEST(Pauses, StickTimesDoNotFollowTheirOwnBreakAway) {
  const Simulated simulated = make({}, {}, steady(), 0.01);
  Channels channels;
  channels.stick_time = true;
  const Observations observations = observe(simulated.motion, simulated.segmentation, channels, 40);
  std::vector<double> raw, freed, level;
  for (std::size_t k = 1; k < observations.slips.size(); ++k) {
    const auto& slip = observations.slips[k];
    if (!slip.from_stick || !simulated.segmentation.cycles[slip.segment].stick_complete) continue;
    raw.push_back(simulated.segmentation.cycles[slip.segment].stick_time);
    freed.push_back(slip.stick_time);
    level.push_back(slip.break_away_friction);
  }
  ASSERT_GE(level.size(), 80u);
  EXPECT_GT(correlation(raw, level), 0.5);
  EXPECT_LT(std::abs(correlation(freed, level)), 0.3);  // three standard errors of nothing
}

TEST(Pauses, NameAgeingWhereItIsAndOnlyThere) {
  for (const bool ages : {false, true}) {
    const Simulated simulated =
        ages ? make({make_effect("ageing")}, {0.016, 0.1}, with_pauses(), 0.006) : make({}, {}, with_pauses(), 0.006);
    TraceInput input;
    input.trace = simulated.trace;
    const DiagnosedTraces result = diagnose({input}, IdentifyOptions());
    std::vector<std::string> named;
    for (const Rung& rung : result.diagnosis.ladder) {
      if (!rung.added.empty()) named.push_back(rung.added);
    }
    EXPECT_EQ(named, ages ? std::vector<std::string>{"ageing"} : std::vector<std::string>{});
  }
}

}  // namespace
