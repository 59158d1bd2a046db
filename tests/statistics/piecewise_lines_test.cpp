#include "statistics/piecewise_lines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tribofit {
namespace {

struct Made {
  std::vector<double> t, x;
};

/// Slopes from times on, at irregular times, with noise.
Made made_of(const std::vector<double>& begins, const std::vector<double>& slopes, double end, double interval,
             double noise, std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> jitter(0.5, 1.5);
  Made out;
  for (double t = 0; t < end; t += interval * jitter(generator)) {
    double x = 0;
    for (std::size_t i = 0; i < begins.size() && begins[i] < t; ++i) {
      const double until = i + 1 < begins.size() ? std::min(t, begins[i + 1]) : t;
      x += slopes[i] * (until - begins[i]);
    }
    out.t.push_back(t);
    out.x.push_back(x + noise * normal(generator));
  }
  return out;
}

}  // namespace

TEST(PiecewiseLines, CornersAreFoundCloserThanASample) {
  const std::vector<double> begins = {0, 40, 60, 100, 130}, slopes = {1, 10, 1, 3, 0};
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Made made = made_of(begins, slopes, 160, 0.1, 0.02, seed);
    const std::vector<LinePiece> pieces = piecewise_lines(made.t, made.x);
    ASSERT_EQ(pieces.size(), begins.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      EXPECT_NEAR(pieces[i].begin, begins[i], i == 0 ? 1e-12 : 0.03) << i;
      EXPECT_NEAR(pieces[i].slope, slopes[i], 5e-3);
      EXPECT_EQ(pieces[i].is_level, i == 4);
    }
  }
}

TEST(PiecewiseLines, WithoutNoiseCornersAreExact) {
  const Made made = made_of({0, 40.123, 60.05}, {1, 10, 0}, 100, 0.1, 0, 1);
  const std::vector<LinePiece> pieces = piecewise_lines(made.t, made.x);
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(pieces[1].begin, 40.123, 1e-9);
  EXPECT_NEAR(pieces[2].begin, 60.05, 1e-9);
  EXPECT_TRUE(pieces[2].is_level);
}

TEST(PiecewiseLines, NoiseAndOneSlopeMakeNoCorner) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Made made = made_of({0}, {2}, 100, 0.1, 0.5, seed);
    EXPECT_EQ(piecewise_lines(made.t, made.x).size(), 1U) << seed;
  }
}

TEST(PiecewiseLines, LongRecordsAreThinnedButCornersAreNot) {
  const Made made = made_of({0, 300.02, 500}, {0.1, 1, 0.3}, 700, 0.01, 1e-3, 3);
  ASSERT_GT(made.t.size(), 60000U);
  const std::vector<LinePiece> pieces = piecewise_lines(made.t, made.x);
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_NEAR(pieces[1].begin, 300.02, 5e-3);
  EXPECT_NEAR(pieces[2].begin, 500, 5e-3);
}

TEST(PiecewiseLines, AStopShorterThanAStrideIsFound) {
  const Made made = made_of({0, 300, 301, 350, 2000}, {10, 0, 10, 0, 10}, 2100, 0.1, 0.2, 4);
  const std::vector<LinePiece> pieces = piecewise_lines(made.t, made.x);
  ASSERT_EQ(pieces.size(), 5U);
  EXPECT_NEAR(pieces[1].begin, 300, 0.1);
  EXPECT_NEAR(pieces[2].begin, 301, 0.1);
  EXPECT_TRUE(pieces[1].is_level && pieces[3].is_level);
}

TEST(PiecewiseLines, DigitsAreNoSteps) {
  Made made = made_of({0, 300, 340, 640}, {0.01, 1, 0.01, 1}, 700, 0.1, 0, 5);
  for (double& x : made.x) x = std::round(x);  // at 0.01 a digit lasts a hundred seconds
  const std::vector<LinePiece> pieces = piecewise_lines(made.t, made.x);
  ASSERT_EQ(pieces.size(), 4U);
  EXPECT_NEAR(pieces[1].begin, 300, 0.5);
  EXPECT_NEAR(pieces[1].slope, 1, 5e-3);
  EXPECT_NEAR(pieces[2].slope, 0.01, 3e-3);
}

}  // namespace tribofit
