#pragma once

#include <Eigen/Dense>
#include <vector>

#include "force_balance.hpp"

namespace tribofit {

/// Least squares of a force balance over the columns chosen, noise of the columns taken off the normal equations.
struct BalanceSolution {
  bool solved = false;
  std::vector<BalanceColumn> columns;
  Eigen::VectorXd values;
  Eigen::MatrixXd influence;    ///< blocks x values: jackknife pseudo-values about zero
  Eigen::VectorXd noise_share;  ///< of what each column has for itself, how much is noise
  /// How much a force recorded one second late moves the values [1/s], to first order; without kJerk among the columns.
  Eigen::VectorXd per_delay;
  double rmse = 0;
};

/// derivative: where the columns end with kJerk, the balance's own derivative m v'' + c v' + k v by `theta` = (m, c, k)
/// takes its place, whose coefficient is minus the delay of the force [s].
BalanceSolution solve_balance(const Balance& balance, std::vector<BalanceColumn> columns,
                              const Eigen::Vector3d& theta = Eigen::Vector3d::Zero());

}  // namespace tribofit
