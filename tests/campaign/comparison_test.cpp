/// A simulated campaign with known truth, put beside tables.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "runs.hpp"

namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Three repeats at 9 and 15 mm by the exponential law of Table 4, made once.
class Comparison : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shop_ = new Workshop;
    std::filesystem::create_directory(*shop_ / "runs");
    for (const char* radius : {"9", "15"}) {
      for (int k = 1; k <= 3; ++k) {
        shop_->identify(std::string("simulate --radius ") + radius +
                        "mm --speed 4rpm --duration 8s --rate 5kHz --noise-mu "
                        "0.003 --noise-v 0.02mm/s --scatter 0.004 --quiet --seed " +
                        std::to_string(10 * k) + " --out runs/r" + radius + "mm_" + std::to_string(k) + ".csv");
      }
    }
    shop_->write("table.csv",
                 "radius_mm,mu_s,mu_k,alpha_s_per_mm,fundamental_amplitude\n"
                 "9,0.521,0.388,0.03237,1.284\n12,0.512,0.375,0.04161,1.526\n15,0.509,0.318,0.05214,2.64\n");
  }
  static void TearDownTestSuite() {
    delete shop_;
    shop_ = nullptr;
  }
  static std::string batch(const std::string& more) {
    return "runs --load 50N --speed 4rpm --pattern 'r{radius}mm_{repeat}.csv' " + more;
  }
  static Workshop* shop_;
};
Workshop* Comparison::shop_ = nullptr;

