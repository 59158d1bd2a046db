// Small systems whose solutions are known in closed form.
#include "statistics/linear_algebra.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tribofit {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Second differences of n points: eigenvalues 2 - 2 cos(k pi / (n + 1)).
MatrixXd second_differences(Eigen::Index n) {
  MatrixXd out = MatrixXd::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    out(i, i) = 2;
    if (i > 0) out(i, i - 1) = out(i - 1, i) = -1;
  }
  return out;
}

MatrixXd hilbert(Eigen::Index rows, Eigen::Index columns) {
  MatrixXd out(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index j = 0; j < columns; ++j) out(i, j) = 1.0 / static_cast<double>(i + j + 1);
  }
  return out;
}

TEST(LinearAlgebra, EigenvaluesOfSecondDifferences) {
  constexpr Eigen::Index n = 7;
  const MatrixXd matrix = second_differences(n);
  const SymmetricEigen eigen = symmetric_eigen(matrix);
  for (Eigen::Index k = 0; k < n; ++k) {
    EXPECT_NEAR(eigen.values(k), 2 - 2 * std::cos(static_cast<double>(k + 1) * std::numbers::pi / (n + 1)), 1e-13);
    EXPECT_LT((matrix * eigen.vectors.col(k) - eigen.values(k) * eigen.vectors.col(k)).norm(), 1e-13);
  }
  EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - MatrixXd::Identity(n, n)).norm(), 1e-13);
}

/// The inverse of second differences: min(i, j) (n + 1 - max(i, j)) / (n + 1).
TEST(LinearAlgebra, InverseOfSecondDifferences) {
  constexpr Eigen::Index n = 6;
  MatrixXd inverse(n, n);
  for (Eigen::Index i = 1; i <= n; ++i) {
    for (Eigen::Index j = 1; j <= n; ++j) {
      inverse(i - 1, j - 1) = static_cast<double>(std::min(i, j) * (n + 1 - std::max(i, j))) / (n + 1);
    }
  }
  const MatrixXd matrix = second_differences(n);
  const VectorXd right = VectorXd::LinSpaced(n, -1, 3);
  EXPECT_LT((inverse_of_symmetric(matrix) - inverse).norm(), 1e-13);
  EXPECT_LT((inverse_of(matrix) - inverse).norm(), 1e-13);
  EXPECT_LT((solve_symmetric(matrix, MatrixXd(right)) - inverse * right).norm(), 1e-13);
  EXPECT_LT((least_squares(matrix, right) - inverse * right).norm(), 1e-13);
  const SymmetricSystem system = solve_symmetric_system(matrix, right);
  EXPECT_LT((system.x - inverse * right).norm(), 1e-13);
  EXPECT_LT((system.inverse - inverse).norm(), 1e-13);
  const double condition = matrix.cwiseAbs().colwise().sum().maxCoeff() * inverse.cwiseAbs().colwise().sum().maxCoeff();
  EXPECT_NEAR(system.reciprocal_condition * condition, 1, 0.1);
}

/// Ones with 1 + e on the diagonal: 1-norm 3 + e, that of the inverse (4 + e)/(e (3 + e)).
TEST(LinearAlgebra, ANearlySingularSystemIsSaidToBeOne) {
  constexpr double e = 1e-9;
  const MatrixXd matrix = MatrixXd::Ones(3, 3) + e * MatrixXd::Identity(3, 3);
  EXPECT_NEAR(solve_symmetric_system(matrix, VectorXd::Ones(3)).reciprocal_condition * (4 + e) / e, 1, 0.1);
}

/// QR keeps the digits that normal equations of this design (condition 1e7, squared 1e14) would lose.
TEST(LinearAlgebra, LeastSquaresOfAnIllConditionedDesign) {
  const MatrixXd design = hilbert(9, 6);
  const VectorXd x = (VectorXd(6) << 1, -2, 3, -4, 5, -6).finished();
  EXPECT_LT((least_squares(design, design * x) - x).norm(), 1e-7);
  const RankedSolution ranked = least_squares_of_any_rank(design, design * x);
  EXPECT_EQ(ranked.rank, 6);
  EXPECT_LT((ranked.x - x).norm(), 1e-7);
  const MatrixXd inverse = inverse_triangular_factor(design);
  EXPECT_LT((design * inverse * (design * inverse).transpose() * design - design).norm(), 1e-8);
}

TEST(LinearAlgebra, RankOfRepeatedColumns) {
  MatrixXd design(4, 3);
  design << 1, 0, 1, 1, 1, 2, 1, 2, 3, 1, 3, 4;
  const VectorXd right = (VectorXd(4) << 1, 3, 5, 7).finished();
  const RankedSolution solution = least_squares_of_any_rank(design, right);
  EXPECT_EQ(solution.rank, 2);
  EXPECT_LT((design * solution.x - right).norm(), 1e-13);
}

TEST(LinearAlgebra, FactorsOfAProduct) {
  MatrixXd design = hilbert(5, 3), wide = hilbert(2, 4);
  const MatrixXd product = design.transpose() * design, wide_product = wide.transpose() * wide;
  const MatrixXd r = triangular_factor(design), wide_r = triangular_factor(wide);
  MatrixXd same_sign = hilbert(30, 7);
  const MatrixXd qr = same_sign.householderQr().matrixQR().topRows(7).triangularView<Eigen::Upper>();
  EXPECT_LT((triangular_factor(same_sign) - qr).norm(), 1e-14);
  EXPECT_LT((r.transpose() * r - product).norm(), 1e-14);
  EXPECT_LT((wide_r.transpose() * wide_r - wide_product).norm(), 1e-14);
  EXPECT_EQ(r(1, 0), 0);
  EXPECT_EQ(wide_r.bottomRows(2).norm(), 0);

  const MatrixXd matrix = second_differences(4), right = hilbert(4, 2), left = solve_lower_factor(matrix, right);
  EXPECT_LT((left.transpose() * left - right.transpose() * inverse_of(matrix) * right).norm(), 1e-13);
}

TEST(LinearAlgebra, ComplementOfConstantAndRamp) {
  MatrixXd nuisance(6, 2);
  nuisance.col(0).setOnes();
  nuisance.col(1) = VectorXd::LinSpaced(6, -1, 1);
  const MatrixXd rest = orthogonal_complement(nuisance);
  ASSERT_EQ(rest.cols(), 4);
  EXPECT_LT((rest.transpose() * nuisance).norm(), 1e-14);
  EXPECT_LT((rest.transpose() * rest - MatrixXd::Identity(4, 4)).norm(), 1e-14);
}

TEST(LinearAlgebra, AMatrixThatIsNotFiniteHasNoEigenvalues) {
  MatrixXd matrix = second_differences(3);
  matrix(1, 2) = std::nan("");
  for (const auto& value : eigenvalues(matrix)) EXPECT_TRUE(std::isnan(value.real()));
}

}  // namespace
}  // namespace tribofit
