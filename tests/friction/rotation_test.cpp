/// Waves that follow from sample to sample, against the functions they stand for.
#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "tribofit/friction/turn_along_slip.hpp"
#include "tribofit/friction/wave.hpp"

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
  // Steps of 2e-6, 2e-3, 0.19 and 1.6 rad, which is beyond a small turn; no wave at all; then decays of 1e-5, 0.005 and
  // 0.1 a sample, which is beyond a small one.
  const std::vector<Case> cases = {{0, 0.006, 20000}, {0, 6, 20000},   {0, 600, 20000},  {0, 250, 1000},
                                   {0, 0, 20000},     {0.2, 6, 20000}, {90, 300, 20000}, {2000, 6, 20000}};
  for (const Case& one : cases) {
    const double w = 2 * std::numbers::pi * one.frequency;
    const Dual amplitude(0.3, 0), decay(one.decay, 1), turn(w, 2), phase(-2.1, 3);
    WaveOverTime<Dual> wave(amplitude, decay, turn, phase);
    WaveOverTime<double> values(0.3, one.decay, w, -2.1), undamped(0.3, w, -2.1);
    double off = 0, off_slopes = 0, off_values = 0;
    for (const double t : jittery_times(200000, one.rate)) {
      const Dual expected = amplitude * exp(-decay * t) * cos(turn * t + phase);
      const Dual got = wave.at(t);
      ASSERT_TRUE(std::isfinite(got.a) && got.v.allFinite()) << t;
      const double rounding = 2e-16 * (20 + (w + one.decay) * t);  // of some turns in a row, and of angle and exponent
      off = std::max(off, std::abs(got.a - expected.a) / rounding);
      off_values = std::max(off_values, std::abs(values.at(t) - expected.a) / rounding);
      off_slopes = std::max(off_slopes, (got.v - expected.v).cwiseAbs().maxCoeff() / (rounding * (1 + t)));
      const double plain = undamped.at(t);
      if (one.decay == 0) {
        ASSERT_NEAR(plain, expected.a, 2 * rounding) << t;
      }
    }
    EXPECT_LT(off, 2) << one.decay << " " << one.frequency;
    EXPECT_LT(off_values, 2) << one.decay << " " << one.frequency;
    EXPECT_LT(off_slopes, 2) << one.decay << " " << one.frequency;
  }
}

TEST(WaveOverTime, GoesBackAndRecoversFromATimeThatIsNone) {
  WaveOverTime<double> wave(1.0, 3.0, 40.0, 0.5);
  const auto expected = [](double t) { return std::exp(-3 * t) * std::cos(40 * t + 0.5); };
  for (const double t : {0.1, 0.101, 0.099, 0.05, std::numeric_limits<double>::quiet_NaN(), 0.2, 0.201}) {
    const double got = wave.at(t);
    EXPECT_TRUE(std::isnan(t) || std::abs(got - expected(t)) < 1e-14) << t;
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
