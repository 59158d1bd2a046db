// t and F against closed forms for few degrees of freedom.
#include "tribofit/statistics/distributions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <vector>

namespace tribofit {
namespace {

// t with one degree of freedom is Cauchy's, with two its distribution function is 1/2 + t / (2 sqrt(2 + t^2)).
TEST(Distributions, QuantileOfTInClosedForm) {
  EXPECT_NEAR(t_quantile_95(1), std::tan(std::numbers::pi * 0.475), 1e-10);
  EXPECT_NEAR(t_quantile_95(2), 0.95 * std::sqrt(2 / (1 - 0.95 * 0.95)), 1e-10);
  EXPECT_NEAR(t_quantile_95(1e9), 1.959963984540054, 1e-7);  // normal distribution
}

TEST(Distributions, PValueOfTInClosedForm) {
  for (const double t : {-3.0, 0.0, 0.5, 12.0}) {
    EXPECT_NEAR(t_p_value(t, 1), 1 - 2 / std::numbers::pi * std::atan(std::abs(t)), 1e-12);
    EXPECT_NEAR(t_p_value(t, 2), 1 - std::abs(t) / std::sqrt(2 + t * t), 1e-12);
  }
  EXPECT_NEAR(t_p_value(t_quantile_95(7.3), 7.3), 0.05, 1e-10);
  EXPECT_EQ(t_p_value(std::numeric_limits<double>::quiet_NaN(), 5), 1);
}

// F with two degrees of freedom above: P(F > f) = (1 + 2 f / n)^(-n/2).
TEST(Distributions, PValueOfFInClosedForm) {
  for (const double n : {2.0, 5.0, 31.5}) {
    for (const double f : {0.3, 1.0, 8.0}) EXPECT_NEAR(f_p_value(f, 2, n), std::pow(1 + 2 * f / n, -n / 2), 1e-12);
  }
  EXPECT_NEAR(f_p_value(2.5 * 2.5, 1, 9), t_p_value(2.5, 9), 1e-12);  // the square of t
}

// Distribution of the likelihood ratio of a change point: P(x) = (1 - exp(-x/2))^2 (Hansen 2000, theorem 2).
TEST(ChangePoint, RiseIsTheQuantileInClosedForm) {
  EXPECT_NEAR(std::pow(1 - std::exp(-kChangePointRise95 / 2), 2), 0.95, 5e-4);
}

/// A step of known size in white noise: the places whose squares rise by no more than that cover the true one.
TEST(ChangePoint, IntervalCoversTheTruth) {
  std::mt19937_64 engine(8);
  std::normal_distribution<double> normal;
  constexpr std::size_t kLength = 200, kPlace = 83;
  constexpr double kSize = 0.5;
  int covered = 0;
  constexpr int kSeries = 3000;
  for (int k = 0; k < kSeries; ++k) {
    std::vector<double> before(kLength), after(kLength);
    for (std::size_t i = 0; i < kLength; ++i) {
      const double y = (i < kPlace ? 0 : kSize) + normal(engine);
      before[i] = y * y;
      after[i] = (y - kSize) * (y - kSize);
    }
    // What is left when the change comes before each place, or after the last.
    std::vector<double> squares = {std::accumulate(after.begin(), after.end(), 0.0)};
    for (std::size_t i = 0; i < kLength; ++i) squares.push_back(squares.back() + before[i] - after[i]);
    const double least = *std::min_element(squares.begin(), squares.end());
    covered += squares[kPlace] <= least + kChangePointRise95 ? 1 : 0;
  }
  EXPECT_NEAR(covered / static_cast<double>(kSeries), 0.96, 0.02);  // places in steps make it a little wider
}

}  // namespace
}  // namespace tribofit
