/// One fit of all samples of several runs, against known truth, by the command.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "runs.hpp"

namespace {

using ::testing::HasSubstr;

struct Truth {
  double mu_s = 0.5, mu_k = 0.311, alpha = 0.12, sigma = 0.001;  ///< v in mm/s
  double at(double v) const { return mu_k + (mu_s - mu_k) * std::exp(-alpha * v) + sigma * v; }
};

/// Friction at one steady speed, which never sticks. colour: AR(1) coefficient of the noise.
std::string steady_run(const Truth& truth, double speed, double colour, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  double noise = normal(random);
  std::string text = "time_s,mu,v_r [mm/s]\n";
  for (int i = 0; i < 4000; ++i) {
    noise = colour * noise + std::sqrt(1 - colour * colour) * normal(random);
    const double v = speed * (1 + 0.0002 * normal(random));
    text +=
        std::to_string(0.001 * i) + "," + std::to_string(truth.at(v) + 0.008 * noise) + "," + std::to_string(v) + "\n";
  }
  return text;
}

constexpr double kSlowest = 0.1;  // [mm/s]

/// Eight runs, each at a speed of its own over three decades. other: the run with another truth, if any.
void make_steady_runs(const Workshop& shop, double colour, int other = -1, double decades = 3) {
  std::filesystem::create_directory(shop / "runs");
  std::string manifest = "file,step\n";
  for (int k = 0; k < 8; ++k) {
    Truth truth;
    if (k == other) truth.mu_k *= 1.05;
    const std::string name = "s" + std::to_string(k) + ".csv";
    shop.write("runs/" + name,
               steady_run(truth, kSlowest * std::pow(10, decades * k / 7), colour, 7U + static_cast<unsigned>(k)));
    manifest += name + "," + std::to_string(k) + "\n";
  }
  shop.write("runs/manifest.csv", manifest);
}

constexpr const char* kSteady = "--kind sliding --law exponential --effect viscous runs --out res ";
constexpr const char* kShareAll = "--share mu_s --share mu_k --share alpha --share viscous.sigma";

double value_of(const nlohmann::json& fit, const std::string& name, const char* key, std::size_t level = 0) {
  for (const auto& common : fit["common"]) {
    if (common["name"] == name) return common["values"].at(level)[key].get<double>();
  }
  ADD_FAILURE() << name << " is not shared";
  return 0;
}

void expect_inside(const nlohmann::json& fit, const std::string& name, double truth, double most_error) {
  for (const auto& common : fit["common"]) {
    if (common["name"] != name) continue;
    const auto& value = common["values"][0];
    EXPECT_LE(value["ci95"][0].get<double>(), truth) << name;
    EXPECT_GE(value["ci95"][1].get<double>(), truth) << name;
    EXPECT_LT(value["std_error"].get<double>(), most_error) << name;
    EXPECT_EQ(value["runs"], 8) << name;
  }
}

class SteadyRuns : public testing::TestWithParam<double> {};

TEST_P(SteadyRuns, TogetherKnowWhatNoneKnows) {
  const Workshop shop;
  make_steady_runs(shop, GetParam());
  const Outcome outcome = shop.identify(std::string(kSteady) + kShareAll);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("8 runs fitted together, all samples; the runs allow it"));
  const auto shared = json_in(shop / "res/pooled.json")["shared"];
  ASSERT_EQ(shared.size(), 1u);
  EXPECT_EQ(shared[0]["method"], "all-samples");
  EXPECT_FALSE(shared[0]["sharing"]["refused"].get<bool>());
  const Truth truth;
  expect_inside(shared[0], "mu_s", truth.mu_s, 0.005);
  expect_inside(shared[0], "mu_k", truth.mu_k, 0.005);
  expect_inside(shared[0], "alpha", truth.alpha, 0.01);
  expect_inside(shared[0], "viscous.sigma", truth.sigma, 1e-4);
  const auto& sharing = shared[0]["sharing"];
  EXPECT_NEAR(sharing["held_out_rmse_together"].get<double>(), 0.008, 0.0003);
  // What does not know its parameters predicts no better than what does.
  EXPECT_GT(1.001 * sharing["held_out_rmse_alone"].get<double>(), sharing["held_out_rmse_together"].get<double>());
}

