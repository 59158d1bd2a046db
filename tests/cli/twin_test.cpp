#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "command.hpp"

namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TEST(TwinCommand, ATwinOfAPlainTraceAgreesAndHandsOverToTheStudy) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  const Outcome outcome = shop.identify("twin --radius 15mm --load 50N --json t.json trace.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("moves as the record does"));
  EXPECT_THAT(outcome.out, HasSubstr("\n  identify study speed --radius 15mm --load 50N trace.csv\n"));
  const json j = json_in(shop / "t.json");
  const json& twin = j["twin"];
  EXPECT_EQ(twin["columns"], json::array({"exponential"}));
  ASSERT_EQ(twin["measures"].size(), 13u);
  const json& period = twin["measures"][0];
  EXPECT_EQ(period["name"], "period");
  EXPECT_EQ(period["unit"], "ms");
  EXPECT_NEAR(period["measured"]["value"], 205, 10);
  EXPECT_GT(period["measured"]["std_error"], 0);
  ASSERT_EQ(period["simulated"].size(), 1u);
  EXPECT_LT(std::abs(period["simulated"][0]["difference_in_std_errors"].get<double>()), 4);
  EXPECT_LT(twin["rms_difference"][0], 2);
  EXPECT_EQ(twin["next"], "identify study speed --radius 15mm --load 50N trace.csv");
  EXPECT_TRUE(j["rig"]["determined"]);
}

TEST(TwinCommand, AHiddenEffectShowsAndFallsWhenItIsAdded) {
  const Workshop shop;
  shop.identify(
      "simulate --radius 15mm --duration 8s --rate 5kHz --noise-mu 0.003 --noise-v 0.02mm/s --scatter 0.004 "
      "--effect frictional-lag:tau=2ms --out trace.csv --quiet");
  const Outcome bare = shop.identify("twin --radius 15mm --load 50N trace.csv");
  ASSERT_EQ(bare.status, 0) << bare.err;
  EXPECT_THAT(bare.out, HasSubstr("fails in"));
  EXPECT_THAT(bare.out, HasSubstr("\n  identify diagnose --radius 15mm --load 50N trace.csv\n"));
  const Outcome both = shop.identify("twin --radius 15mm --load 50N --effect frictional-lag --json - trace.csv");
  ASSERT_EQ(both.status, 0) << both.err;
  const json twin = json::parse(both.out)["twin"];
  EXPECT_EQ(twin["columns"], json::array({"exponential", "exponential + frictional-lag"}));
  EXPECT_GT(twin["rms_difference"][0], 5);
  EXPECT_LT(twin["rms_difference"][1], 2);
  EXPECT_FALSE(twin["failures"][0].empty());
}

TEST(TwinCommand, WhatCannotBeHadIsSaidWithStatusOne) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  shop.shell("head -600 trace.csv > sticks.csv");
  const Outcome sticks = shop.identify("twin --radius 15mm --load 50N --json s.json sticks.csv");
  EXPECT_EQ(sticks.status, 1);
  EXPECT_THAT(sticks.err, HasSubstr("never slips"));
  EXPECT_TRUE(json_in(shop / "s.json")["twin"]["columns"].empty());
  const Outcome nowhere = shop.identify("twin --load 50N trace.csv");
  EXPECT_EQ(nowhere.status, 1);
  EXPECT_THAT(nowhere.err, HasSubstr("--radius"));
  shop.shell(
      "awk -F, 'NR==1 {print \"time_s,mu,v_r [mm/s]\"; next} {print $1 \",\" $2 \",\" (6.2831853 - $3)}' "
      "trace.csv > relative.csv");
  const Outcome relative = shop.identify("twin --radius 15mm --load 50N relative.csv");
  EXPECT_EQ(relative.status, 1);
  EXPECT_THAT(relative.err, HasSubstr("--speed"));
  EXPECT_EQ(shop.identify("twin --radius 15mm --speed 4rpm --load 50N relative.csv").status, 0);
}

TEST(TwinCommand, BadInputIsRefused) {
  const Workshop shop;
  shop.write("trace.csv", good_trace());
  EXPECT_EQ(shop.identify("twin --radius 15mm --load 0N trace.csv").status, 3);
  EXPECT_EQ(shop.identify("twin --radius 15mm --load -5N trace.csv").status, 3);
  EXPECT_EQ(shop.identify("twin --radius 15mm --effect nothing trace.csv").status, 2);
  EXPECT_EQ(shop.identify("twin").status, 2);
  EXPECT_EQ(shop.identify("twin trace.csv trace.csv").status, 2);
  EXPECT_EQ(shop.identify("twin nothing.csv").status, 3);
}

}  // namespace
