#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "synthetic.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

namespace {

/// Three columns that are nearly alike, for a value that is bent: r_i = d_i - exp(a . p).
class Alike final : public tribofit::Residuals {
 public:
  explicit Alike(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 200; ++i) {
      const double common = normal(random);
      columns_.push_back({common, common + 0.05 * normal(random), common + 0.05 * normal(random)});
      data_.push_back(std::exp(value(columns_.back(), kTruth.data())) + 0.01 * normal(random));
    }
  }
  std::size_t count() const override { return data_.size(); }
  std::size_t parameter_count() const override { return 3; }
  bool evaluate(const double* p, double* residual, double* jacobian) const override {
    for (std::size_t i = 0; i < data_.size(); ++i) {
      const double y = std::exp(value(columns_[i], p));
      residual[i] = data_[i] - y;
      for (std::size_t k = 0; jacobian != nullptr && k < 3; ++k) jacobian[3 * i + k] = -y * columns_[i][k];
    }
    return true;
  }
  /// Slope of the cost over each parameter, over what its column has of the data.
  std::array<double, 3> slope(const std::vector<double>& p) const {
    std::vector<double> residual(count()), jacobian(3 * count());
    evaluate(p.data(), residual.data(), jacobian.data());
    std::array<double, 3> sum{}, squares{};
    double size = 0;
    for (std::size_t i = 0; i < count(); ++i) {
      size += residual[i] * residual[i];
      for (std::size_t k = 0; k < 3; ++k) {
        sum[k] += residual[i] * jacobian[3 * i + k];
        squares[k] += jacobian[3 * i + k] * jacobian[3 * i + k];
      }
    }
    for (std::size_t k = 0; k < 3; ++k) sum[k] /= std::sqrt(squares[k] * size);
    return sum;
  }

 private:
  static constexpr std::array<double, 3> kTruth = {0.2, 0.3, -0.4};
  static double value(const std::array<double, 3>& a, const double* p) {
    return a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
  }

  std::vector<std::array<double, 3>> columns_;
  std::vector<double> data_;
};

/// At the least cost within bounds no free parameter has a slope, and one on a bound has one that points outwards
/// (Karush, Kuhn and Tucker): a cosine between residual and column, so that it knows no units.
TEST(Bounds, TheOthersEndAtTheirMinimumWhereOneEndsOnItsBound) {
  const std::vector<double> lower = {-5, -5, 0}, upper = {5, 5, 5};
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Alike problem(seed);
    for (const std::vector<double>& start : {std::vector<double>{1, -1, 1}, {-0.5, 0.5, 0.3}}) {
      for (const bool careful : {true, false}) {
        tribofit::SolverOptions options;
        options.careful = careful;
        if (!careful) options.max_iterations = 40, options.relative_cost = 1e-8, options.relative_step = 1e-7;
        const tribofit::Solution found = tribofit::minimize(problem, start, lower, upper, options);
        const std::array<double, 3> slope = problem.slope(found.p);
        EXPECT_EQ(found.p[2], 0) << seed;
        EXPECT_GT(slope[2], 0) << seed;
        EXPECT_NEAR(slope[0], 0, careful ? 1e-9 : 1e-4) << seed;
        EXPECT_NEAR(slope[1], 0, careful ? 1e-9 : 1e-4) << seed;
      }
    }
  }
}

using namespace tribofit;

Fit fit_exponential(const synthetic::Record& record, std::size_t values_per_slip, const FitOptions& options = {}) {
  const FrictionModel model(ExponentialLaw{});
  return fit_model(model, record.motion, record.segmentation,
                   observe(record.motion, record.segmentation, model.needs(), values_per_slip), {}, options);
}

/// Slips so slow that friction hardly falls leave mu_k open, and alpha with it. Where mu_k ends on its bound that is as
/// true: the interval of alpha is not what it would be if mu_k were known to be there.
TEST(Bounds, WhatGoesWithAParameterOnItsBoundIsAsOpenAsThatIs) {
  const std::vector<double> truth = synthetic::table4_15mm(ExponentialLaw{});
  const FrictionModel model(ExponentialLaw{});
  int on_bound = 0, covered = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    synthetic::Options options;
    options.cycles = 24;
    options.rate = 2e3;
    options.peak = 0.002;
    options.noise = 0.004;
    options.seed = seed;
    const Fit fit = fit_exponential(synthetic::make(model, truth, options), 80);
    ASSERT_EQ(fit.parameters.size(), 3u);
    if (!fit.parameters[1].at_bound) continue;
    ++on_bound;
    const FitParameter& alpha = fit.parameters[2];
    covered += alpha.lower95 <= truth[2] && truth[2] <= alpha.upper95 ? 1 : 0;
  }
  ASSERT_GE(on_bound, 10);
  EXPECT_GE(covered, 0.9 * on_bound) << "of " << on_bound;
}

/// Half of a record follows another law than the other half: what the law of one half leaves on the other is far from
/// what that of both leaves, and is the same on every sample as by means over a third of a slip.
TEST(HeldOut, AnErrorFarFromThatOfTheFitIsTakenOnEverySample) {
  const FrictionModel model(ExponentialLaw{});
  synthetic::Options options;
  options.cycles = 24;
  synthetic::Record record = synthetic::make(model, {0.5, 0.3, 50}, options);
  const synthetic::Record other = synthetic::make(model, {0.9, 0.1, 600}, options);
  const std::size_t half = record.segmentation.cycles[12].stick.begin;
  std::copy(other.motion.friction.begin() + static_cast<std::ptrdiff_t>(half), other.motion.friction.end(),
            record.motion.friction.begin() + static_cast<std::ptrdiff_t>(half));
  for (std::size_t c = 12; c < 24; ++c) record.segmentation.cycles[c] = other.segmentation.cycles[c];
  FitOptions two;
  two.folds = 2;
  const Fit fit = fit_exponential(record, 3, two);
  ASSERT_EQ(fit.fold_parameters.size(), 2u);
  double squares = 0;
  for (std::size_t fold = 0; fold < 2; ++fold) {
    Fit of_fold = fit;
    for (std::size_t k = 0; k < 3; ++k) of_fold.parameters[k].value = fit.fold_parameters[fold][k];
    Segmentation held = record.segmentation;
    held.cycles.clear();
    for (std::size_t c = 0; c < record.segmentation.cycles.size(); ++c) {
      if (fit.fold_of(c) == fold) held.cycles.push_back(record.segmentation.cycles[c]);
    }
    squares += 0.5 * std::pow(evaluate_frozen(of_fold, record.motion, held).error.rmse, 2);
  }
  EXPECT_GT(std::sqrt(squares), 1.5 * fit.error.rmse);
  EXPECT_NEAR(fit.error.held_out_rmse, std::sqrt(squares), 0.01 * std::sqrt(squares));
}

}  // namespace