TEST_F(Comparison, TheTruthIsFoundBesideIt) {
  const Outcome outcome = shop_->identify(batch("--out res --compare table.csv"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Beside table.csv"));
  EXPECT_THAT(outcome.out, HasSubstr("fundamental_amplitude is not a parameter"));
  EXPECT_THAT(outcome.out, HasSubstr("line 3: there are no runs of 12 mm"));
  EXPECT_THAT(outcome.out, HasSubstr("all: exponential in 6 of 6 runs"));
  const auto json = json_in(*shop_ / "res/summary.json");
  int joint = 0, inside = 0;
  for (const auto& value : json["comparison"]["values"]) {
    if (value["law"] != "exponential" || value["protocol"] != "joint") continue;
    ++joint;
    inside += value["earlier_inside_ci95"].get<bool>() ? 1 : 0;
    const double limit = value["conditions"]["radius_mm"] < 10.0 ? 2 : 1;
    EXPECT_LT(std::abs(value["difference_percent"].get<double>()), limit) << value.dump();
  }
  EXPECT_EQ(joint, 6);
  EXPECT_GE(inside, 4);
  EXPECT_EQ(lines_of(contents(*shop_ / "res/comparison.csv")).size(), 1 + json["comparison"]["values"].size());
}

TEST_F(Comparison, TheLawThatPredictsBetterIsTestedOverRuns) {
  ASSERT_EQ(shop_->identify(batch("--out res --quiet --compare table.csv")).status, 0);
  const auto json = json_in(*shop_ / "res/summary.json");
  double sum = 0;
  for (const auto& run : json["runs"]) {
    double exponential = 0, fractional = 0;
    for (const auto& fit : run["fits"]) {
      if (fit["protocol"] != "joint") continue;
      (fit["law"] == "exponential" ? exponential : fractional) = fit["error"]["held_out_rmse"].get<double>();
    }
    sum += std::log(fractional / exponential);
  }
  const auto& overall = json["comparison"]["law_preference"]["overall"];
  EXPECT_EQ(overall["better"], "exponential");
  EXPECT_NEAR(overall["ratio"].get<double>(), std::exp(sum / 6), 1e-9);
  EXPECT_LT(overall["p_value"].get<double>(), 0.05);
  ASSERT_EQ(json["comparison"]["law_preference"]["by_conditions"].size(), 2u);
  ASSERT_EQ(json["comparison"]["relative_error"].size(), 8u);  // radii, laws, protocols
  for (const auto& error : json["comparison"]["relative_error"]) {
    EXPECT_GT(error["share_below_0.08"].get<double>(), 0.99);
    EXPECT_EQ(error["share_of_bins_below_0.08"], 1.0);
  }
}

TEST_F(Comparison, BatchAndMergeWriteTheSameBytesWithAndWithoutIt) {
  ASSERT_EQ(shop_->identify(batch("--out res --quiet --compare table.csv")).status, 0);
  const auto with = files_in(*shop_ / "res");
  EXPECT_TRUE(with.count("comparison.csv") == 1 && with.count("figures/12-relative-error.csv") == 1);
  ASSERT_EQ(shop_->identify("merge res --quiet").status, 0);
  const auto without = files_in(*shop_ / "res");
  EXPECT_EQ(without.at("comparison.csv"), with.at("comparison.csv")) << "what --compare wrote stays";
  EXPECT_EQ(without.size(), with.size());
  EXPECT_FALSE(json_in(*shop_ / "res/summary.json").contains("comparison"));
  const Outcome outcome = shop_->identify("merge res --compare table.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Beside table.csv"));
  EXPECT_EQ(files_in(*shop_ / "res"), with);
}

TEST_F(Comparison, ABadTableIsNamedAndTheFitsAreKept) {
  shop_->write("bad.csv", "radius_mm,mu_s\n9,half\n");
  Outcome outcome = shop_->identify(batch("--out kept --quiet --compare bad.csv"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("bad.csv:2: column mu_s: 'half' is not a number"));
  EXPECT_THAT(shop_->identify(batch("--out kept")).out, HasSubstr("0 fitted, 6 already there"));
  outcome = shop_->identify("merge kept --compare bad.csv");
  EXPECT_EQ(outcome.status, 3);
  outcome = shop_->identify(batch("--out other --compare missing.csv"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.err, HasSubstr("missing.csv"));
  EXPECT_FALSE(std::filesystem::exists(*shop_ / "other"));  // nothing was fitted for nothing
}

TEST_F(Comparison, WrongUsage) {
  ASSERT_EQ(shop_->identify(batch("--out res --quiet --compare table.csv")).status, 0);
  EXPECT_EQ(shop_->identify(batch("--out res --compare res/comparison.csv")).status, 2);
  EXPECT_EQ(shop_->identify("merge res --compare res/comparison.csv").status, 2);
  EXPECT_EQ(shop_->identify(batch("--out res --shard 1/2 --compare table.csv")).status, 2);
  EXPECT_EQ(shop_->identify("--radius 15mm --compare table.csv runs/r15mm_1.csv").status, 2);
}

TEST_F(Comparison, FiguresHoldEveryRunWithItsConditions) {
  ASSERT_EQ(shop_->identify(batch("--out res --quiet")).status, 0);
  const auto lines = [&](const char* name) { return lines_of(contents(*shop_ / "res/figures" / name)); };
  EXPECT_EQ(lines("05-rms-velocity.csv").size(), 3u);
  EXPECT_EQ(lines("05-rms-velocity.csv")[0],
            "runs,radius_mm,speed_rpm,load_N,rms_velocity_mm_s,rms_velocity_std_error_mm_s");
  EXPECT_EQ(lines("06-08-three-cycles.csv").size(), 1u + 6 * 180);
  EXPECT_EQ(lines("07-harmonics.csv").size(), 1u + 6 * 8);
  EXPECT_EQ(lines("09-static-kinetic.csv").size(), 1u + 2 * 4);
  EXPECT_EQ(lines("10-12-over-velocity.csv").size(), 1u + 6 * 4 * 40);
  EXPECT_EQ(lines("12-relative-error.csv").size(), 1u + 6 * 4);
  EXPECT_THAT(lines("12-relative-error.csv")[1], HasSubstr("mm_1,"));
  EXPECT_THAT(contents(*shop_ / "res/figures/07-spectrum.csv"), Not(HasSubstr("nan")));
}

}  // namespace
