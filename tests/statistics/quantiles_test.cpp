// Quantiles against the definition and against normal samples.
#include "tribofit/statistics/quantiles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tribofit {
namespace {

TEST(Quantiles, OrderStatisticsStandAtTheirFractions) {
  const std::vector<double> x = {7, -1, 3, 10, 4};
  const std::vector<double> sorted = {-1, 3, 4, 7, 10};
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    EXPECT_EQ(quantile(x, 0.25 * static_cast<double>(k)), sorted[k]);
    EXPECT_EQ(quantile_of_sorted(sorted, 0.25 * static_cast<double>(k)), sorted[k]);
  }
  EXPECT_DOUBLE_EQ(quantile(x, 0.3), 3 + 0.2 * (4 - 3));
  EXPECT_DOUBLE_EQ(quantile(x, 0.95), 7 + 0.8 * (10 - 7));
}

// The example of the help page of R's quantile(), type 7: quantile(c(1, 2, 3, 4)) is 1, 1.75, 2.5, 3.25, 4.
TEST(Quantiles, FollowsTheDefinitionOfR) {
  const std::vector<double> x = {4, 3, 2, 1};
  EXPECT_DOUBLE_EQ(quantile(x, 0.25), 1.75);
  EXPECT_DOUBLE_EQ(quantile(x, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile(x, 0.75), 3.25);
}

TEST(Quantiles, MedianOfOddEvenOneAndNone) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({4, 1, 3, 2}), 2.5);
  EXPECT_EQ(median({8}), 8);
  EXPECT_TRUE(std::isnan(median({})));
  EXPECT_TRUE(std::isnan(quantile({}, 0.1)));
  EXPECT_TRUE(std::isnan(quantile_of_sorted({}, 0.1)));
}

TEST(Quantiles, InAnyOrderAsInAscendingOrder) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> uniform(-5, 5);
  std::vector<double> x(501);
  for (double& value : x) value = uniform(engine);
  std::vector<double> sorted = x;
  std::sort(sorted.begin(), sorted.end());
  for (int k = 0; k <= 97; ++k) EXPECT_EQ(quantile(x, k / 97.0), quantile_of_sorted(sorted, k / 97.0));
}

TEST(Quantiles, DeviationOfNormalSamplesIsTheirStandardDeviation) {
  std::mt19937_64 engine(2);
  std::normal_distribution<double> normal(3, 2);
  std::vector<double> x(100001);
  for (double& value : x) value = normal(engine);
  for (std::size_t k = 0; k < 1000; ++k) x[k] = 1e6;  // outliers hardly move it
  const double centre = median(x);
  EXPECT_NEAR(centre, 3, 0.04);
  EXPECT_NEAR(kSigmaPerMad * median_absolute_deviation(x, centre), 2, 0.04);
  EXPECT_NEAR(kSigmaPerMad, 1 / 0.6744897501960817, 1e-4);  // one over the 0.75 quantile of the normal distribution
}

}  // namespace
}  // namespace tribofit
