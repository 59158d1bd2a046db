// Minima that are known.
#include "statistics/golden_section.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tribofit {
namespace {

TEST(GoldenSection, FindsTheMinimumToItsInterval) {
  int evaluations = 0;
  const auto cost = [&](double x) {
    ++evaluations;
    return std::pow(x - 0.3, 2) + 7;
  };
  const Minimum least = golden_section(cost, -2, 5, 20);
  EXPECT_NEAR(least.at, 0.3, 7 * std::pow(0.6181, 20));
  EXPECT_NEAR(least.value, 7, 1e-6);
  EXPECT_EQ(evaluations, 22);
}

TEST(GoldenSection, AtAnEndOfTheInterval) {
  EXPECT_NEAR(golden_section([](double x) { return x; }, 1, 2, 30).at, 1, 1e-5);
  EXPECT_NEAR(golden_section([](double x) { return -x; }, 1, 2, 30).at, 2, 1e-5);
}

}  // namespace
}  // namespace tribofit
