#include "linear_algebra.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
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
  // LAPACK prints and ends the process.
  if (!matrix.allFinite()) {
    return Eigen::VectorXcd::Constant(matrix.rows(), std::numeric_limits<double>::quiet_NaN());
  }
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

namespace {

using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;

Pair pair_at(const double* x) {
  Pair out;
  std::memcpy(&out, x, sizeof out);
  return out;
}

void subtract(double factor, const double* x, double* y, Eigen::Index n) {
  Eigen::Index i = 0;
  for (; i + 2 <= n; i += 2) {
    const Pair out = pair_at(y + i) - Pair{factor, factor} * pair_at(x + i);
    std::memcpy(y + i, &out, sizeof out);
  }
  if (i < n) y[i] -= factor * x[i];
}

}  // namespace

double dot(const double* x, const double* y, Eigen::Index n) {
  Pair sums[4] = {};  // hide the latency of the addition
  Eigen::Index i = 0;
  for (; i + 8 <= n; i += 8) {
    sums[0] += pair_at(x + i) * pair_at(y + i);
    sums[1] += pair_at(x + i + 2) * pair_at(y + i + 2);
    sums[2] += pair_at(x + i + 4) * pair_at(y + i + 4);
    sums[3] += pair_at(x + i + 6) * pair_at(y + i + 6);
  }
  for (; i + 2 <= n; i += 2) sums[0] += pair_at(x + i) * pair_at(y + i);
  const Pair all = (sums[0] + sums[1]) + (sums[2] + sums[3]);
  double sum = all[0] + all[1];
  for (; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

MatrixXd triangular_factor(MatrixXd& matrix) {
  MatrixXd factor;
  triangular_factor(matrix, factor);
  return factor;
}

void triangular_factor(MatrixXd& matrix, MatrixXd& factor) {
  const Eigen::Index rows = matrix.rows(), columns = matrix.cols(), kept = std::min(rows, columns);
  for (Eigen::Index k = 0; k < kept; ++k) {
    double* v = &matrix(k, k);
    const Eigen::Index n = rows - k;
    const double below = dot(v + 1, v + 1, n - 1), head = v[0];
    if (!(below > std::numeric_limits<double>::min())) continue;
    const double length = std::copysign(std::sqrt(head * head + below), head);
    v[0] = head + length;
    const double scale = 1 / (length * v[0]);  // 2/v'v
    for (Eigen::Index j = k + 1; j < columns; ++j) {
      double* column = &matrix(k, j);
      subtract(scale * dot(v, column, n), v, column, n);
    }
    v[0] = -length;
  }
  factor.setZero(columns, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    for (Eigen::Index i = 0; i <= std::min(j, kept - 1); ++i) factor(i, j) = matrix(i, j);
  }
}

}  // namespace tribofit
