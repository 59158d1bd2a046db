#pragma once

#include <Eigen/Core>

namespace tribofit {

// Small dense linear algebra. Eigen's decompositions take seconds to compile wherever one is written down: they are
// written down in linear_algebra.cpp only, and called from here.

/// Eigenvalues of a symmetric matrix in ascending order, and its orthonormal eigenvectors as columns.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};

/// Only the lower triangle is read. Cost: n^3.
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a real square matrix, in no order (LAPACK's dgeev); all NaN where it does not
/// converge or the matrix is not finite. Cost: n^3.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// Solution x of A x = b for a symmetric A that is positive or negative semidefinite (LDL^T with pivots); the columns
/// of `right` are solved for one by one. Cost: n^3.
Eigen::MatrixXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Inverse of a symmetric matrix by LDL^T with pivots.
Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& matrix);

/// Solution and inverse of a symmetric system (LDL^T with pivots), and how far it is from singular.
struct SymmetricSystem {
  Eigen::VectorXd x;
  Eigen::MatrixXd inverse;
  double reciprocal_condition = 0;  ///< estimate, in the 1-norm; 0: no solution, all zero
};
SymmetricSystem solve_symmetric_system(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

/// Inverse of a square matrix by QR; it must be regular.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& matrix);

/// x that makes |A x - b| least, for a design of full column rank (QR without pivots); the solution where A is square.
/// Cost: m n^2.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& design, const Eigen::VectorXd& right);

/// The same for a design of any rank (QR with column pivots).
struct RankedSolution {
  Eigen::VectorXd x;
  Eigen::Index rank = 0;
};
RankedSolution least_squares_of_any_rank(const Eigen::MatrixXd& design, const Eigen::VectorXd& right);

/// R^-1 of the QR of a design of full column rank. (A'A)^-1 is its product with its transpose, and A'A is never formed,
/// which would cost half the digits.
Eigen::MatrixXd inverse_triangular_factor(const Eigen::MatrixXd& design);

/// Columns that with those of `matrix` (m x n, of full column rank) span all of m dimensions, orthonormal and
/// orthogonal to them: m x (m - n).
Eigen::MatrixXd orthogonal_complement(const Eigen::MatrixXd& matrix);

/// L^-1 b for a symmetric positive definite A = L L'.
Eigen::MatrixXd solve_lower_factor(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right);

/// Sum of x y over n numbers. Short ones are common here, for which Eigen takes much longer to begin.
double dot(const double* x, const double* y, Eigen::Index n);

/// R of the QR of a matrix, n x n, with zero rows below where it has fewer rows than columns: R'R = A'A. The matrix is
/// overwritten. Made for few columns, where Householder's reflections column by column take a third of Eigen's time.
Eigen::MatrixXd triangular_factor(Eigen::MatrixXd& matrix);
/// The same into `factor`, another matrix: a loop over many asks for its memory once.
void triangular_factor(Eigen::MatrixXd& matrix, Eigen::MatrixXd& factor);

}  // namespace tribofit
