#include "statistics/ensemble_sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {
namespace {

std::vector<std::vector<double>> scattered(std::size_t count, std::size_t dimension, double scale) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal(0, scale);
  std::vector<std::vector<double>> points(count, std::vector<double>(dimension));
  for (auto& point : points) {
    for (double& x : point) x = normal(engine);
  }
  return points;
}

/// Two values whose scales differ by 1e6 and that correlate by 0.99, from walkers that begin far too close.
TEST(EnsembleSampler, FindsScalesAndCorrelationsThatNobodyToldIt) {
  const double r = 0.99, scale = 1e6;
  const auto density = [&](const std::vector<double>& x) {
    const double a = x[0], b = (x[1] - 3 * scale) / scale;
    return -0.5 * (a * a - 2 * r * a * b + b * b) / (1 - r * r);
  };
  auto start = scattered(16, 2, 0.05);
  for (auto& x : start) x[1] = (3 + x[1]) * scale;
  double mean_a = 0, mean_b = 0, aa = 0, bb = 0, ab = 0;
  const auto points = sample_ensemble(density, start, 200, 4000, 1);
  ASSERT_EQ(points.size(), 16U * 4000);
  const auto n = static_cast<double>(points.size());
  for (const auto& x : points) {
    const double a = x[0], b = (x[1] - 3 * scale) / scale;
    mean_a += a / n, mean_b += b / n, aa += a * a / n, bb += b * b / n, ab += a * b / n;
  }
  EXPECT_NEAR(mean_a, 0, 0.1);
  EXPECT_NEAR(mean_b, 0, 0.1);
  EXPECT_NEAR(aa, 1, 0.1);
  EXPECT_NEAR(bb, 1, 0.1);
  EXPECT_NEAR(ab / std::sqrt(aa * bb), r, 0.005);
}

/// An exponential density that begins at 0, where the walkers are.
TEST(EnsembleSampler, KeepsToWhereThereIsAnyDensity) {
  const auto density = [](const std::vector<double>& x) {
    return x[0] < 0 ? -std::numeric_limits<double>::infinity() : -x[0];
  };
  auto start = scattered(8, 1, 0.01);
  for (auto& x : start) x[0] = std::abs(x[0]);
  std::vector<double> values;
  for (const auto& x : sample_ensemble(density, start, 200, 5000, 2)) values.push_back(x[0]);
  EXPECT_GE(quantile(values, 0), 0);
  EXPECT_NEAR(quantile(values, 0.5), std::log(2.0), 0.05);
  EXPECT_NEAR(quantile(values, 0.95), -std::log(0.05), 0.2);
}

TEST(EnsembleSampler, IsTheSameForTheSameSeedAndStaysWhereNothingIsPossible) {
  const auto start = scattered(6, 2, 1);
  const auto density = [](const std::vector<double>& x) { return -std::abs(x[0]) - std::abs(x[1]); };
  EXPECT_EQ(sample_ensemble(density, start, 3, 5, 7), sample_ensemble(density, start, 3, 5, 7));
  EXPECT_NE(sample_ensemble(density, start, 3, 5, 7), sample_ensemble(density, start, 3, 5, 8));
  const auto nowhere = [](const std::vector<double>&) { return std::nan(""); };
  EXPECT_EQ(sample_ensemble(nowhere, start, 2, 1, 7), start);
  EXPECT_TRUE(sample_ensemble(density, {}, 2, 2, 7).empty());
}

}  // namespace
}  // namespace tribofit
