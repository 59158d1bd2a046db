/// What the noise floor is made of.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "fit/errors.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {
namespace {

/// Noise of variance 1 whose neighbours are correlated by `correlation`.
void add_coloured(double correlation, double scale, std::mt19937_64& engine, std::vector<double>& series) {
  std::normal_distribution<double> normal;
  double state = normal(engine);
  for (double& value : series) {
    value += scale * state;
    state = correlation * state + std::sqrt(1 - correlation * correlation) * normal(engine);
  }
}

/// 1/f noise as a sum of relaxations an octave apart, each of variance `variance` ln 2: so much in every e-fold of time
/// (J. Bernamont, Proc. Phys. Soc. 49 (1937) 138).
std::vector<double> flicker(double variance, std::size_t size, std::mt19937_64& engine) {
  std::vector<double> series(size);
  for (double memory = 0.5; memory < 4 * static_cast<double>(size); memory *= 2)
    add_coloured(std::exp(-1 / memory), std::sqrt(variance * std::log(2.0)), engine, series);
  return series;
}

/// A record of sticks and slips of so many samples each, with friction as given.
FlickerNoise in_sticks(std::vector<double> friction, std::size_t samples) {
  Motion motion;
  motion.step = 1e-4;
  for (std::size_t i = 0; i < friction.size(); ++i) motion.time.push_back(motion.step * static_cast<double>(i));
  motion.relative_velocity.assign(friction.size(), 0);
  motion.friction = std::move(friction);
  Segmentation segmentation;
  segmentation.kind = MotionKind::stick_slip;
  for (std::size_t begin = 0; begin + 2 * samples <= motion.size(); begin += 2 * samples) {
    Cycle cycle;
    cycle.stick = {begin, begin + samples};
    cycle.slip = {begin + samples, begin + 2 * samples};
    segmentation.cycles.push_back(cycle);
  }
  return flicker_noise(motion, segmentation);
}

constexpr std::size_t kSamples = 200'000;

TEST(FlickerNoise, HasItsVarianceInEveryEFoldOfTimeWhateverTheStickIsLong) {
  constexpr double kVariance = 4e-6;
  std::mt19937_64 engine(1);
  for (const std::size_t samples : {130U, 400U, 1000U, 2000U}) {
    const FlickerNoise found = in_sticks(flicker(kVariance, kSamples, engine), samples);
    EXPECT_NEAR(2 * found.power, kVariance, 0.25 * kVariance) << samples;
    EXPECT_LE(found.samples, 300) << samples;
  }
}

TEST(FlickerNoise, IsNotInWhiteNoiseNorBehindAnAmplifier) {
  std::mt19937_64 engine(2);
  for (const double correlation : {0.0, 0.5, 0.9, 0.97}) {
    std::vector<double> noise(kSamples);
    add_coloured(correlation, 0.003, engine, noise);
    EXPECT_LT(2 * in_sticks(std::move(noise), 1000).power, 0.01 * 9e-6) << correlation;
  }
}

TEST(FlickerNoise, IsNotClaimedWhereSticksAreTooShortToShowIt) {
  std::mt19937_64 engine(3);
  EXPECT_EQ(in_sticks(flicker(4e-6, kSamples, engine), 40).power, 0);
}

}  // namespace
}  // namespace tribofit
