#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "command.hpp"

// Records without friction and without motion, through every output.

namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// x = A sin(w t) that slows down and friction of 0.8 N: the base that goes with it, in mm.
std::string motion_table() {
  constexpr double kMass = 3, kStiffness = 1200, kFriction = 0.8, kTurn = 7, kFade = 0.05;
  std::string text = "time_s,x_b [mm],x_d [mm]\n";
  for (int i = 0; i < 8000; ++i) {
    const double t = i * 0.002, a = 2e-3 * std::exp(-kFade * t);
    const double x = a * std::sin(kTurn * t);
    const double v = a * (kTurn * std::cos(kTurn * t) - kFade * std::sin(kTurn * t));
    const double b =
        a * ((kFade * kFade - kTurn * kTurn) * std::sin(kTurn * t) - 2 * kFade * kTurn * std::cos(kTurn * t));
    const double noise = 3e-7 * std::sin(1000.3 * i);
    const double y = x + (kMass * b + std::copysign(kFriction, v)) / kStiffness;
    text += std::to_string(t) + "," + std::to_string(1e3 * (x + noise)) + "," + std::to_string(1e3 * y) + "\n";
  }
  return text;
}

TEST(KindsOfRecord, AMotionAloneGivesFrictionAgainstVelocity) {
  const Workshop shop;
  shop.write("frame.csv", motion_table());
  const Outcome outcome = shop.identify(
      "--mass 3kg --stiffness 1200N/m --law coulomb --json j.json --csv out --report r.html --figures pictures "
      "frame.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("motion-only (no friction was recorded)"), HasSubstr("level"),
                                 HasSubstr("the two levels agree"), HasSubstr("rubs on")));
  const json result = json_in(shop / "j.json");
  EXPECT_EQ(result["trace"]["kind"], "motion-only");
  EXPECT_EQ(result["conditions"]["spring"]["rubs_on"], "ground");
  ASSERT_EQ(result["friction_over_velocity"]["levels"].size(), 2);
  for (const json& level : result["friction_over_velocity"]["levels"])
    EXPECT_NEAR(level["friction"]["value"].get<double>(), 0.8, 0.02);
  for (const json& bin : result["friction_over_velocity"]["bins"])
    EXPECT_NEAR(std::abs(bin["friction"]["value"].get<double>()), 0.8, 0.05);
  EXPECT_THAT(contents(shop / "out/samples.csv"), HasSubstr("mu_std_error"));
  EXPECT_EQ(shop.identify("frame.csv").status, 3);
  EXPECT_THAT(shop.identify("frame.csv").err, HasSubstr("--mass 3.08kg --stiffness 1191N/m"));
  EXPECT_EQ(shop.identify("--mass 3kg --stiffness 1200N/m --rubs-on wall frame.csv").status, 2);
}

TEST(KindsOfRecord, FrictionAloneGivesItsSlips) {
  const Workshop shop;
  std::string text = "time_s,force [N]\n";
  for (int i = 0; i < 20000; ++i) {  // 400 samples up from 8 to 12 N, 10 down
    const int at = i % 410;
    const double force = at < 400 ? 8 + 0.01 * at : 12 - 0.4 * (at - 400);
    text += std::to_string(i * 0.001) + "," + std::to_string(force + 0.01 * std::sin(77.7 * i)) + "\n";
  }
  shop.write("cell.csv", text);
  const Outcome outcome = shop.identify("--json j.json --csv out --report r.html --figures pictures cell.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("force-only (no motion was recorded)"), HasSubstr("break-away"),
                    HasSubstr("a law needs the sliding velocity"), HasSubstr("identify columns cell.csv")));
  const json force = json_in(shop / "j.json")["force"];
  EXPECT_EQ(force["slips"], 48);
  EXPECT_NEAR(force["peak"]["mean"].get<double>(), 12, 0.02);
  EXPECT_NEAR(force["drop"]["mean"].get<double>(), 4, 0.03);
  EXPECT_NEAR(force["period_s"]["mean"].get<double>(), 0.41, 0.001);
  for (const char* verb : {"diagnose", "rig", "twin"}) {
    const Outcome other = shop.identify(std::string(verb) + " cell.csv");
    EXPECT_EQ(other.status, 1) << verb << other.err;
    EXPECT_THAT(other.out + other.err, HasSubstr("friction alone was recorded")) << verb;
  }
}

}  // namespace
