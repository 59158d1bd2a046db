// Lines, parabolas and slopes against polynomials that they must give back exactly, and against published values.
#include "tribofit/statistics/polynomials.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace tribofit {
namespace {

std::vector<double> samples_of(std::size_t n, double a, double b, double c) {
  std::vector<double> y(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = static_cast<double>(i);
    y[i] = a + b * x + c * x * x;
  }
  return y;
}

// The first set of F. J. Anscombe, Am. Stat. 27 (1973) 17: y = 3.00 + 0.500 x, standard error of the slope 0.118.
TEST(Line, ThroughThePointsOfAnscombe) {
  const std::vector<double> x = {10, 8, 13, 9, 11, 14, 6, 4, 12, 7, 5};
  const std::vector<double> y = {8.04, 6.95, 7.58, 8.81, 8.33, 9.96, 7.24, 4.26, 10.84, 4.82, 5.68};
  const StraightLine line = fit_line(x, y);
  EXPECT_DOUBLE_EQ(line.middle, 9);
  EXPECT_DOUBLE_EQ(line.squares, 110);
  EXPECT_NEAR(line.slope, 0.500, 5e-4);
  EXPECT_NEAR(line.at(0), 3.00, 5e-3);
  double squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) squares += std::pow(y[i] - line.at(x[i]), 2);
  EXPECT_NEAR(std::sqrt(squares / 9 / line.squares), 0.118, 5e-4);
}

TEST(Line, EquallySpacedSamplesAndPointsAgree) {
  const std::vector<double> y = {3, 1, 4, 1, 5, 9, 2, 6}, x = {0, 1, 2, 3, 4, 5, 6, 7};
  const StraightLine a = fit_line(y), b = fit_line(x, y);
  EXPECT_DOUBLE_EQ(a.middle, b.middle);
  EXPECT_DOUBLE_EQ(a.value, b.value);
  EXPECT_NEAR(a.slope, b.slope, 1e-15);
  EXPECT_DOUBLE_EQ(a.squares, b.squares);
}

TEST(Line, AWeightOfTwoIsAPointTwice) {
  const std::vector<double> x = {0, 1, 5}, y = {1, 0, 3}, weights = {1, 2, 0};
  const StraightLine weighted = fit_line(x, y, weights);
  const std::vector<double> twice_x = {0, 1, 1}, twice_y = {1, 0, 0};
  const StraightLine twice = fit_line(twice_x, twice_y);
  EXPECT_NEAR(weighted.at(0), twice.at(0), 1e-15);
  EXPECT_NEAR(weighted.slope, twice.slope, 1e-15);
}

TEST(Line, NoneOneAndTheSameAbscissa) {
  EXPECT_EQ(fit_line(std::vector<double>()).slope, 0);
  EXPECT_EQ(fit_line(std::vector<double>{4}).value, 4);
  const std::vector<double> x = {2, 2, 2}, y = {1, 2, 6};
  EXPECT_EQ(fit_line(x, y).slope, 0);
  EXPECT_EQ(fit_line(x, y).at(7), 3);
  const std::vector<double> third = {1.0 / 3, 9}, level = {0.7, 5}, alone = {7.1, 0};
  EXPECT_EQ(fit_line(third, level, alone).slope, 0);  // 7.1 * (1/3) / 7.1 is not 1/3 to the last digit
  EXPECT_NEAR(fit_line(third, level, alone).at(2), 0.7, 1e-15);
}

TEST(Parabola, IsGivenBack) {
  for (const std::size_t n : {3u, 4u, 11u, 200u}) {
    const double offset = 1e6;  // a large mean costs no digits of the rest
    const std::vector<double> y = samples_of(n, offset, -0.3, 0.02);
    const Parabola parabola = fit_parabola(y);
    for (std::size_t i = 0; i < n; ++i) {
      const double x = static_cast<double>(i) - parabola.centre();
      EXPECT_NEAR(parabola.at(x), y[i], 1e-8);
      EXPECT_NEAR(parabola.slope_at(x), -0.3 + 0.04 * static_cast<double>(i), 1e-9);
    }
    EXPECT_LT(remainder_about(parabola, y).squares, 1e-16 * static_cast<double>(n));
  }
}

TEST(Parabola, NormsAreSumsOverTheSamples) {
  const Parabola parabola = fit_parabola(samples_of(9, 1, 2, 3));
  double line = 0, curvature = 0;
  for (int i = 0; i < 9; ++i) {
    const double x = i - parabola.centre();
    line += x * x;
    curvature += std::pow(x * x - parabola.shift(), 2);
  }
  EXPECT_NEAR(parabola.line_norm(), line, 1e-12);
  EXPECT_NEAR(parabola.curvature_norm(), curvature, 1e-12);
}

