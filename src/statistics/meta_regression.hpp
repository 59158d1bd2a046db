#pragma once

#include <Eigen/Core>

namespace tribofit {

/// Regression of estimates that have errors of their own and scatter beyond them:
/// y_i = x_i' b + u_i + e_i, var e_i = v_i known, var u_i = tau^2 found from the data.
struct MetaRegression {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;     ///< of the coefficients, statistical and between-run parts together
  Eigen::VectorXd statistical;    ///< standard errors that the v_i alone would leave
  double between = 0;             ///< tau: standard deviation between runs beyond their own errors
  double degrees_of_freedom = 0;  ///< of the t distribution of the coefficients; 0: there are no more runs than columns
};

/// tau^2 makes the weighted squares what they are expected to be (R. C. Paule, J. Mandel, J. Res. NBS 87 (1982) 377,
/// doi:10.6028/jres.087.022), and the errors are scaled by what the squares then are, with t of n - p degrees of
/// freedom (G. Knapp, J. Hartung, Stat. Med. 22 (2003) 2693, doi:10.1002/sim.1482), which covers where a few runs say
/// what tau is. With no more rows than columns: tau = 0 and the statistical errors alone. y: n values; variance: n, >
/// 0; design: n x p of full column rank. Cost: n p^2.
MetaRegression meta_regression(const Eigen::VectorXd& y, const Eigen::VectorXd& variance,
                               const Eigen::MatrixXd& design);

}  // namespace tribofit
