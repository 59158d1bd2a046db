/// Waves that follow from sample to sample, against the functions they stand for.
#include "tribofit/friction/rotation.hpp"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "tribofit/friction/turn_along_slip.hpp"

namespace {

using namespace tribofit;

/// Times of a record [s]: regular, but for jitter of a tenth of a step and one gap.
std::vector<double> jittery_times(std::size_t count, double rate) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  std::vector<double> times;
  for (std::size_t i = 0; i < count; ++i) {
    const double gap = i > count / 2 ? 0.37 : 0;
    times.push_back((static_cast<double>(i) + jitter(engine)) / rate + gap);
  }
  return times;
}

TEST(WaveOverTime, IsTheFunctionsWithTheirDerivativesOverALongRecord) {
  using Dual = ceres::Jet<double, 4>;
  struct Case {
    double decay, frequency, rate;  ///< [1/s], [Hz], [Hz]
  };
  // Steps of 2e-3, 0.19 and 1.6 rad, which is beyond a small turn; then those that decay slowly and fast.
  const std::vector<Case> cases = {{0, 6, 20000}, {0, 600, 20000}, {0, 250, 1000}, {0.2, 6, 20000}, {90, 300, 20000}};
  for (const Case& one : cases) {
    const double w = 2 * std::numbers::pi * one.frequency;
    const Dual amplitude(0.3, 0), decay(one.decay, 1), turn(w, 2), phase(-2.1, 3);
    WaveOverTime<Dual> wave(amplitude, decay, turn, phase);
    WaveOverTime<double> values(0.3, one.decay, w, -2.1);
    double off = 0, off_slopes = 0, off_values = 0;
    for (const double t : jittery_times(200000, one.rate)) {
      const Dual expected = amplitude * exp(-decay * t) * cos(turn * t + phase);
      const Dual got = wave.at(t);
      const double rounding = 1e-15 * (1 + w * t);  // of the angle itself
      off = std::max(off, std::abs(got.a - expected.a) / rounding);
      off_values = std::max(off_values, std::abs(values.at(t) - expected.a) / rounding);
      off_slopes = std::max(off_slopes, (got.v - expected.v).cwiseAbs().maxCoeff() / (rounding * (1 + t)));
    }
    EXPECT_LT(off, 50) << one.decay << " " << one.frequency;
    EXPECT_LT(off_values, 50) << one.decay << " " << one.frequency;
    EXPECT_LT(off_slopes, 50) << one.decay << " " << one.frequency;
  }
}

TEST(TurnAlongSlip, AndItsPowersAreTheWavesOfTheDisc) {
  for (const double step : {2e-5, 0.05, 0.9}) {  // [rad], of each way to turn
    std::vector<double> angle;
    for (const double t : jittery_times(2000, 1)) angle.push_back(40 + step * t);
    Slip slip;
    slip.time = slip.angle = angle;
    TurnAlongSlip turn(slip);
    for (std::size_t i = 0; i < angle.size(); i += 1 + i % 3) {  // samples may be left out
      const Rotation once = turn.at(i), thrice = once * once * once;
      ASSERT_NEAR(once.cosine(), std::cos(angle[i]), 1e-12) << step << " " << i;
      ASSERT_NEAR(once.sine(), std::sin(angle[i]), 1e-12) << step << " " << i;
      ASSERT_NEAR(Wave<double>(0.3, 0.4).at(thrice), 0.3 * std::cos(3 * angle[i] + 0.4), 1e-12) << step << " " << i;
    }
  }
}

TEST(TurnAlongSlip, StandsAtZeroWhereTheAngleIsNotKnown) {
  Slip slip;
  TurnAlongSlip turn(slip);
  EXPECT_EQ(turn.at(5).cosine(), 1);
  EXPECT_EQ(turn.at(5).sine(), 0);
}

}  // namespace
