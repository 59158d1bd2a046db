#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "nist_data.hpp"
#include "nist_models.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/fit/solver.hpp"

namespace {

/// Residuals of one NIST problem: response (its logarithm for Nelson) minus model.
template <class Model>
class NistResiduals final : public tribofit::Residuals {
 public:
  NistResiduals(const nist::Problem& problem, Model model) : problem_(problem), model_(model) {}
  std::size_t count() const override { return problem_.response.size(); }
  std::size_t parameter_count() const override { return Model::parameters; }
  bool evaluate(const double* p, double* residual, double* jacobian) const override {
    using Dual = ceres::Jet<double, Model::parameters>;
    std::vector<Dual> b;
    for (int k = 0; k < Model::parameters; ++k) b.emplace_back(p[k], k);
    for (std::size_t i = 0; i < count(); ++i) {
      const Dual value = model_(b.data(), problem_.predictors[i].data());
      const double y = problem_.name == "Nelson" ? std::log(problem_.response[i]) : problem_.response[i];
      residual[i] = y - value.a;
      if (!std::isfinite(residual[i])) return false;
      if (jacobian == nullptr) continue;
      for (int k = 0; k < Model::parameters; ++k) jacobian[i * Model::parameters + std::size_t(k)] = -value.v[k];
    }
    return true;
  }

 private:
  const nist::Problem& problem_;
  Model model_;
};

/// Covariance of parameters whose residuals are independent with one variance: s^2 (J'J)^-1, by QR of the scaled
/// Jacobian, as forming J'J would cost half the digits.
std::vector<double> covariance_of_independent(const tribofit::Residuals& problem, const std::vector<double>& p) {
  const auto rows = static_cast<Eigen::Index>(problem.count()), columns = static_cast<Eigen::Index>(p.size());
  Eigen::VectorXd residual(rows);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian(rows, columns);
  problem.evaluate(p.data(), residual.data(), jacobian.data());
  const Eigen::VectorXd scale = jacobian.colwise().norm().transpose().cwiseInverse();
  const Eigen::MatrixXd inverse =
      scale.asDiagonal() * tribofit::inverse_triangular_factor(jacobian * scale.asDiagonal());
  const Eigen::MatrixXd covariance =
      residual.squaredNorm() / static_cast<double>(rows - columns) * inverse * inverse.transpose();
  return {covariance.data(), covariance.data() + covariance.size()};
}

class Nist : public testing::TestWithParam<std::string_view> {};

/// Every problem from both starts: parameters to 9 digits on the mean, standard deviations to 6.
TEST_P(Nist, CertifiedParametersFromBothStarts) {
  const std::string folder = std::string(TRIBOFIT_SOURCE_DIR) + "/../shared/nist/";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "the NIST problems are not beside this checkout: skipped";
  const nist::Problem problem = nist::read_problem(folder + std::string(GetParam()) + ".dat");
  nist::with_model(problem.name, [&](auto model) {
    const NistResiduals residuals(problem, model);
    for (const std::vector<double>& start : problem.starts) {
      const tribofit::Solution result = tribofit::minimize(residuals, start);
      EXPECT_TRUE(result.converged) << result.message;
      EXPECT_GE(nist::mean_log_relative_error(result.p, problem.certified), 9.0);
      if (problem.name == "Lanczos1") continue;  // its residuals are near rounding, and so are its deviations
      const std::vector<double> covariance = covariance_of_independent(residuals, result.p);
      std::vector<double> deviations;
      for (std::size_t k = 0; k < result.p.size(); ++k)
        deviations.push_back(std::sqrt(covariance[k * result.p.size() + k]));
      EXPECT_GE(nist::least_log_relative_error(deviations, problem.standard_deviations), 6.0);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(AllProblems, Nist, testing::ValuesIn(nist::problem_names),
                         [](const auto& problem) { return std::string(problem.param); });

}  // namespace
