#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "command.hpp"

// Records of rock laboratories, from the file through every output.

namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr const char* kSimulated =
    "simulate --kind velocity-steps --rate 20Hz --duration 140s --speed-steps 0s:2um/s,60s:20um/s,80s:2um/s "
    "--rate-state a=0.01,b=0.014,D_c=10um,k=0.002/um --noise-mu 0.0002 --evolution slip --out steps.csv";

/// Of the best fit.
double best_value(const json& result, const std::string& name) {
  return parameter(result["fits"][result["best"].get<std::size_t>()], name)["value"];
}

/// The simulated record in other columns. row: makes a line of time, displacement and friction, as they are written.
template <class Row>
std::string in_other_columns(const Workshop& shop, const std::string& header, Row&& row) {
  std::string text = header + "\n";
  const std::vector<std::string> lines = lines_of(contents(shop / "steps.csv"));
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const std::size_t first = lines[i].find(','), second = lines[i].rfind(',');
    text += row(lines[i].substr(0, first), lines[i].substr(first + 1, second - first - 1),
                std::stod(lines[i].substr(second + 1))) +
            "\n";
  }
  return text;
}

TEST(VelocitySteps, AreSimulatedReadFittedAndReported) {
  const Workshop shop;
  ASSERT_EQ(shop.identify(kSimulated).status, 0);
  const Outcome outcome = shop.identify("--json j.json --csv out --report r.html --figures pictures steps.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("velocity-steps (the motion of a load point was"),
                                 HasSubstr("2 um/s, 20 um/s, 2 um/s"), HasSubstr("Slip law, 2 steps together (best)"),
                                 HasSubstr("k_c = (b - a)/D_c"), HasSubstr("times as stiff")));
  const json result = json_in(shop / "j.json");
  EXPECT_EQ(result["trace"]["kind"], "velocity-steps");
  EXPECT_EQ(result["fits"][result["best"].get<std::size_t>()]["law"], "rate-state-slip");
  EXPECT_NEAR(best_value(result, "a"), 0.01, 3e-4);
  EXPECT_NEAR(best_value(result, "b"), 0.014, 4e-4);
  EXPECT_NEAR(best_value(result, "D_c"), 10, 0.5);
  EXPECT_NEAR(best_value(result, "k"), 0.002, 1e-4);
  EXPECT_EQ(result["rate_state"]["steps"].size(), 2U);
  EXPECT_NEAR(result["rate_state"]["steps"][0]["time_s"].get<double>(), 60, 2e-3);
  EXPECT_THAT(contents(shop / "out/steps.csv"),
              HasSubstr("step_number,time_s,time_std_error_s,recorded_time_s,from_um_s,to_um_s,hold_s,a,a_std_error"));
  EXPECT_THAT(contents(shop / "out/response.csv"), HasSubstr("step_number,time_s,load_point_um,mu,mu_model,mu_other"));
  EXPECT_THAT(contents(shop / "pictures/t1-response.svg"), HasSubstr("displacement of the load point"));
}