/// A parabola takes three degrees of freedom from white noise.
TEST(Parabola, LeavesTheNoise) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal(0, 0.1);
  Remainder all;
  constexpr std::size_t kLength = 12, kStretches = 4000;
  for (std::size_t k = 0; k < kStretches; ++k) {
    std::vector<double> y = samples_of(kLength, 1, 2, -3);
    for (double& value : y) value += normal(engine);
    all += remainder_about(fit_parabola(y), y);
  }
  EXPECT_EQ(all.count, kLength * kStretches);
  EXPECT_NEAR(std::sqrt(all.squares / (all.count - 3 * kStretches)), 0.1, 0.001);
  EXPECT_EQ(all.correlation(0.9), 0);  // a fit leaves neighbours of opposite sign
}

TEST(Remainder, CorrelationOfNeighbours) {
  std::mt19937_64 engine(6);
  std::normal_distribution<double> normal;
  Remainder left;
  double state = 0;
  for (int i = 0; i < 200000; ++i) {
    state = 0.6 * state + normal(engine);
    left.add(state);
  }
  EXPECT_NEAR(left.correlation(0.95), 0.6, 0.01);
  EXPECT_EQ(left.correlation(0.5), 0.5);
  EXPECT_NEAR(variance_inflation(0.6), 4, 1e-12);
}

TEST(Peak, OfAParabolaIsItsVertex) {
  const auto y = [](double x) { return 3 - 2 * (x - 0.3) * (x - 0.3); };
  EXPECT_NEAR(peak_between(y(-1), y(0), y(1)), 0.3, 1e-14);
  EXPECT_EQ(peak_between(1, 1, 1), 0);
}

// Tables of Savitzky and Golay 1964, a quadratic over five points: (-3 12 17 12 -3)/35, and of its first derivative
// (-2 -1 0 1 2)/10.
TEST(SavitzkyGolay, WeightsOfTheTables) {
  const ParabolaWeights weights = parabola_weights(2, 2);
  const std::vector<double> values = {-3, 12, 17, 12, -3};
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_NEAR(weights.value[k], values[k] / 35, 1e-14);
    EXPECT_NEAR(weights.slope[k], (static_cast<double>(k) - 2) / 10, 1e-14);
  }
}

TEST(SavitzkyGolay, AnyWindowGivesAParabola) {
  const std::vector<double> y = samples_of(9, 2, -1, 0.5);
  for (std::size_t left = 0; left <= 8; ++left) {
    const ParabolaWeights weights = parabola_weights(left, 8 - left);
    double value = 0, slope = 0;
    for (std::size_t k = 0; k < 9; ++k) value += weights.value[k] * y[k], slope += weights.slope[k] * y[k];
    EXPECT_NEAR(value, y[left], 1e-11);
    EXPECT_NEAR(slope, -1 + static_cast<double>(left), 1e-11);
  }
}

TEST(SavitzkyGolay, SlopesOfAParabolaToItsEnds) {
  for (const std::size_t n : {2u, 3u, 5u, 30u, 9000u}) {
    const double step = 1e-3, curvature = n > 2 ? 4.0 : 0.0;
    std::vector<double> y(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double t = step * static_cast<double>(i);
      y[i] = 7 + 2 * t + curvature * t * t;
    }
    const std::vector<double> slope = savitzky_golay_slope(y, step, 10);
    ASSERT_EQ(slope.size(), n);
    for (std::size_t i = 0; i < n; ++i)
      EXPECT_NEAR(slope[i], 2 + 2 * curvature * step * static_cast<double>(i), 1e-8) << i;
  }
}

/// Noise of unit variance leaves the slope a variance of one over the sum of squares of the window.
TEST(SavitzkyGolay, AveragesNoise) {
  std::mt19937_64 engine(7);
  std::normal_distribution<double> normal;
  std::vector<double> y(100000);
  for (double& value : y) value = normal(engine);
  double squares = 0;
  for (const double slope : savitzky_golay_slope(y, 1, 5)) squares += slope * slope;
  EXPECT_NEAR(squares / static_cast<double>(y.size()), 1.0 / 110, 0.05 / 110);
}

// An autoregression of known spread; a parabola takes a quarter and more of its variance from short stretches.
TEST(NoiseAboutParabolas, GivesSpreadAndCorrelationBack) {
  std::mt19937_64 engine(5);
  std::normal_distribution<double> normal;
  for (const double correlation : {0.0, 0.5, 0.9}) {
    for (const std::size_t length : {12u, 30u, 60u, 200u}) {
      if (correlation == 0.9 && length < 60) continue;  // next to nothing is left of it
      constexpr std::size_t kStretches = 3000;
      Remainder all;
      double level = normal(engine);
      for (std::size_t k = 0; k < kStretches; ++k) {
        std::vector<double> stretch(length);
        for (double& x : stretch) {
          level = correlation * level + std::sqrt(1 - correlation * correlation) * normal(engine);
          x = 3 + 2 * level;
        }
        all += remainder_about(fit_parabola(stretch), stretch);
      }
      const CorrelatedNoise noise = noise_about_parabolas(all, kStretches);
      EXPECT_NEAR(noise.deviation, 2, 0.05) << correlation << " " << length;
      EXPECT_NEAR(noise.correlation, correlation, 0.03) << correlation << " " << length;
    }
  }
  EXPECT_EQ(noise_about_parabolas({}, 0).deviation, 0);
}

}  // namespace
}  // namespace tribofit
