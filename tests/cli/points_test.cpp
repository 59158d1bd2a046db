#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "command.hpp"

// A table of steady points through every output, and the verbs that make no sense on one.

namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// Of a joint: Coulomb 1.97 N m, static 2.431 N m, decay 58.8 s/rad, viscous 0.9 N m s/rad.
std::string joint_table() {
  std::string text = "velocity [rad/s],torque [Nm]\n";
  for (int i = 0; i < 72; ++i) {
    const double w = (i % 2 == 0 ? 1 : -1) * 0.004 * std::pow(1.08, i), noise = 0.01 * std::sin(37.0 * i);
    const double torque = 1.97 + 0.461 * std::exp(-58.8 * std::abs(w)) + 0.9 * std::abs(w);
    text += std::to_string(w) + "," + std::to_string(std::copysign(torque, w) + noise) + "\n";
  }
  return text;
}

TEST(PointsCommand, ATableIsFittedAsItIs) {
  const Workshop shop;
  shop.write("joint.csv", joint_table());
  const Outcome outcome = shop.identify("--json j.json --csv out --report r.html --figures pictures joint.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out.substr(0, outcome.out.find('\n')), HasSubstr("joint.csv: points (no time column)"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("-cycle")));
  const json j = json_in(shop / "j.json");
  EXPECT_EQ(j["trace"]["kind"], "points");
  EXPECT_TRUE(j["trace"]["duration_s"].is_null());
  const json& best = j["fits"][j["best"].get<std::size_t>()];
  EXPECT_EQ(best["effects"], json({"viscous"}));
  EXPECT_NEAR(parameter(best, "mu_k")["value"].get<double>(), 1.97, 0.02);
  EXPECT_NEAR(parameter(best, "mu_s")["value"].get<double>(), 2.431, 0.05);
  EXPECT_NEAR(parameter(best, "alpha")["value"].get<double>(), 0.0588, 0.01);
  EXPECT_THAT(contents(shop / "out/samples.csv"), HasSubstr("\n,"));  // no time
  EXPECT_THAT(contents(shop / "r.html"), HasSubstr("measured, backwards"));
  EXPECT_THAT(shop.identify("--kind sliding --rate 1Hz joint.csv").out, HasSubstr("joint.csv: sliding (stated)"));
}

TEST(PointsCommand, ATableIsDiagnosed) {
  const Workshop shop;
  shop.write("joint.csv", joint_table());
  const Outcome outcome = shop.identify("diagnose --json j.json --csv out --report r.html joint.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("points (no time column)"));
  const json j = json_in(shop / "j.json");
  EXPECT_EQ(j["diagnosis"]["ladder"][1]["added"], "viscous");
}

TEST(PointsCommand, VerbsThatNeedAMotionSaySo) {
  const Workshop shop;
  shop.write("joint.csv", joint_table());
  for (const char* verb : {"rig --load 5N", "twin --load 5N", "study speed --load 5N", "explore"}) {
    const Outcome outcome = shop.identify(std::string(verb) + " joint.csv");
    EXPECT_NE(outcome.status, 0) << verb;
    EXPECT_THAT(outcome.err, HasSubstr("points")) << verb;
  }
  EXPECT_EQ(shop.identify("--kind points --stick-below 1mm/s joint.csv").status, 2);
  EXPECT_EQ(shop.identify("--never-sticks --kind points joint.csv").status, 2);
  EXPECT_EQ(shop.identify("--kind circles joint.csv").status, 2);
  EXPECT_THAT(shop.identify("columns joint.csv").out, HasSubstr("identify --columns"));
}

}  // namespace
