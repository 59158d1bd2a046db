/// Laws against their equations, and fits that find their parameters.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "fit/synthetic.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/friction/laws/all.hpp"

namespace {

using namespace tribofit;

template <class L>
double at(const std::vector<double>& q, double v) {
  if constexpr (requires { L::steepness(q.data()); }) v *= L::steepness(q.data());
  return L::friction(q.data(), v);
}

/// 95 % intervals that cover the truth, and all of them, over records of 40 cycles.
std::array<int, 2> covering(const Law& law, const std::vector<double>& truth) {
  std::array<int, 2> count{};
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    synthetic::Options options;
    options.noise = 0.003;
    options.scatter = 0.004;
    options.rate = 5e3;
    options.seed = seed;
    const FrictionModel model(law);
    const synthetic::Record record = synthetic::make(model, truth, options);
    const Observations observations =
        observe(record.motion, record.segmentation, model.needs(), describe(law).steep_at_rest ? 0 : 80);
    const Fit fit = fit_model(model, record.motion, record.segmentation, observations);
    for (std::size_t k = 0; k < truth.size(); ++k) {
      const FitParameter& p = fit.parameters.at(k);
      EXPECT_NEAR(p.value, truth[k], 5 * p.std_error) << p.parameter.name << " seed " << seed;
      EXPECT_LT(p.std_error, 0.02 * std::abs(truth[k])) << p.parameter.name << " seed " << seed;
      count[0] += p.lower95 <= truth[k] && truth[k] <= p.upper95 ? 1 : 0;
      ++count[1];
    }
  }
  return count;
}

TEST(TwoLevelLaws, AreTheirEquations) {
  const std::vector<double> q = {0.5, 0.3, 50};
  for (const double v : {0.0, 1e-3, 0.02, 0.3}) {
    EXPECT_NEAR(at<ExponentialLaw>(q, v), 0.3 + 0.2 * std::exp(-50 * v), 1e-15);
    EXPECT_NEAR(at<FractionalLaw>(q, v), 0.3 + 0.2 / (1 + 50 * v), 1e-15);
    EXPECT_NEAR(at<GaussianLaw>({0.5, 0.3, 0.02}, v), 0.3 + 0.2 * std::exp(-std::pow(v / 0.02, 2)), 1e-15);
    EXPECT_EQ(at<CoulombLaw>({0.5, 0.3}, v), 0.3);
  }
  EXPECT_NEAR(at<GaussianLaw>({0.5, 0.3, 0.02}, 0.02), 0.3 + 0.2 / std::exp(1.0), 1e-15);
}

TEST(GaussianLaw, MeanOverANormalSpreadIsExact) {
  const double v = 0.6, s = 0.8;  // reduced speed, a wide spread
  double sum = 0, weight = 0;
  for (double z = -8; z <= 8; z += 1e-3) {
    const double w = std::exp(-0.5 * z * z);
    sum += w * std::exp(-std::pow(v + s * z, 2));
    weight += w;
  }
  EXPECT_NEAR(GaussianLaw::mean_shape(v, s * s), sum / weight, 1e-9);
}

TEST(GaussianLaw, IntervalsOfAFitCoverTheTruth) {
  const auto [covered, all] = covering(GaussianLaw{}, {0.509, 0.318, 0.025});
  EXPECT_GE(covered, 0.88 * all) << covered << " of " << all;
}

TEST(LogarithmicLaw, IsItsEquation) {
  const std::vector<double> q = {0.41, -0.013};
  EXPECT_NEAR(at<LogarithmicLaw>(q, 1e-3), 0.41, 1e-15);
  EXPECT_NEAR(at<LogarithmicLaw>(q, 1e-2) - at<LogarithmicLaw>(q, 1e-3), -0.013 * std::log(10.0), 1e-15);
  EXPECT_NEAR(at<LogarithmicLaw>(q, 0.5), 0.41 - 0.013 * std::log(500.0), 1e-15);
  // Below 0.1 mm/s along the tangent there: no kink, and finite at rest.
  const double h = 1e-10;
  const auto slope = [&](double v) { return (at<LogarithmicLaw>(q, v + h) - at<LogarithmicLaw>(q, v - h)) / (2 * h); };
  EXPECT_NEAR(slope(1e-4 - 2 * h) / slope(1e-4 + 2 * h), 1, 1e-4);
  EXPECT_NEAR(slope(1e-5), -0.013 / 1e-4, 1e-3 * 130);
  EXPECT_NEAR(LogarithmicLaw::at_rest(q.data()), 0.41 - 0.013 * (std::log(0.1) - 1), 1e-15);
}

TEST(LogarithmicLaw, MeanOverAnEvenSpreadIsExactAtAnySpeed) {
  constexpr int kPoints = 200000;
  for (const double v : {0.0, 3e-6, 1e-5, 4e-5, 1e-3, 2e-2}) {
    for (const double half : {1e-6, 1e-4, 1e-3}) {
      double sum = 0;  // of what would lie below rest, the part above it
      const double low = std::max(0.0, v - half), high = v + half;
      for (int i = 0; i < kPoints; ++i) sum += LogarithmicLaw::logarithm(low + (high - low) * (i + 0.5) / kPoints);
      EXPECT_NEAR(LogarithmicLaw::mean_logarithm(v, half * half / 3), sum / kPoints, 1e-6) << v << " " << half;
    }
  }
}

TEST(LogarithmicLaw, IntervalsOfAFitCoverTheTruth) {
  const auto [covered, all] = covering(LogarithmicLaw{}, {0.41, -0.013});
  EXPECT_GE(covered, 0.88 * all) << covered << " of " << all;
}

TEST(LogarithmicLaw, HealingAtRestIsTheLogarithmOfTheAge) {
  // Rate and state in steady sliding and at rest: mu_0 + A ln(D_c/(theta v0)).
  const FrictionModel model(LogarithmicLaw{}, {make_effect("rate-state:healing")});
  const std::vector<double> p = {0.41, -0.013, 200e-6, 0};
  Slip slip;
  slip.from_stick = true;
  for (const double stick_time : {0.02, 0.2, 1.5}) {
    slip.stick_time = stick_time;
    EXPECT_NEAR(break_away_level(model, p.data(), slip), 0.41 - 0.013 * std::log(200e-6 / stick_time / 1e-3), 1e-12);
  }
}

}  // namespace
