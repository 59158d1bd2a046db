// Means whose standard error stands correlated neighbours, and regressions of estimates that have errors of their own.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "statistics/meta_regression.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {
namespace {

/// First-order autoregression of unit innovations: the long-run variance is 1/(1-r)^2.
std::vector<double> autoregression(std::mt19937_64& engine, std::size_t n, double r) {
  std::normal_distribution<double> normal;
  std::vector<double> x(n);
  double state = normal(engine) / std::sqrt(1 - r * r);
  for (double& value : x) {
    value = state;
    state = r * state + normal(engine);
  }
  return x;
}

TEST(MeanWithError, CoversTheTruthWhereNeighboursAreCorrelated) {
  std::mt19937_64 engine(3);
  for (const double r : {0.0, 0.3, 0.7}) {
    constexpr int kSeries = 2000;
    int covered = 0;
    for (int k = 0; k < kSeries; ++k) {
      const Estimate mean = mean_with_error(autoregression(engine, 120, r));
      covered += std::abs(mean.value) <= t_quantile_95(mean.degrees_of_freedom) * mean.std_error ? 1 : 0;
    }
    EXPECT_NEAR(covered / static_cast<double>(kSeries), 0.95, 0.025) << r;
  }
}

TEST(MeanWithError, FindsTheLongRunVarianceOfALongSeries) {
  std::mt19937_64 engine(4);
  constexpr std::size_t kLength = 100000;
  const double r = 0.5;
  const Estimate mean = mean_with_error(autoregression(engine, kLength, r));
  const double expected = 1 / (1 - r) / std::sqrt(static_cast<double>(kLength));
  EXPECT_NEAR(mean.std_error, expected, 5 * expected / std::sqrt(2 * mean.degrees_of_freedom));
}

/// What repeats exactly leaves at most its amplitude over pi and the periods in the mean.
TEST(MeanWithError, APeriodicSeriesIsNoScatterWithAMemory) {
  constexpr std::size_t kLength = 197;
  constexpr double kPeriod = 74;
  std::vector<double> series(kLength);
  const auto fill = [&](double phase, const auto& noise) {
    for (std::size_t i = 0; i < kLength; ++i) {
      series[i] = std::sin(2 * std::numbers::pi * static_cast<double>(i) / kPeriod + phase) + noise();
    }
    return mean_with_error(series);
  };
  const double periods = kLength / kPeriod, most = 1 / (std::numbers::pi * periods);
  EXPECT_LT(fill(0.3, [] { return 0.0; }).std_error, most);
  std::mt19937_64 engine(11);
  std::normal_distribution<double> normal(0, 0.1);
  std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi);
  constexpr int kSeries = 500;
  double squares = 0, claimed = 0;
  for (int k = 0; k < kSeries; ++k) {
    const Estimate mean = fill(turn(engine), [&] { return normal(engine); });
    squares += mean.value * mean.value / kSeries;
    claimed += mean.std_error * mean.std_error / kSeries;
  }
  EXPECT_NEAR(std::sqrt(claimed / squares), 1, 0.1);
}

TEST(MeanWithError, CoversTheTruthBesideALineOfTheSizeOfTheNoise) {
  std::mt19937_64 engine(12);
  std::uniform_real_distribution<double> turn(0, 2 * std::numbers::pi);
  for (const double period : {5.0, 13.3}) {
    constexpr int kSeries = 1000;
    int covered = 0;
    for (int k = 0; k < kSeries; ++k) {
      std::vector<double> x = autoregression(engine, 197, 0.5);
      const double phase = turn(engine);
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] += 3 * std::cos(2 * std::numbers::pi * static_cast<double>(i) / period + phase);
      }
      const Estimate mean = mean_with_error(x);
      covered += std::abs(mean.value) <= t_quantile_95(mean.degrees_of_freedom) * mean.std_error ? 1 : 0;
    }
    EXPECT_NEAR(covered / static_cast<double>(kSeries), 0.95, 0.025) << period;
  }
}

TEST(MeanWithError, UnknownIsSaidAsUnknown) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isnan(mean_with_error({}).value));
  EXPECT_TRUE(std::isnan(mean_with_error({nan, nan}).value));
  const Estimate two = mean_with_error({1, nan, 2});
  EXPECT_EQ(two.value, 1.5);
  EXPECT_TRUE(std::isnan(two.std_error));
  EXPECT_EQ(mean_with_error({4, 4, 4, 4}).std_error, 0);
}

/// Equal variances: tau^2 of Paule and Mandel is the sample variance less the variance of one estimate.
TEST(MetaRegression, EqualVariancesHaveAClosedForm) {
  const Eigen::VectorXd y = (Eigen::VectorXd(6) << 1.0, 1.5, 0.2, 2.1, 0.9, 1.3).finished();
  const double variance = 0.05, mean = y.mean(), spread = (y.array() - mean).square().sum() / 5;
  const MetaRegression out = meta_regression(y, Eigen::VectorXd::Constant(6, variance), Eigen::MatrixXd::Ones(6, 1));
  EXPECT_NEAR(out.coefficients(0), mean, 1e-12);
  EXPECT_NEAR(out.between, std::sqrt(spread - variance), 1e-10);
  EXPECT_NEAR(out.covariance(0, 0), spread / 6, 1e-10);
  EXPECT_NEAR(out.statistical(0), std::sqrt(variance / 6), 1e-10);
  EXPECT_EQ(out.degrees_of_freedom, 5);
}

TEST(MetaRegression, NoMoreRunsThanColumns) {
  const MetaRegression out = meta_regression(Eigen::Vector2d(1, 3), Eigen::Vector2d(0.1, 0.2),
                                             (Eigen::MatrixXd(2, 2) << 1, 0, 1, 2).finished());
  EXPECT_NEAR(out.coefficients(0), 1, 1e-12);
  EXPECT_NEAR(out.coefficients(1), 1, 1e-12);
  EXPECT_EQ(out.between, 0);
  EXPECT_EQ(out.degrees_of_freedom, 0);
}

// 2, 4, 9: mean 5, sum of squares 9 + 1 + 16 = 26, error sqrt(26/(3 2)).
TEST(MeanOfIndependent, HasItsErrorFromTheScatter) {
  const std::vector<double> values = {2, 4, 9};
  const Estimate mean = mean_of_independent(values);
  EXPECT_DOUBLE_EQ(mean.value, 5);
  EXPECT_DOUBLE_EQ(mean.std_error, std::sqrt(26.0 / 6));
  EXPECT_EQ(mean.degrees_of_freedom, 2);
  EXPECT_TRUE(std::isnan(mean_of_independent(std::span(values).first(1)).std_error));
  EXPECT_TRUE(std::isnan(mean_of_independent({}).value));
}

}  // namespace
}  // namespace tribofit
