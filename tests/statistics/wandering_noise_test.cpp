#include "statistics/wandering_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tribofit {
namespace {

/// Noise in two stretches, of 600 values each.
struct Drawn {
  std::vector<double> time, count;
  std::vector<std::size_t> begins = {0, 600};
  Eigen::VectorXd values;
  Eigen::MatrixXd own;

  Drawn(double white, double slow, double forgets, std::uint64_t seed, double each = 1) : values(1200), own(1200, 1) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    own.setOnes();
    double state = 0;
    for (int i = 0; i < 1200; ++i) {
      time.push_back(0.1 * (i % 600) + (i < 600 ? 0 : 1000));
      count.push_back(each);
      const double decay = i % 600 == 0 ? 0 : std::exp(-0.1 / forgets);
      state = decay * state + std::sqrt(1 - decay * decay) * normal(generator);
      values(i) = white / std::sqrt(each) * normal(generator) + slow * state;
    }
  }
  NoisySeries series() const { return {time, count, begins}; }
};

}  // namespace

TEST(WanderingNoise, SizesAndTimeComeBack) {
  double white = 0, slow = 0, time = 0;
  constexpr int kRuns = 12;
  for (int run = 1; run <= kRuns; ++run) {
    const Drawn drawn(2, 1, 1.5, static_cast<std::uint64_t>(run), 4);
    const WanderingNoise noise = estimate_noise(drawn.series(), drawn.values, Eigen::MatrixXd(1200, 0), drawn.own);
    white += noise.white / kRuns;
    slow += noise.slow / kRuns;
    time += std::log(noise.time) / kRuns;
  }
  EXPECT_NEAR(white, 2, 0.1);
  EXPECT_NEAR(slow, 1, 0.1);
  EXPECT_NEAR(std::exp(time), 1.5, 0.3);
}

TEST(WanderingNoise, WhiteNoiseDoesNotWander) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const Drawn drawn(1, 0, 1, seed);
    const WanderingNoise noise = estimate_noise(drawn.series(), drawn.values, Eigen::MatrixXd(1200, 0), drawn.own);
    EXPECT_NEAR(noise.white, 1, 0.08);
    // What is left of it moves the mean of a stretch by no more than the white noise does.
    const NoiseMoments moments = noise_moments(drawn.series(), drawn.own / 1200, noise);
    EXPECT_LT(moments.slow(0, 0), 2 * moments.white(0, 0));
  }
}

TEST(WanderingNoise, MomentsAreThoseOfTheCovariance) {
  const Drawn drawn(1, 1, 1, 1);
  const WanderingNoise noise = {0.5, 2, 3};
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(1200, 2);
  for (int i = 0; i < 1200; ++i) weights(i, 0) = std::sin(0.01 * i), weights(i, 1) = i % 7;
  double slow = 0, white = 0;
  for (int i = 0; i < 1200; ++i) {
    white += 0.25 * weights(i, 0) * weights(i, 1);
    for (int k = 0; k < 1200; ++k) {
      if ((i < 600) != (k < 600)) continue;
      slow +=
          4 * weights(i, 0) * weights(k, 1) *
          std::exp(-std::abs(drawn.time[static_cast<std::size_t>(i)] - drawn.time[static_cast<std::size_t>(k)]) / 3);
    }
  }
  const NoiseMoments moments = noise_moments(drawn.series(), weights, noise);
  EXPECT_NEAR(moments.white(0, 1), white, 1e-9 * std::abs(white));
  EXPECT_NEAR(moments.slow(0, 1), slow, 1e-9 * std::abs(slow));
  EXPECT_NEAR(moments.slow(1, 0), slow, 1e-9 * std::abs(slow));
}

TEST(WanderingNoise, WhitenedSquaresOfWhiteNoiseAreThePlainOnes) {
  const Drawn drawn(1, 0, 1, 2);
  double squares = 0;
  for (const int begin : {0, 600}) {
    const Eigen::VectorXd part = drawn.values.segment(begin, 600);
    squares += (part.array() - part.mean()).square().sum();
  }
  EXPECT_NEAR(whitened_squares(drawn.series(), drawn.values, drawn.own, {2, 0, 0}), squares / 4, 1e-9 * squares);
}

}  // namespace tribofit
