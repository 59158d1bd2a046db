#include "statistics/thinning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace tribofit {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

TEST(DrawnSamples, AOneSampleSpikeSurvivesWhereverItStands) {
  constexpr std::size_t kSamples = 1000003;
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{1}, std::size_t{499999}, std::size_t{777777}, kSamples - 1}) {
    std::vector<double> values(kSamples, 1.0);
    values[at] = at % 2 == 0 ? 2 : -2;
    const std::vector<std::size_t> drawn = drawn_samples(values, 1000);
    EXPECT_THAT(drawn, Contains(at));
    EXPECT_LE(drawn.size(), 5000u);
  }
}

TEST(DrawnSamples, StandInOrderWithBothEnds) {
  std::mt19937_64 random(1);
  std::vector<double> values(54321);
  for (double& v : values) v = static_cast<double>(random() % 1000);
  const std::vector<std::size_t> drawn = drawn_samples(values, 100);
  EXPECT_EQ(drawn.front(), 0u);
  EXPECT_EQ(drawn.back(), values.size() - 1);
  for (std::size_t k = 1; k < drawn.size(); ++k) ASSERT_LT(drawn[k - 1], drawn[k]);
}

TEST(DrawnSamples, KeepTheExtremesOfEveryStretch) {
  std::vector<double> values(100000);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(1e-3 * static_cast<double>(i * i % 99991));
  const std::vector<std::size_t> drawn = drawn_samples(values, 50);
  for (std::size_t k = 0; k < 50; ++k) {
    const std::size_t begin = values.size() * k / 50, end = values.size() * (k + 1) / 50;
    double least = 1e9, largest = -1e9, drawn_least = 1e9, drawn_largest = -1e9;
    for (std::size_t i = begin; i < end; ++i)
      least = std::min(least, values[i]), largest = std::max(largest, values[i]);
    for (const std::size_t i : drawn) {
      if (i < begin || i >= end) continue;
      drawn_least = std::min(drawn_least, values[i]);
      drawn_largest = std::max(drawn_largest, values[i]);
    }
    EXPECT_EQ(drawn_least, least);
    EXPECT_EQ(drawn_largest, largest);
  }
}

TEST(DrawnSamples, AGapStaysAGap) {
  std::vector<double> values(10000, 1.0);
  values[4321] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(drawn_samples(values, 20), Contains(4321u));
  values.assign(10000, std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(drawn_samples(values, 20).empty());
}

TEST(DrawnSamples, AreAllWhereThereAreFew) {
  EXPECT_THAT(drawn_samples(std::vector<double>{3, 1, 2}, 1), ElementsAre(0, 1, 2));
  EXPECT_TRUE(drawn_samples({}, 10).empty());
}

}  // namespace
}  // namespace tribofit
