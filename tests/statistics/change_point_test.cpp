// The place of a change and its interval against series whose change is known.
#include "tribofit/statistics/change_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tribofit {
namespace {

TEST(ChangePoint, SquaresOfEveryPlaceByHand) {
  const std::vector<double> before = {1, 2, 9}, after = {5, 7, 3};
  EXPECT_EQ(squares_by_change(before, after), (std::vector<double>{15, 11, 6, 12}));
  EXPECT_EQ(squares_by_change({}, {}), (std::vector<double>{0}));
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
    const std::vector<double> squares = squares_by_change(before, after);
    const double least = *std::min_element(squares.begin(), squares.end());
    covered += squares[kPlace] <= least + kChangePointRise95 ? 1 : 0;
  }
  EXPECT_NEAR(covered / static_cast<double>(kSeries), 0.96, 0.02);  // places in steps make it a little wider
}

}  // namespace
}  // namespace tribofit
