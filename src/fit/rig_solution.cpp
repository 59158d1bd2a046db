#include "rig_solution.hpp"

#include <cmath>

#include "statistics/linear_algebra.hpp"

namespace tribofit {
namespace {

/// Columns of a solution from those of the balance, as one matrix: each column of it is one unknown's.
Eigen::MatrixXd selection(const std::vector<BalanceColumn>& columns, const Eigen::Vector3d& theta) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(kBalanceColumns, Eigen::Index(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    if (columns[k] == kJerk) {
      out(kJerk, c) = theta(0);
      out(kAcceleration, c) = theta(1);
      out(kVelocity, c) = theta(2);
    } else {
      out(columns[k], c) = 1;
    }
  }
  return out;
}

/// Inverse of a symmetric matrix whose columns have units of their own; nothing where it is not positive definite.
bool invert(const Eigen::MatrixXd& matrix, Eigen::MatrixXd& inverse) {
  constexpr double kRounding = 1e-11;
  if (!(matrix.diagonal().array() > 0).all()) return false;
  const Eigen::VectorXd scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(scaled);
  if (!(eigen.values(0) > kRounding)) return false;
  inverse = scale.asDiagonal() * eigen.vectors * eigen.values.cwiseInverse().asDiagonal() * eigen.vectors.transpose() *
            scale.asDiagonal();
  return true;
}

}  // namespace

BalanceSolution solve_balance(const Balance& balance, std::vector<BalanceColumn> columns,
                              const Eigen::Vector3d& theta) {
  BalanceSolution out;
  out.columns = std::move(columns);
  const Eigen::MatrixXd selected = selection(out.columns, theta);
  const Eigen::MatrixXd noise = selected.transpose() * balance.noise * selected;
  const Eigen::Index p = selected.cols(), n = Eigen::Index(balance.blocks.size());
  std::vector<Eigen::MatrixXd> products;
  std::vector<Eigen::VectorXd> sides;
  Eigen::MatrixXd total = Eigen::MatrixXd::Zero(p, p), raw = total;
  Eigen::VectorXd side = Eigen::VectorXd::Zero(p);
  double squares = 0, rows = 0;
  for (const Eigen::MatrixXd& block : balance.blocks) {
    const Eigen::MatrixXd x = block * selected;
    const auto freedom = static_cast<double>(block.rows() - 2);
    products.push_back(x.transpose() * x - freedom * noise);
    sides.push_back(x.transpose() * block.col(kForce));
    total += products.back();
    side += sides.back();
    squares += block.col(kForce).squaredNorm();
    rows += freedom;
  }
  raw = total + rows * noise;
  Eigen::MatrixXd inverse, raw_inverse;
  if (n < 3 || !invert(total, inverse) || !invert(raw, raw_inverse)) return out;
  out.values = inverse * side;
  out.noise_share = rows * noise.diagonal().cwiseProduct(raw_inverse.diagonal());
  out.rmse = std::sqrt(std::max(0.0, squares - 2 * out.values.dot(side) + out.values.dot(raw * out.values)) / rows);
  if (out.columns.back() != kJerk) {
    Eigen::VectorXd late = Eigen::VectorXd::Zero(p);
    const Eigen::MatrixXd slope = selection({kJerk}, out.values.head(3));
    for (const Eigen::MatrixXd& block : balance.blocks)
      late -= selected.transpose() * block.transpose() * block * slope;
    out.per_delay = inverse * late;
  }
  out.influence.resize(n, p);
  for (Eigen::Index b = 0; b < n; ++b) {
    Eigen::MatrixXd without;
    if (!invert(total - products[std::size_t(b)], without)) return out;
    out.influence.row(b) =
        static_cast<double>(n - 1) * (out.values - without * (side - sides[std::size_t(b)])).transpose();
  }
  out.solved = true;
  return out;
}

}  // namespace tribofit
