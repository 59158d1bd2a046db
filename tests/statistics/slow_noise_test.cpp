/// Slow noise of a series: what it does to sums of its values.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "tribofit/statistics/slow_noise.hpp"

namespace tribofit {
namespace {

std::vector<double> white(std::mt19937_64& engine, std::size_t n) {
  std::normal_distribution<double> normal;
  std::vector<double> x(n);
  for (double& value : x) value = normal(engine);
  return x;
}

/// 1/f noise as the half-integral of white noise (J. R. M. Hosking, Biometrika 68 (1981) 165): its power is
/// 1/(2 sin(pi f)), 1/(2 pi f) at low frequencies.
std::vector<double> flicker(std::mt19937_64& engine, std::size_t n) {
  const std::size_t past = 4 * n;
  const std::vector<double> input = white(engine, n + past);
  std::vector<double> kernel(n + past, 1.0), out(n);
  for (std::size_t k = 1; k < kernel.size(); ++k)
    kernel[k] = kernel[k - 1] * (static_cast<double>(k) - 0.5) / static_cast<double>(k);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k <= i + past; ++k) out[i] += kernel[k] * input[i + past - k];
  }
  return out;
}

/// Weights of a slope over the series.
std::vector<double> slope(std::size_t n) {
  std::vector<double> weights(n);
  const double middle = 0.5 * (static_cast<double>(n) - 1);
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) squares += std::pow(static_cast<double>(i) - middle, 2);
  for (std::size_t i = 0; i < n; ++i) weights[i] = (static_cast<double>(i) - middle) / squares;
  return weights;
}

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

TEST(SlowNoise, VarianceOfASumIsThatOfItsCovariance) {
  SlowNoise noise;
  noise.covariance = {4, 2, 1};
  EXPECT_DOUBLE_EQ(noise.variance_of_sum(std::vector<double>{1, 1, 1}), 3 * 4 + 2 * (2 * 2 + 1));
  EXPECT_DOUBLE_EQ(noise.variance_of_sum(std::vector<double>{1, 0, -1}), 2 * 4 - 2 * 1);
}

TEST(SlowNoise, IsLittleInIndependentNoise) {
  std::mt19937_64 engine(1);
  constexpr int kSeries = 200;
  const std::vector<double> weights = slope(120);
  int doubled = 0;
  for (int k = 0; k < kSeries; ++k) {
    const SlowNoise found = slow_noise(white(engine, 120));
    doubled += found.variance_of_sum(weights) > product(weights, weights) ? 1 : 0;  // that of independent noise
  }
  EXPECT_LT(doubled, 0.2 * kSeries);
}

/// The slope over 1/f noise, of which the series itself has been freed: its own lowest frequencies say too little.
TEST(SlowNoise, KnowsTheSlopesOfFlickerNoise) {
  std::mt19937_64 engine(2);
  constexpr std::size_t kValues = 120;
  constexpr int kSeries = 300;
  const std::vector<double> weights = slope(kValues);
  double truth = 0, said = 0;
  int called_flicker = 0;
  for (int k = 0; k < kSeries; ++k) {
    std::vector<double> x = flicker(engine, kValues);
    const double found = product(weights, x);
    truth += found * found / kSeries;
    for (std::size_t i = 0; i < kValues; ++i) x[i] -= found * (static_cast<double>(i) - 0.5 * (kValues - 1));
    const SlowNoise noise = slow_noise(x);
    said += noise.variance_of_sum(weights) / kSeries;
    called_flicker += noise.is_flicker ? 1 : 0;
  }
  EXPECT_GT(called_flicker, 0.9 * kSeries);
  EXPECT_GT(said, 0.8 * truth);
  EXPECT_LT(said, 1.6 * truth);
}

/// 1/f noise of power 1: a sum of relaxations an octave apart (J. Bernamont, Proc. Phys. Soc. 49 (1937) 138).
std::vector<double> relaxations(std::mt19937_64& engine, std::size_t n) {
  std::vector<double> out(n, 0.0);
  for (double memory = 0.5; memory < 4 * static_cast<double>(n); memory *= 2) {
    const double keep = std::exp(-1 / memory), size = std::sqrt(2 * std::numbers::ln2);
    const std::vector<double> input = white(engine, n);
    double state = input[0];
    for (std::size_t i = 0; i < n; ++i) {
      out[i] += size * state;
      state = keep * state + std::sqrt(1 - keep * keep) * input[i];
    }
  }
  return out;
}

/// Stretches of 1/f noise with white noise beside it, in every twentieth of them a jump that is no noise.
TEST(SlowNoise, StretchesShowThePowerOfFlickerNoise) {
  std::mt19937_64 engine(6);
  constexpr std::size_t kValues = 6000, kLength = 150;
  for (const double level : {0.0, 3.0}) {
    double found = 0;
    constexpr int kSeries = 20;
    for (int k = 0; k < kSeries; ++k) {
      std::vector<double> x = relaxations(engine, kValues);
      const std::vector<double> fast = white(engine, kValues);
      std::vector<std::span<const double>> stretches;
      for (std::size_t i = 0; i < kValues; ++i) {
        x[i] += level * fast[i] + (i / kLength % 20 == 0 && i % kLength > kLength / 3 ? 20 : 0);
      }
      for (std::size_t i = 0; i < kValues; i += kLength) stretches.push_back(std::span(x).subspan(i, kLength));
      found += flicker_power(stretches) / kSeries;
    }
    EXPECT_NEAR(found, 1, 0.2) << level;
  }
}

/// Independent values hide slow noise that is known from elsewhere.
TEST(SlowNoise, IsNoLessThanWhatIsKnown) {
  std::mt19937_64 engine(7);
  const std::vector<double> weights = slope(60);
  const SlowNoise found = slow_noise(white(engine, 60), 0.1), twice = slow_noise(white(engine, 60), 0.2);
  EXPECT_TRUE(found.is_flicker);
  EXPECT_NEAR(twice.variance_of_sum(weights), 2 * found.variance_of_sum(weights), 1e-12);
}

TEST(SlowNoise, ALongAutoregressionIsNotFlickerNoise) {
  std::mt19937_64 engine(3);
  std::normal_distribution<double> normal;
  constexpr double kMemory = 0.8;
  int called_flicker = 0;
  for (int k = 0; k < 50; ++k) {
    std::vector<double> x(1000);
    double state = 0;
    for (double& value : x) value = state = kMemory * state + normal(engine);
    called_flicker += slow_noise(x).is_flicker ? 1 : 0;
  }
  EXPECT_LT(called_flicker, 5);
}

TEST(SlowNoise, ALineIsNone) {
  std::mt19937_64 engine(4);
  std::vector<double> x = white(engine, 200);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 5 * std::cos(2 * std::numbers::pi * 0.05 * double(i));
  const SlowNoise found = slow_noise(x);
  EXPECT_LT(found.variance_within(), 3) << "of the 12.5 of the line";
}

TEST(SlowNoise, FewOrEqualValuesHaveNone) {
  EXPECT_TRUE(slow_noise(std::vector<double>(15, 1.0)).covariance.empty());
  EXPECT_TRUE(slow_noise(std::vector<double>(100, 1.0)).covariance.empty());
  EXPECT_EQ(slow_noise({}).variance_within(), 0);
}

}  // namespace
}  // namespace tribofit
