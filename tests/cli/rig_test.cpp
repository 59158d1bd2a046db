#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "command.hpp"

namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// The lines of a trace with the velocity column made by `expression` of awk, where $3 is v_b [mm/s].
std::string with_velocity(const std::string& name, const std::string& expression) {
  return "awk -F, 'NR==1 {print \"time_s,mu," + name + "\"; next} {print $1 \",\" $2 \",\" (" + expression +
         ")}' trace.csv > made.csv";
}

TEST(RigCommand, GivesTheRigAndNamesTheTwin) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome outcome = shop.identify("rig --radius 15mm --load 50N --json rig.json trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("m - m_s"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  identify twin --radius 15mm --load 50N trace.csv\n"));
  const json j = json_in(shop / "rig.json");
  const json& rig = j["rig"];
  EXPECT_TRUE(rig["determined"]);
  EXPECT_NEAR(rig["mass_kg"]["value"], 0.85, 0.0085);
  EXPECT_NEAR(rig["stiffness_N_per_mm"]["value"], 16.2, 0.162);
  EXPECT_NEAR(rig["damping_N_s_per_mm"]["value"], 0.004694, 0.00047);
  EXPECT_NEAR(rig["natural_frequency_hz"]["value"], 21.97, 0.1);
  EXPECT_NEAR(rig["damping_ratio"]["value"], 0.02, 0.002);
  EXPECT_NEAR(rig["stick_slope_stiffness_N_per_mm"]["value"], 16.2, 0.162);
  for (const char* key : {"mass_kg", "damping_N_s_per_mm", "stiffness_N_per_mm"}) {
    EXPECT_LT(rig[key]["ci95"][0], rig[key]["value"]) << key;
    EXPECT_GT(rig[key]["ci95"][1], rig[key]["value"]) << key;
    EXPECT_GT(rig[key]["std_error"], 0) << key;
  }
  EXPECT_EQ(rig["covariance"].size(), 3u);
  const double error = rig["mass_kg"]["std_error"];
  EXPECT_NEAR(rig["covariance"][0][0], error * error, 1e-6 * error * error);
}

TEST(RigCommand, WithoutALoadTheValuesArePerNewton) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome outcome = shop.identify("rig --radius 15mm --json - trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json rig = json::parse(outcome.out)["rig"];
  EXPECT_TRUE(rig["per_unit_load"]);
  EXPECT_FALSE(rig.contains("mass_kg"));
  EXPECT_NEAR(rig["mass_kg_per_N"]["value"], 0.85 / 50, 0.01 * 0.85 / 50);
  EXPECT_NEAR(rig["stiffness_per_mm"]["value"], 16.2 / 50, 0.01 * 16.2 / 50);
}

TEST(RigCommand, AHighPassThatIsKeptSpoilsTheDampingAndIsNamed) {
  const Workshop shop;
  shop.identify(
      "simulate --radius 15mm --duration 5s --rate 5kHz --noise-mu 0.003 --noise-v 0.02mm/s --high-pass 0.5Hz "
      "--out trace.csv --quiet");
  const Outcome undone = shop.identify("rig --radius 15mm --load 50N --json undone.json trace.csv");
  EXPECT_EQ(undone.status, 0) << undone.err;
  EXPECT_NEAR(json_in(shop / "undone.json")["rig"]["damping_ratio"]["value"], 0.02, 0.002);
  const Outcome kept = shop.identify("rig --radius 15mm --load 50N --keep-high-pass --json kept.json trace.csv");
  EXPECT_EQ(kept.status, 1);
  EXPECT_THAT(kept.err, HasSubstr("high-pass"));
  const json rig = json_in(shop / "kept.json")["rig"];
  EXPECT_FALSE(rig["determined"]);
  EXPECT_LT(rig["damping_ratio"]["value"], 0);
  EXPECT_NEAR(rig["high_pass_hz"]["value"], 0.5, 0.02);
  EXPECT_THAT(kept.out, HasSubstr("\n  identify rig --radius 15mm --load 50N trace.csv\n"));
}

TEST(RigCommand, RelativeVelocityAlone) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.shell(with_velocity("v_r [mm/s]", "6.2831853 - $3"));
  const Outcome outcome = shop.identify("rig --load 50N --json - made.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const json rig = json::parse(outcome.out)["rig"];
  EXPECT_NEAR(rig["mass_kg"]["value"], 0.85, 0.0085);
  EXPECT_TRUE(rig["stick_slope_stiffness_N_per_mm"].is_null());
}

TEST(RigCommand, WhatCannotBeHadIsSaidWithStatusOne) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.shell("head -600 trace.csv > sticks.csv");
  const Outcome sticks = shop.identify("rig --radius 15mm --load 50N --json s.json sticks.csv");
  EXPECT_EQ(sticks.status, 1);
  EXPECT_THAT(sticks.err, HasSubstr("never slips"));
  const json rig = json_in(shop / "s.json")["rig"];
  EXPECT_TRUE(rig["mass_kg"].is_null());
  EXPECT_NEAR(rig["stiffness_N_per_mm"]["value"], 16.2, 1);
  shop.shell(
      "awk -F, 'NR==1 {print \"time_s,mu,speed [rpm]\"; next} {print $1 \",\" $2 \",4\"}' trace.csv > fixed.csv");
  const Outcome fixed = shop.identify("rig --radius 15mm --load 50N fixed.csv");
  EXPECT_EQ(fixed.status, 1);
  EXPECT_THAT(fixed.err, HasSubstr("stands still"));
}

TEST(RigCommand, BadInputIsRefused) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  for (const char* load : {"0N", "-5N", "50mm"}) {
    const Outcome outcome = shop.identify(std::string("rig --radius 15mm --load ") + load + " trace.csv");
    EXPECT_EQ(outcome.status, 3) << load;
    EXPECT_THAT(outcome.err, HasSubstr("--load")) << load;
  }
  EXPECT_EQ(shop.identify("rig").status, 2);
  EXPECT_EQ(shop.identify("rig trace.csv trace.csv").status, 2);
  EXPECT_EQ(shop.identify("rig --json trace.csv trace.csv").status, 2);
  EXPECT_EQ(shop.identify("rig nothing.csv").status, 3);
  EXPECT_EQ(contents(shop / "trace.csv"), good_trace());
}

}  // namespace
