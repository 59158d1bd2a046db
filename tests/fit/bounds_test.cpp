#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

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
        const tribofit::SolverResult found = tribofit::minimize(problem, start, lower, upper, options);
        const std::array<double, 3> slope = problem.slope(found.p);
        EXPECT_EQ(found.p[2], 0) << seed;
        EXPECT_GT(slope[2], 0) << seed;
        EXPECT_NEAR(slope[0], 0, careful ? 1e-9 : 1e-4) << seed;
        EXPECT_NEAR(slope[1], 0, careful ? 1e-9 : 1e-4) << seed;
      }
    }
  }
}

}  // namespace
