#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "model_residuals.hpp"
#include "tribofit/statistics/slow_noise.hpp"

namespace tribofit {

/// Normal equations of a fit, cycle by cycle, at one point p.
struct NormalEquations {
  std::vector<Eigen::MatrixXd> curvature;  ///< J'J of each cycle
  std::vector<Eigen::VectorXd> gradient;   ///< J'r of each cycle
  /// The part of it that acts through the mean of the levels: it moves mu_s alone, and leaving the cycle out does not
  /// change that.
  std::vector<Eigen::VectorXd> level_gradient;
  Eigen::MatrixXd total;  ///< sum of the curvatures
  bool finite = false;    ///< the model could be evaluated at p

  /// Parameters the data say nothing about: their column of J is zero.
  std::vector<bool> unconstrained() const;
};

/// Evaluates the residuals and their derivatives once. Cost: one pass over the slips per eight parameters.
NormalEquations normal_equations(const ModelResiduals& residuals, const Observations& observations,
                                 const std::vector<double>& p);

/// Influence of each cycle on the free parameters: cycles x parameters, scaled so that the estimate's error is
/// the mean over cycles. Row c is minus n (H - H_c)^-1 J_c' r_c, the jackknife pseudo-value of one Newton step.
/// `free`: which parameters are estimated; the columns of the others are zero.
Eigen::MatrixXd influence(const NormalEquations& equations, const std::vector<bool>& free);

/// Parameters of which the data fix combinations only: the directions in which `total` is zero but for rounding, as
/// groups. One parameter of each group is taken out of `free`, so that the others have errors beside it.
std::vector<std::vector<std::size_t>> undetermined(const Eigen::MatrixXd& total, std::vector<bool>& free);

/// The change of the parameters of a model by which all friction rises in proportion.
Eigen::VectorXd level_change(const FrictionModel& model, const std::vector<double>& p);

/// What friction does slowly from cycle to cycle beside a fit, and how it moves the parameters.
struct SlowLevels {
  SlowNoise noise;            ///< of the levels, in parts of friction
  Eigen::MatrixXd influence;  ///< of the level of each cycle on each parameter: cycles x parameters
};
/// known_flicker: Observations::flicker.
SlowLevels slow_levels(const NormalEquations& equations, const Eigen::VectorXd& level, const std::vector<bool>& free,
                       double known_flicker);

/// What the influences say of the parameters. An error is no smaller than slow noise makes it beside scatter that is
/// independent from cycle to cycle.
struct Spread {
  Eigen::VectorXd std_error, degrees_of_freedom;
  Eigen::MatrixXd covariance;
};
Spread spread_of(const Eigen::MatrixXd& influence, const SlowLevels& slow = {});

/// The inverse of `kept` over the free parameters, along directions about which `kept` knows at least a tenth of what
/// `total` knows; nothing along the others.
Eigen::MatrixXd inverse_where_known(const Eigen::MatrixXd& kept, const Eigen::MatrixXd& total,
                                    const std::vector<bool>& free);

/// Inverse of the block of `matrix` over the free parameters, zeros elsewhere; stable when nearly singular.
Eigen::MatrixXd inverse_over(const Eigen::MatrixXd& matrix, const std::vector<bool>& free);

}  // namespace tribofit
