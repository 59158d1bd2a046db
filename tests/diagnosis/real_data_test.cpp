/// Rigs of other laboratories, against what was published about them; skipped where the shared data are absent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "../real_data.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/pipeline.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace {

using namespace tribofit;
using ::testing::Contains;

class RealData : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(real_data("measured"))) GTEST_SKIP() << real_data("measured") << " is absent";
  }

  DiagnosedTraces diagnosed(const std::string& file, ReadOptions read, const IdentifyOptions& options = {}) const {
    return diagnose({{(real_data("measured") / file).string(), std::move(read), {}}}, options);
  }
};

const EffectFinding& finding(const DiagnosedTraces& result, const std::string& key) {
  const auto& effects = result.diagnosis.effects;
  return *std::find_if(effects.begin(), effects.end(), [&](const EffectFinding& f) { return f.key == key; });
}

double value_of(const DiagnosedTraces& result, const std::string& name) {
  for (const FitParameter& parameter : result.fits.back().parameters) {
    if (parameter.parameter.name == name) return parameter.value;
  }
  return std::nan("");
}

std::vector<std::string> rungs(const DiagnosedTraces& result) {
  std::vector<std::string> added;
  for (const Rung& rung : result.diagnosis.ladder) added.push_back(rung.added);
  return added;
}

/// Part of the held-out error that the rungs take away.
double fall(const DiagnosedTraces& result) {
  const auto& ladder = result.diagnosis.ladder;
  return 1 - ladder.back().held_out_rmse / ladder.front().held_out_rmse;
}

/// What a straight line of friction over speed leaves in the slips [N]: constant and viscous friction by plain
/// regression. Positive v_r only, as in this record.
double error_of_straight_line(const Identification& trace) {
  std::vector<double> speed, friction;
  for (const Cycle& cycle : trace.segmentation.cycles) {
    for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
      speed.push_back(trace.motion.relative_velocity[i]);
      friction.push_back(trace.motion.friction[i]);
    }
  }
  const StraightLine line = fit_line(speed, friction);
  double squares = 0;
  for (std::size_t i = 0; i < speed.size(); ++i) squares += std::pow(friction[i] - line.at(speed[i]), 2);
  return std::sqrt(squares / static_cast<double>(speed.size()));
}

/// Published (IDIM-LS): moving mass 95.1089 kg, viscous 203.5034 N s/m, Coulomb 20.3935 N, offset -3.1648 N.
TEST_F(RealData, PositioningSystemClimbsFromCoulombFrictionToItsPublishedModel) {
  ReadOptions read;
  read.columns = {{"time", "time_s"}, {"v_r", "dq_f_m_per_s"}, {"force", "Force1_N"}};
  const DiagnosedTraces result = diagnosed("emps/emps_training_measured.csv", read);
  ASSERT_TRUE(result.analysed);
  EXPECT_EQ(result.diagnosis.law, Law(CoulombLaw{}));  // no Stribeck drop
  const std::vector<std::string> added = rungs(result);
  for (const char* key : {"sensor-inertia", "viscous"}) EXPECT_THAT(added, Contains(key));
  // An offset of the sensor and Coulomb friction that differs with the direction are one and the same on this record.
  const auto& ladder = result.diagnosis.ladder;
  const bool offset = std::any_of(ladder.begin(), ladder.end(), [](const Rung& rung) {
    return rung.added == "sensor-offset" || std::count(rung.equivalent.begin(), rung.equivalent.end(), "sensor-offset");
  });
  EXPECT_TRUE(offset);
  EXPECT_FALSE(std::count(added.begin(), added.end(), "stribeck-exponent"));
  EXPECT_NEAR(value_of(result, "m_s"), 95.1089, 0.02 * 95.1089);
  EXPECT_NEAR(value_of(result, "sigma"), 203.5034, 0.05 * 203.5034);
  const double forth = value_of(result, "mu_k"), ratio = value_of(result, "ratio"), b = value_of(result, "b");
  const double level = std::isfinite(ratio) ? 0.5 * forth * (1 + ratio) : forth;
  EXPECT_NEAR(level, 20.3935, 0.02 * 20.3935);
  EXPECT_NEAR(std::isfinite(ratio) ? 0.5 * forth * (1 - ratio) : b, -3.1648, 0.1 * 3.1648);
  EXPECT_NE(result.diagnosis.verdict, Verdict::sufficient);
  EXPECT_NE(result.diagnosis.verdict, Verdict::not_enough_data);
}

