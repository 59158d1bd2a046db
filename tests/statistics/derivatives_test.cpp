#include "statistics/derivatives.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace tribofit {
namespace {

constexpr double kStep = 5e-4;

template <class Function>
std::vector<double> sampled(std::size_t count, Function f, double noise = 0, std::uint64_t seed = 1) {
  std::mt19937_64 engine(seed);
  std::normal_distribution<double> normal;
  std::vector<double> out;
  for (std::size_t i = 0; i < count; ++i) out.push_back(f(kStep * static_cast<double>(i)) + noise * normal(engine));
  return out;
}

TEST(LocalDerivatives, FollowASineOverATwelfthOfItsPeriodToEitherSide) {
  const double w = 2 * std::numbers::pi * 20;  // 100 samples a period
  const LocalDerivatives found =
      local_derivatives(sampled(400, [&](double t) { return 5 + std::sin(w * t); }), kStep, 8);
  for (std::size_t i = 16; i < 384; ++i) {
    const double t = kStep * static_cast<double>(i);
    EXPECT_NEAR(found.slope[i], w * std::cos(w * t), 5e-4 * w);
    EXPECT_NEAR(found.second_derivative[i], -w * w * std::sin(w * t), 5e-3 * w * w);
  }
}

TEST(LocalDerivatives, APolynomialComesBackAtTheEndsToo) {
  const auto f = [](double t) { return 1 + 2 * t - 30 * t * t + 400 * t * t * t; };
  const LocalDerivatives found = local_derivatives(sampled(60, f), kStep, 10);
  for (std::size_t i = 0; i < 60; ++i) {
    const double t = kStep * static_cast<double>(i);
    EXPECT_NEAR(found.value[i], f(t), 1e-9);
    EXPECT_NEAR(found.slope[i], 2 - 60 * t + 1200 * t * t, 1e-7);
    EXPECT_NEAR(found.second_derivative[i], -60 + 2400 * t, 1e-3);
  }
}

/// A ramp whose slope jumps: a plain window would see the jump from its half away.
TEST(LocalDerivatives, ACornerStaysWhereItIs) {
  const auto ramp = [](double t) { return t < 0.1 ? t : 0.1 - 4 * (t - 0.1); };
  const LocalDerivatives found = local_derivatives(sampled(400, ramp, 1e-6), kStep, 15);
  for (std::size_t i = 20; i < 380; ++i) {
    if (i >= 198 && i <= 202) continue;
    const double truth = i < 200 ? 1 : -4;
    EXPECT_NEAR(found.slope[i], truth, std::max(0.02, 5 * found.slope_std_error[i])) << i;
  }
}

TEST(LocalDerivatives, ErrorsAreThoseOfTheNoise) {
  const auto wave = [](double t) { return std::sin(60 * t); };
  const LocalDerivatives found = local_derivatives(sampled(20000, wave, 0.01), kStep, 12);
  EXPECT_NEAR(found.noise, 0.01, 0.0005);
  double slope = 0, second_derivative = 0, count = 0;
  for (std::size_t i = 50; i < 19950; ++i) {
    const double t = kStep * static_cast<double>(i);
    slope += std::pow((found.slope[i] - 60 * std::cos(60 * t)) / found.slope_std_error[i], 2);
    second_derivative +=
        std::pow((found.second_derivative[i] + 3600 * std::sin(60 * t)) / found.second_derivative_std_error[i], 2);
    count += 1;
  }
  EXPECT_NEAR(std::sqrt(slope / count), 1, 0.1);
  EXPECT_NEAR(std::sqrt(second_derivative / count), 1, 0.1);
}

TEST(LocalDerivatives, ShortSignalsHaveNone) {
  EXPECT_EQ(local_derivatives(std::vector<double>{1, 2, 3}, kStep, 10).slope, std::vector<double>(3, 0.0));
  EXPECT_NEAR(local_derivatives(sampled(7, [](double t) { return 3 * t; }), kStep, 50).slope[0], 3, 1e-9);
}

TEST(LoneSamples, AreReplacedAndStepsAreNot) {
  std::vector<double> signal = sampled(
      2000, [](double t) { return t < 0.5 ? 1.0 : 2.0; }, 0.01);
  signal[300] += 1;
  signal[900] -= 1;
  const std::vector<double> before = signal;
  EXPECT_EQ(remove_lone_samples(signal), 2U);
  EXPECT_NEAR(signal[300], 1, 0.03);
  EXPECT_NEAR(signal[900], 1, 0.03);
  for (std::size_t i = 990; i < 1010; ++i) EXPECT_EQ(signal[i], before[i]);
}

}  // namespace
}  // namespace tribofit
