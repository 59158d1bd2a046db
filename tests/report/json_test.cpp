#include "tribofit/report/json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "made_up.hpp"

namespace tribofit {
namespace {

using nlohmann::json;

json written_as_json(const Identification& result) {
  return json::parse(to_json(result, {{"--radius", "15mm"}}));
}

std::vector<std::string> keys(const json& object) {
  std::vector<std::string> names;
  for (const auto& [key, value] : object.items()) names.push_back(key);
  return names;
}

TEST(Json, HasTheAgreedNames) {
  const json j = written_as_json(made_up_result());
  using ::testing::IsSupersetOf;
  EXPECT_THAT(keys(j),
              IsSupersetOf({"tool", "trace", "conditions", "health", "stick_slip", "fits", "best", "warnings"}));
  EXPECT_THAT(keys(j["tool"]), IsSupersetOf({"name", "version"}));
  EXPECT_THAT(keys(j["trace"]), IsSupersetOf({"path", "samples", "duration_s", "rate_hz"}));
  EXPECT_THAT(keys(j["conditions"]), IsSupersetOf({"radius_mm", "speed_rpm", "speed_source", "load_N"}));
  EXPECT_THAT(keys(j["health"][0]), IsSupersetOf({"check", "status", "message"}));
  EXPECT_THAT(keys(j["stick_slip"]),
              IsSupersetOf({"cycles", "frequency_hz", "amplitude_mm_s", "rms_velocity_mm_s", "stick_time_s"}));
  EXPECT_THAT(keys(j["fits"][0]), IsSupersetOf({"law", "protocol", "effects", "parameters", "error", "floor_rmse",
                                                "converged", "messages"}));
  EXPECT_THAT(keys(j["fits"][0]["parameters"][0]),
              IsSupersetOf({"name", "value", "std_error", "ci95", "unit", "effect"}));
  EXPECT_THAT(keys(j["fits"][0]["error"]), IsSupersetOf({"rmse", "mean_relative", "max_relative", "held_out_rmse"}));
}

TEST(Json, ConvertsFromSiToTheUnitsItNames) {
  const json j = written_as_json(made_up_result());
  const json& alpha = j["fits"][0]["parameters"][2];
  EXPECT_EQ(alpha["name"], "alpha");
  EXPECT_EQ(alpha["unit"], "s/mm");
  EXPECT_NEAR(alpha["value"].get<double>(), 0.05214, 1e-15);  // 52.14 s/m
  EXPECT_NEAR(alpha["std_error"].get<double>(), 0.00043, 1e-15);
  EXPECT_NEAR(alpha["ci95"][0].get<double>(), 0.05128, 1e-15);
  EXPECT_NEAR(alpha["ci95"][1].get<double>(), 0.053, 1e-15);
  EXPECT_TRUE(alpha["effect"].is_null());
  EXPECT_EQ(j["fits"][1]["parameters"][2]["name"], "beta");
  EXPECT_NEAR(j["conditions"]["radius_mm"].get<double>(), 15, 1e-12);
  EXPECT_NEAR(j["conditions"]["speed_rpm"].get<double>(), 4, 1e-12);
  EXPECT_EQ(j["conditions"]["speed_source"], "plateau");
  EXPECT_NEAR(j["stick_slip"]["amplitude_mm_s"].get<double>(), 83.9, 1e-12);
  EXPECT_NEAR(j["stick_slip"]["rms_velocity_mm_s"].get<double>(), 19.1, 1e-12);
  EXPECT_NEAR(j["stick_slip"]["stick_time_s"].get<double>(), 0.1754, 1e-12);
  EXPECT_EQ(j["stick_slip"]["cycles"], 2);
  const json& frequency = j["stick_slip"]["frequency_hz"];
  EXPECT_EQ(frequency["value"], 4.883);
  EXPECT_LT(frequency["ci95"][0].get<double>(), 4.883 - 0.012);
  EXPECT_GT(frequency["ci95"][1].get<double>(), 4.883 + 0.012);
  EXPECT_EQ(j["trace"]["samples"], 2400000);
  EXPECT_EQ(j["trace"]["rate_hz"], 20000.0);
}

TEST(Json, WhatIsNotKnownIsNull) {
  Identification result = made_up_result();
  result.fits[0].error.held_out_rmse = std::numeric_limits<double>::quiet_NaN();
  const json j = written_as_json(result);
  EXPECT_TRUE(j["conditions"]["load_N"].is_null());
  EXPECT_TRUE(j["fits"][0]["error"]["held_out_rmse"].is_null());
  EXPECT_TRUE(j["fits"][0]["parameters"][0]["profile_ci95"][0].is_null());
  EXPECT_TRUE(j["fits"][0]["parameters"][0]["systematic_error"].is_null());  // nothing declared
  result.fits[0].parameters[0].systematic = 0.005;
  EXPECT_EQ(written_as_json(result)["fits"][0]["parameters"][0]["systematic_error"], 0.005);
}

TEST(Json, HoldsBothProtocolsAndPointsAtTheBest) {
  const json j = written_as_json(made_up_result());
  ASSERT_EQ(j["fits"].size(), 3u);
  EXPECT_EQ(j["fits"][0]["protocol"], "joint");
  EXPECT_EQ(j["fits"][2]["protocol"], "published");
  EXPECT_EQ(j["best"], 0);
  EXPECT_EQ(j["tool"]["arguments"], json({"--radius", "15mm"}));
}

TEST(Json, EffectsCarryTheirKey) {
  Identification result = made_up_result();
  Fit& fit = result.fits[0];
  fit.model = FrictionModel(ExponentialLaw{}, {make_effect("viscous")});
  fit.parameters.push_back(made_up_parameter(fit.model, 3, 0.5, 0.1));
  const json j = written_as_json(result);
  EXPECT_EQ(j["fits"][0]["effects"], json({"viscous"}));
  EXPECT_EQ(j["fits"][0]["parameters"][3]["effect"], "viscous");
  EXPECT_NEAR(j["fits"][0]["parameters"][3]["value"].get<double>(), 0.0005, 1e-15);  // 0.5 s/m
}

TEST(Json, FrictionAsAForceIsInNewtons) {
  Identification result = made_up_result();
  result.motion.friction_kind = FrictionKind::force;
  const json j = written_as_json(result);
  EXPECT_EQ(j["trace"]["friction_unit"], "N");
  EXPECT_EQ(j["fits"][0]["parameters"][0]["unit"], "N");
  EXPECT_EQ(j["fits"][0]["parameters"][2]["unit"], "s/mm");
}

TEST(Json, ATraceThatCouldNotBeAnalysedIsStillOneObject) {
  Identification result = made_up_result();
  result.fits.clear();
  result.analysed = false;
  result.warnings = {"fewer than three cycles"};
  const json j = written_as_json(result);
  EXPECT_TRUE(j["best"].is_null());
  EXPECT_EQ(j["fits"].size(), 0u);
  EXPECT_EQ(j["warnings"][0], "fewer than three cycles");
}

TEST(Json, AFileNameThatIsNotUtf8DoesNotBreakIt) {
  Identification result = made_up_result();
  result.path = "r\xe9sultat.csv";
  // Read again, so it is valid; the byte is replaced by U+FFFD.
  EXPECT_EQ(written_as_json(result)["trace"]["path"], "r\xef\xbf\xbdsultat.csv");
}

}  // namespace
}  // namespace tribofit
