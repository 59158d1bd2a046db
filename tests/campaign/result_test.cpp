#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "runs.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/pipeline.hpp"

namespace tribofit {
namespace {

using ::testing::ElementsAre;

TEST(Seal, TellsWholeFilesFromDamagedOnes) {
  const std::string whole = sealed("{\n  \"a\": 1\n}\n");
  EXPECT_TRUE(nlohmann::json::accept(whole));
  EXPECT_TRUE(is_whole(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) EXPECT_FALSE(is_whole(whole.substr(0, size))) << size;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    std::string damaged = whole;
    damaged[k] = static_cast<char>(damaged[k] ^ 1);
    EXPECT_FALSE(is_whole(damaged)) << k;
  }
  EXPECT_FALSE(is_whole(whole + " "));
}

/// What is read back from a folder of results is what the library computes for the trace.
TEST(RunResultTest, HoldsWhatTheAnalysisFound) {
  const Workshop shop;
  make_runs(shop, 2);
  ASSERT_EQ(shop.identify("runs --out res --quiet").status, 0);
  const std::vector<RunResult> results = read_results((shop / "res").string());
  ASSERT_EQ(results.size(), 2u);
  const RunResult& second = results[1];
  EXPECT_EQ(second.run.name, "a2");
  EXPECT_EQ(second.run.file, "a2.csv");
  EXPECT_EQ(second.position, 1u);
  EXPECT_EQ(second.run.repeat, 2);
  ASSERT_EQ(second.run.others.size(), 1u);
  EXPECT_EQ(second.run.others[0].value, "L");
  EXPECT_NEAR(results[0].conditions.radius.value, 0.0151, 1e-12);
  EXPECT_EQ(second.conditions.radius.source, "manifest");

  IdentifyOptions options;
  options.read.conditions.radius = {0.015, "manifest"};
  options.read.conditions.load = {50, "manifest"};
  const Identification truth = identify((shop / "runs/a2.csv").string(), options);
  EXPECT_EQ(second.samples, truth.samples);
  EXPECT_DOUBLE_EQ(second.frequency.value, truth.segmentation.frequency.value);
  EXPECT_NEAR(second.amplitude.std_error, truth.segmentation.amplitude.std_error * 1e3, 1e-12);
  ASSERT_EQ(second.fits.size(), truth.fits.size());
  for (std::size_t f = 0; f < truth.fits.size(); ++f) {
    const Fit& expected = truth.fits[f];
    const ResultFit& fit = second.fits[f];
    EXPECT_EQ(fit.law, to_string(expected.model.law()));
    EXPECT_EQ(fit.protocol, to_string(expected.protocol));
    EXPECT_DOUBLE_EQ(fit.error.held_out_rmse, expected.error.held_out_rmse);
    EXPECT_DOUBLE_EQ(fit.degrees_of_freedom, expected.degrees_of_freedom);
    const std::size_t n = expected.parameters.size();
    ASSERT_EQ(fit.parameters.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      const FitParameter& p = expected.parameters[i];
      EXPECT_EQ(fit.parameters[i].name, p.parameter.name);
      EXPECT_DOUBLE_EQ(fit.parameters[i].value, p.value / p.parameter.si);
      EXPECT_DOUBLE_EQ(fit.parameters[i].std_error, p.std_error / p.parameter.si);
    }
    if (expected.covariance.empty()) continue;
    ASSERT_EQ(fit.covariance.size(), n);
    for (std::size_t i = 0; i < n; ++i) {
      ASSERT_EQ(fit.covariance[i].size(), n);
      EXPECT_NEAR(std::sqrt(fit.covariance[i][i]), fit.parameters[i].std_error, 1e-9 * fit.parameters[i].std_error);
    }
  }
  EXPECT_NE(second.fit("exponential", "joint"), nullptr);
  EXPECT_EQ(second.fit("coulomb", "joint"), nullptr);
}

TEST(RunResultTest, OrderInTimeComesFromAConditionThatSaysIt) {
  const Workshop shop;
  make_runs(shop, 3);
  const auto order_with = [&](const std::string& name, const std::string& a, const std::string& b,
                              const std::string& c) {
    shop.write("runs/manifest.csv",
               "file,radius," + name + "\na1.csv,15mm," + a + "\na2.csv,15mm," + b + "\na3.csv,15mm," + c + "\n");
    EXPECT_EQ(shop.identify("runs --out res --quiet").status, 0);
    std::vector<double> order;
    for (const RunResult& result : read_results((shop / "res").string())) order.push_back(result.order.value_or(-1));
    return order;
  };
  EXPECT_THAT(order_with("Run order", "10", "9", "100"), ElementsAre(1, 0, 2));
  EXPECT_THAT(order_with("date", "2026-03-01", "2026-02-11", "2026-02-11"), ElementsAre(2, 0.5, 0.5));
  EXPECT_THAT(order_with("temperature", "1", "2", "3"), ElementsAre(-1, -1, -1));
  EXPECT_THAT(order_with("order", "1", "2", ""), ElementsAre(-1, -1, -1));
}

TEST(RunResultTest, ACopyOfARecordCountsOnce) {
  std::vector<RunResult> runs(4);
  const char* checksums[] = {"a", "b", "a", ""};
  for (std::size_t k = 0; k < runs.size(); ++k) {
    runs[k].run.file = std::string("r") + std::to_string(k) + ".csv";
    runs[k].checksum = checksums[k];
    runs[k].fits.resize(1);
  }
  count_copies_once(runs);
  for (const std::size_t k : {0U, 1U, 3U}) EXPECT_EQ(runs[k].fits.size(), 1U) << k;
  EXPECT_EQ(runs[2].run.status, RunStatus::failed);
  EXPECT_EQ(runs[2].run.message, "r2.csv holds the same values as r0.csv: a copy is no repeat, it counts once");
  EXPECT_TRUE(runs[2].fits.empty());
}

TEST(RunResultTest, AFolderWithoutACampaignIsNamed) {
  const Workshop shop;
  EXPECT_THROW(read_results((shop / "nothing").string()), InputError);
  shop.write("campaign.json", "{}");
  EXPECT_THROW(read_results((shop / "").string()), InputError);
}

}  // namespace
}  // namespace tribofit
