#include "linear_algebra.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <limits>

// LAPACK, which Ceres brings: Eigen's own solver for matrices without symmetry takes ten seconds to compile.
extern "C" void dgeev_(const char* want_left, const char* want_right, const int* n, double* matrix, const int* rows,
                       double* real, double* imaginary, double* left, const int* left_rows, double* right,
                       const int* right_rows, double* work, const int* work_size, int* info, std::size_t letters_left,
                       std::size_t letters_right);

namespace tribofit {

using Eigen::MatrixXd;
using Eigen::VectorXd;

SymmetricEigen symmetric_eigen(const MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(const MatrixXd& matrix) {
  if (matrix.size() == 0) return {};
  MatrixXd overwritten = matrix;
  const int n = static_cast<int>(matrix.rows()), unused = 1, work_size = 4 * n;
  VectorXd real(n), imaginary(n), work(work_size);
  int info = 0;
  dgeev_("N", "N", &n, overwritten.data(), &n, real.data(), imaginary.data(), nullptr, &unused, nullptr, &unused,
         work.data(), &work_size, &info, 1, 1);
  if (info != 0) return Eigen::VectorXcd::Constant(n, std::numeric_limits<double>::quiet_NaN());
  Eigen::VectorXcd values(n);
  values.real() = real;
  values.imag() = imaginary;
  return values;
}

MatrixXd solve_symmetric(const MatrixXd& matrix, const MatrixXd& right) {
  return matrix.ldlt().solve(right);
}

MatrixXd inverse_of_symmetric(const MatrixXd& matrix) {
  return solve_symmetric(matrix, MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

SymmetricSystem solve_symmetric_system(const MatrixXd& matrix, const VectorXd& right) {
  SymmetricSystem out{VectorXd::Zero(matrix.rows()), MatrixXd::Zero(matrix.rows(), matrix.cols())};
  const Eigen::LDLT<MatrixXd> solver(matrix);
  if (solver.info() != Eigen::Success) return out;
  out.reciprocal_condition = solver.rcond();
  out.inverse = solver.solve(MatrixXd::Identity(matrix.rows(), matrix.cols()));
  out.x = solver.solve(right);
  return out;
}

MatrixXd inverse_of(const MatrixXd& matrix) {
  return matrix.householderQr().solve(MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

VectorXd least_squares(const MatrixXd& design, const VectorXd& right) {
  return design.householderQr().solve(right);
}

RankedSolution least_squares_of_any_rank(const MatrixXd& design, const VectorXd& right) {
  const Eigen::ColPivHouseholderQR<MatrixXd> qr(design);
  return {qr.solve(right), qr.rank()};
}

MatrixXd inverse_triangular_factor(const MatrixXd& design) {
  const Eigen::Index n = design.cols();
  const Eigen::HouseholderQR<MatrixXd> qr(design);
  const MatrixXd r = qr.matrixQR().topRows(n).triangularView<Eigen::Upper>();
  return r.triangularView<Eigen::Upper>().solve(MatrixXd::Identity(n, n));
}

MatrixXd orthogonal_complement(const MatrixXd& matrix) {
  const MatrixXd q = Eigen::HouseholderQR<MatrixXd>(matrix).householderQ();
  return q.rightCols(matrix.rows() - matrix.cols());
}

MatrixXd solve_lower_factor(const MatrixXd& matrix, const MatrixXd& right) {
  return Eigen::LLT<MatrixXd>(matrix).matrixL().solve(right);
}

MatrixXd triangular_factor(const MatrixXd& matrix) {
  const Eigen::Index kept = std::min(matrix.rows(), matrix.cols());
  MatrixXd out = MatrixXd::Zero(matrix.cols(), matrix.cols());
  out.topRows(kept) = Eigen::HouseholderQR<MatrixXd>(matrix).matrixQR().topRows(kept).triangularView<Eigen::Upper>();
  return out;
}

}  // namespace tribofit
