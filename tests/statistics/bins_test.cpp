#include "tribofit/statistics/bins.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace tribofit {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::Lt;

TEST(BandOverCycles, IsTheSpreadOfCyclesAndNotOfSamples) {
  // Levels of 101 cycles are 0 to 100; samples of a cycle scatter by 50 about its level, evenly.
  BinnedSamples band(0, 10, 5);
  for (int cycle = 0; cycle <= 100; ++cycle) {
    for (int i = 0; i < 40; ++i) band.add(0.25 * i + 0.1, cycle + (i % 2 == 0 ? 50 : -50));
    band.end_cycle();
  }
  const CycleBand drawn = band.band();
  ASSERT_EQ(drawn.at.size(), 5u);
  EXPECT_THAT(drawn.low, Each(DoubleNear(5, 1e-9)));
  EXPECT_THAT(drawn.middle, Each(DoubleNear(50, 1e-9)));
  EXPECT_THAT(drawn.high, Each(DoubleNear(95, 1e-9)));
  EXPECT_NEAR(drawn.at[0], 0.975, 1e-9);  // mean of 0.1 to 1.85
}

TEST(BandOverCycles, LeavesOutBinsThatHardlyAnyCycleReaches) {
  BinnedSamples band(0, 2, 2);
  for (int cycle = 0; cycle < 100; ++cycle) {
    band.add(0.5, 1);
    if (cycle < 9) band.add(1.5, 7);
    band.add(2.5, 9);  // outside
    band.add(0.5, std::numeric_limits<double>::quiet_NaN());
    band.end_cycle();
  }
  EXPECT_THAT(band.band().middle, ElementsAre(1));
}

TEST(ExtremesInBins, KeepTheWorstSample) {
  BinnedSamples bins(0, 1, 10);
  for (int i = 0; i < 1000; ++i) bins.add(1e-3 * (i + 0.5), i == 555 ? 0.5 : 0.01);
  const BinExtremes drawn = bins.extremes();
  ASSERT_EQ(drawn.at.size(), 10u);
  EXPECT_EQ(drawn.largest[5], 0.5);
  EXPECT_NEAR(drawn.mean[5], (99 * 0.01 + 0.5) / 100, 1e-12);
  EXPECT_THAT(drawn.mean, Each(Lt(0.02)));
}

}  // namespace
}  // namespace tribofit