TEST(VelocitySteps, StressesAndStatedSpeedsGiveTheSame) {
  const Workshop shop;
  ASSERT_EQ(shop.identify(kSimulated).status, 0);
  const auto row = [](const std::string& time, const std::string&, double mu) {
    return time + "," + std::to_string(mu * 25) + ",25";
  };
  const std::string text = in_other_columns(shop, "Time (s),Shear Stress (MPa),Normal Stress (MPa)", row);
  shop.write("stress.csv", text);
  const Outcome outcome =
      shop.identify("--speed 0s:2um/s,60s:20um/s,80s:2um/s --evolution slip --json j.json stress.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("25 MPa"), HasSubstr("mu is shear stress over the measured normal stress")));
  EXPECT_NEAR(best_value(json_in(shop / "j.json"), "D_c"), 10, 0.5);
  const Outcome held = shop.identify(
      "--speed 0s:2um/s,60s:20um/s,80s:2um/s --evolution slip --bounds k=0.002..0.002/um --json j.json stress.csv");
  ASSERT_EQ(held.status, 0) << held.err;
  EXPECT_NEAR(best_value(json_in(shop / "j.json"), "k"), 0.002, 1e-12);
}

// A drive that takes its time from one speed to the other, and goes back to where it began at the end of the test.
TEST(VelocitySteps, RampsAreNoStepsAndTheWayBackIsLeftOut) {
  const Workshop shop;
  ASSERT_EQ(shop.identify("simulate --kind velocity-steps --rate 20Hz --duration 140s --speed-steps "
                          "0s:2um/s,60s:9um/s,60.8s:20um/s,80s:8um/s,80.8s:2um/s --rate-state "
                          "a=0.01,b=0.014,D_c=10um,k=0.002/um --noise-mu 0.0002 --out steps.csv")
                .status,
            0);
  std::string text = contents(shop / "steps.csv");
  for (int i = 0; i < 100; ++i)
    text += std::to_string(140 + 0.05 * i) + "," + std::to_string(600 - 6 * i) + "," + std::to_string(0.5) + "\n";
  shop.write("back.csv", text);
  const Outcome outcome = shop.identify("--evolution ageing --detrend displacement --json j.json back.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("load point        2 um/s, 20 um/s, 2 um/s"), HasSubstr("turns round")));
  const json result = json_in(shop / "j.json");
  EXPECT_EQ(result["rate_state"]["steps"].size(), 2U);
  EXPECT_NEAR(best_value(result, "a"), 0.01, 3e-4);
  EXPECT_NEAR(best_value(result, "D_c"), 10, 0.5);
}

TEST(VelocitySteps, HoldsAreRecognised) {
  const Workshop shop;
  ASSERT_EQ(shop.identify("simulate --kind slide-hold-slide --rate 10Hz --duration 300s --speed-steps "
                          "0s:10um/s,20s:0,23s:10um/s,43s:0,53s:10um/s,73s:0,103s:10um/s,123s:0,223s:10um/s "
                          "--rate-state a=0.01,b=0.012,D_c=5um,k=0.002/um --noise-mu 0.0002 --out holds.csv")
                .status,
            0);
  const Outcome outcome = shop.identify("--json j.json holds.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("slide-hold-slide"), HasSubstr("Healing rate")));
  const json result = json_in(shop / "j.json");
  ASSERT_EQ(result["rate_state"]["healing"]["holds"].size(), 4U);
  EXPECT_NEAR(result["rate_state"]["healing"]["holds"][3]["hold_s"].get<double>(), 100, 0.1);
  EXPECT_GT(result["rate_state"]["healing"]["per_decade"]["value"].get<double>(), 0.003);
}

/// The file says by itself that it is of velocity steps, and only then has k a meaning.
TEST(VelocitySteps, ValuesAreGivenWithoutTheKind) {
  const Workshop shop;
  ASSERT_EQ(shop.identify(kSimulated).status, 0);
  ASSERT_EQ(shop.identify("--bounds k=0.002..0.002/um --start D_c=20um --json k.json steps.csv").status, 0);
  const json held = json_in(shop / "k.json")["fits"][0]["parameters"].back();
  EXPECT_EQ(held["name"], "k");
  EXPECT_NEAR(held["value"].get<double>(), 0.002, 1e-12);
  shop.write("sliding.csv", [] {
    std::string text = "time_s,mu,v_r_mm_s\n";
    for (int i = 0; i < 200; ++i)
      text += std::to_string(0.1 * i) + (i % 7 < 3 ? ",0.6," : ",0.605,") + std::to_string(1 + i / 20) + "\n";
    return text;
  }());
  const Outcome other = shop.identify("--never-sticks --bounds k=0.002..0.002/um sliding.csv");
  EXPECT_NE(other.status, 0);
  EXPECT_THAT(other.err, HasSubstr("k is a parameter of velocity steps and holds"));
  EXPECT_NE(shop.identify("diagnose --never-sticks --bounds k=0.002..0.002/um sliding.csv").status, 0);
  // Names that a formula has are its own.
  const Outcome formula =
      shop.identify("--never-sticks --formula 'more = k*v; k=0.001' --bounds more.k=-1..1 sliding.csv");
  EXPECT_EQ(formula.status, 0) << formula.err;
  EXPECT_EQ(shop.identify("--kind sliding --bounds k=0.002..0.002/um sliding.csv").status, 2);
}

/// Without a normal force a, b and k are those of a coefficient times it.
TEST(VelocitySteps, FrictionInNewtonsHasParametersInNewtons) {
  const Workshop shop;
  ASSERT_EQ(shop.identify(kSimulated).status, 0);
  const auto row = [](const std::string& time, const std::string& displacement, double mu) {
    return time + "," + std::to_string(mu * 50) + "," + displacement;
  };
  const std::string text = in_other_columns(shop, "time_s,Ft [N],lp_disp_um", row);
  shop.write("newtons.csv", text);
  const Outcome outcome = shop.identify("--json j.json --bounds k=0.1..0.1N/um newtons.csv");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("N/um"));
  const json result = json_in(shop / "j.json");
  EXPECT_NEAR(best_value(result, "a"), 50 * 0.01, 50 * 3e-4);
  EXPECT_DOUBLE_EQ(best_value(result, "k"), 0.1);
  EXPECT_EQ(parameter(result["fits"][0], "a")["unit"], "N");
  const Outcome refused = shop.identify("--bounds k=0.1..0.1N/um steps.csv");
  EXPECT_EQ(refused.status, 3);
  EXPECT_THAT(refused.err, HasSubstr("friction is a coefficient"));
}

TEST(VelocitySteps, WhatCannotBeDoneIsSaid) {
  const Workshop shop;
  ASSERT_EQ(shop.identify(kSimulated).status, 0);
  shop.write("bare.csv", "time_s,mu\n0,0.6\n1,0.61\n2,0.6\n3,0.61\n");
  EXPECT_THAT(shop.identify("--kind velocity-steps bare.csv").err, HasSubstr("load point"));
  EXPECT_EQ(shop.identify("--kind velocity-steps --speed 2um/s steps.csv").status, 2);
  EXPECT_EQ(shop.identify("--speed 0s:2um/s,0s:3um/s steps.csv").status, 2);
  for (const char* bare : {"--speed 0:2,60:20", "--speed 0s:2um/s,60s:20", "--start D_c=10", "--bounds k=0.001..0.004",
                           "--reference-speed 1"}) {
    const Outcome outcome = shop.identify(std::string(bare) + " --kind velocity-steps steps.csv");
    EXPECT_EQ(outcome.status, 2) << bare;
    EXPECT_THAT(outcome.err, HasSubstr("has no unit")) << bare;
  }
  EXPECT_EQ(shop.identify("--kind sliding --speed 0s:2um/s,9s:3um/s steps.csv").status, 2);
  const Outcome unused = shop.identify("--loss huber --law coulomb --cycles 0..3 --starts 9 steps.csv");
  EXPECT_EQ(unused.status, 2);
  EXPECT_THAT(unused.err, HasSubstr("means nothing for a record of the kind velocity-steps"));
  const Outcome early = shop.identify("--to 50s steps.csv");
  EXPECT_EQ(early.status, 1);
  EXPECT_THAT(early.err, HasSubstr("no step"));
  const Outcome diagnosed = shop.identify("diagnose steps.csv");
  EXPECT_EQ(diagnosed.status, 1);
  EXPECT_THAT(diagnosed.out + diagnosed.err, HasSubstr("has no cycles"));
  shop.write("half.csv", "time_s,Shear Stress (MPa),lp_disp_um\n0,15,0\n1,15,2\n2,15,4\n3,15,6\n");
  EXPECT_THAT(shop.identify("half.csv").err, HasSubstr("needs the normal stress"));
  shop.write("back.csv", [] {
    std::string text = "time_s,mu,lp_disp_um\n";
    for (int i = 0; i < 60; ++i)
      text += std::to_string(i) + ",0.6," + std::to_string(i < 30 ? 2 * i : 120 - 2 * i) + "\n";
    return text;
  }());
  EXPECT_THAT(shop.identify("back.csv").err, HasSubstr("turns round"));
  const Outcome soft = shop.identify(
      "simulate --kind velocity-steps --rate 20Hz --duration 140s --speed-steps 0s:2um/s,60s:20um/s --rate-state "
      "k=0.00001/um --out soft.csv");
  EXPECT_EQ(soft.status, 3);
  EXPECT_THAT(soft.err, HasSubstr("runs away"));
}

}  // namespace