INSTANTIATE_TEST_SUITE_P(Noise, SteadyRuns, testing::Values(0.0, 0.8));

TEST(SharedRuns, ARunWithAnotherTruthRefutesTheSharing) {
  const Workshop shop;
  make_steady_runs(shop, 0, 5);
  const Outcome outcome = shop.identify(std::string(kSteady) + kShareAll);
  EXPECT_THAT(outcome.out, HasSubstr("the runs do not share this"));
  const auto sharing = json_in(shop / "res/pooled.json")["shared"][0]["sharing"];
  EXPECT_TRUE(sharing["refused"].get<bool>());
  EXPECT_LT(sharing["p_value"].get<double>(), 1e-4);
  EXPECT_GT(sharing["held_out_rmse_together"].get<double>(), sharing["held_out_rmse_alone"].get<double>());
}

TEST(SharedRuns, WhatTheRunsDoNotKnowIsSaid) {
  const Workshop shop;
  make_steady_runs(shop, 0, -1, 0);  // all of them at one speed
  const Outcome outcome = shop.identify(std::string(kSteady) + kShareAll);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("mu_k is not determined by these runs"));
  for (const auto& common : json_in(shop / "res/pooled.json")["shared"][0]["common"]) {
    if (common["name"] != "mu_k") continue;
    EXPECT_TRUE(common["values"][0]["std_error"].is_null());
  }
}

TEST(SharedRuns, MergedAndAgainTheyAreTheSameBytes) {
  const Workshop shop;
  make_steady_runs(shop, 0);
  const std::string options = std::string("--kind sliding --law exponential --effect viscous runs --quiet ");
  ASSERT_EQ(shop.identify(options + "--out whole " + kShareAll).status, 0);
  for (const char* shard : {"2/3", "3/3", "1/3"}) {
    ASSERT_EQ(shop.identify(options + "--out parts --threads 2 --shard " + shard).status, 0);
  }
  ASSERT_EQ(shop.identify(std::string("merge parts --quiet ") + kShareAll).status, 0);
  EXPECT_EQ(files_in(shop / "parts"), files_in(shop / "whole"));
  ASSERT_EQ(shop.identify(options + "--out whole " + kShareAll).status, 0);
  EXPECT_EQ(files_in(shop / "parts"), files_in(shop / "whole"));
}

/// Twins of one law: each run knows alpha itself, so that the single fits together know it as well.
TEST(SharedRuns, OfTwinsTheyAgreeWithTheSingleFits) {
  const Workshop shop;
  make_runs(shop, 4);  // two radii
  ASSERT_EQ(shop.identify("runs --speed 4rpm --law exponential --out res --share alpha --quiet").status, 0);
  const auto together = json_in(shop / "res/pooled.json")["shared"][0];
  EXPECT_EQ(together["method"], "all-samples");
  // Without what the runs keep of their samples the single fits are combined.
  for (const char* name : {"a1", "a2", "a3", "a4"}) {
    EXPECT_TRUE(std::filesystem::exists(shop / ("res/kept/" + std::string(name) + ".condensed.json"))) << name;
  }
  const auto single = json_in(shop / "res/summary.json")["runs"];
  double sum = 0, weights = 0, scatter = 0;
  for (const auto& run : single) {
    const auto alpha = parameter(run["fits"][0], "alpha");
    const double weight = std::pow(alpha["std_error"].get<double>(), -2);
    sum += weight * alpha["value"].get<double>();
    weights += weight;
  }
  for (const auto& run : single) {
    const auto alpha = parameter(run["fits"][0], "alpha");
    scatter += std::pow((alpha["value"].get<double>() - sum / weights) / alpha["std_error"].get<double>(), 2);
  }
  const double error = 1 / std::sqrt(weights);
  EXPECT_NEAR(value_of(together, "alpha", "value"), sum / weights, 1.5 * error);
  EXPECT_LT(value_of(together, "alpha", "std_error"), 1.5 * error * std::sqrt(std::max(1.0, scatter / 3)));
  const auto& ci = together["common"][0]["values"][0]["ci95"];
  EXPECT_LE(ci[0].get<double>(), 0.05214);
  EXPECT_GE(ci[1].get<double>(), 0.05214);
}

}  // namespace