TEST_F(RealData, DrillStringErrorFallsAndTheRestIsSaid) {
  ReadOptions read;
  read.conditions.radius = {0.05, "command line"};
  read.columns = {{"v_r", "bit_speed_rpm"}, {"torque", "torque_on_bit_Nm"}, {"load", "none"}};
  IdentifyOptions one_law;  // two climb as high, in twice the time
  one_law.laws = {ExponentialLaw{}};
  const DiagnosedTraces alone = diagnosed("drill-string/drillstring_175.csv", read, one_law);
  ASSERT_TRUE(alone.analysed);
  EXPECT_EQ(alone.traces[0].motion.friction_kind, FrictionKind::force);
  // The end of the ladder is compared with what needs no ladder.
  EXPECT_LT(alone.diagnosis.ladder.back().held_out_rmse, error_of_straight_line(alone.traces[0]));
  // A quarter is aimed at: a plain regression on velocity, acceleration and time reaches 0.37 in sample.
  EXPECT_GE(fall(alone), 0.15);
  EXPECT_EQ(alone.diagnosis.verdict, Verdict::unexplained);
  // What is left looks like an effect that these data do not prove.
  EXPECT_TRUE(std::any_of(alone.diagnosis.effects.begin(), alone.diagnosis.effects.end(),
                          [](const EffectFinding& e) { return e.status == EffectStatus::possible; }));

  read.columns["load"] = "weight_on_bit_N";
  // Of the exponential law a bristle would take as much, but only with a stiffness at its bound, which is no name.
  const DiagnosedTraces weighted = diagnosed("drill-string/drillstring_175.csv", read);
  ASSERT_TRUE(weighted.analysed);
  EXPECT_GT(fall(weighted), 0.02);  // a tenth is aimed at
  EXPECT_EQ(weighted.diagnosis.verdict, Verdict::unexplained);
}

TEST_F(RealData, RotaryTribometerFrictionRisesWithSpeedAndNeverSticks) {
  for (const char* file : {"013_FX2_316SS_0.25in_Rotary_3N_4tests_75-300mm-s_6-15mm-radius_3min-each.csv",
                           "014_FX2_316SS_0.25in_Rotary_3N_4tests_300-75mm-s_6-15mm-radius_3min-each.csv",
                           "017_FX2_316SS_0.25in_Rotary_9N_4tests_75-300mm-s_6-15mm-radius_3min-each.csv",
                           "019_FX2_Polyimide_0.25in_Rotary_3N_4tests_75-300mm-s_6-15mm-radius_3min-each.csv"}) {
    ReadOptions read;
    read.step_radii = {0.006, 0.009, 0.012, 0.015};
    const DiagnosedTraces result = diagnosed(std::string("rotary-tribometer/") + file, read);
    ASSERT_TRUE(result.analysed) << file;
    EXPECT_EQ(result.traces[0].segmentation.kind, MotionKind::always_slipping) << file;
    const Fit& last = result.fits.back();
    const std::vector<double> p = last.values();
    const bool law_rises = friction_at_rest(last.model.law(), p) < kinetic_friction(last.model.law(), p, last.fastest);
    const bool viscous_rises =
        finding(result, "viscous").status == EffectStatus::found && value_of(result, "sigma") > 0;
    EXPECT_TRUE(law_rises || viscous_rises) << file;
    for (const char* key : {"ringing", "ageing", "contact-spin"}) {
      EXPECT_EQ(finding(result, key).status, EffectStatus::untestable) << file << ' ' << key;
    }
  }
}

}  // namespace
