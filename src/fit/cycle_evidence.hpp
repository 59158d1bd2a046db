#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <vector>

#include "model_residuals.hpp"
#include "tribofit/statistics/slow_noise.hpp"

namespace tribofit {

/// What each cycle says of a model near one point p: its normal equations. Steps, held-out squares and errors follow
/// from them; the residuals are not looked at again.
struct CycleEvidence {
  std::vector<Eigen::MatrixXd> curvature;  ///< J'J of each cycle
  std::vector<Eigen::VectorXd> gradient;   ///< J'r of each cycle
  std::vector<double> squares;             ///< r'r of each cycle; empty from evidence_at()
  /// The part of the gradient that acts through the mean of the levels: it moves mu_s alone, and leaving the cycle out
  /// does not change that. Empty from evidence_of().
  std::vector<Eigen::VectorXd> level_gradient;
  Eigen::MatrixXd total;       ///< sum of the curvatures
  Eigen::VectorXd level = {};  ///< change of the parameters that raises all friction alike; empty: none known
  double known_flicker = 0;    ///< power of 1/f noise of that level, which the record shows without any model
  bool finite = false;         ///< the model could be evaluated at p

  /// Parameters the data say nothing about: their column of J is zero.
  std::vector<bool> unconstrained() const;
};

/// Evaluates the residuals and their derivatives once. Cost: one pass over the slips per eight parameters.
CycleEvidence evidence_at(const ModelResiduals& residuals, const Observations& observations,
                          const std::vector<double>& p);

/// The same from rows [J r] of each cycle; not finite where there are none.
CycleEvidence evidence_of(const std::vector<Eigen::MatrixXd>& rows);

/// The change of the parameters of a model by which all friction rises in proportion.
Eigen::VectorXd level_change(const FrictionModel& model, const std::vector<double>& p);

/// Sums over the cycles that are not in block `held`. block_of_cycle: empty: over all cycles.
struct NormalSum {
  Eigen::MatrixXd curvature;
  Eigen::VectorXd gradient;
};
NormalSum sum_of(const CycleEvidence& evidence, const std::vector<std::size_t>& block_of_cycle = {},
                 std::size_t held = 0);

/// Columns B over the free parameters with B' total B = 1, without the directions that the data do not determine.
Eigen::MatrixXd known_directions(const Eigen::MatrixXd& total, const std::vector<bool>& free);

/// The inverse of `kept` along the directions about which it knows at least a tenth of what all cycles know; nothing
/// along the others. directions: known_directions() of all cycles.
Eigen::MatrixXd inverse_where_known(const Eigen::MatrixXd& kept, const Eigen::MatrixXd& directions);

/// Inverse of the block of `matrix` over the free parameters, zeros elsewhere; stable when nearly singular.
Eigen::MatrixXd inverse_over(const Eigen::MatrixXd& matrix, const std::vector<bool>& free);

/// Step of the free parameters that minimises the squares of all cycles.
Eigen::VectorXd gauss_newton_step(const CycleEvidence& evidence, const std::vector<bool>& free);

/// The same of all parameters within bounds on the step: those that would leave them go to their bound and the others
/// follow.
Eigen::VectorXd bounded_step(const CycleEvidence& evidence, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

/// Squares of each cycle after a step, and the evidence there.
std::vector<double> squares_after(const CycleEvidence& evidence, const Eigen::VectorXd& step);
CycleEvidence moved(CycleEvidence evidence, const Eigen::VectorXd& step);

/// Squares of each cycle with the parameters that the other blocks suggest, by one step: along directions about which
/// they know at least a tenth of what all cycles know.
std::vector<double> held_out_squares(const CycleEvidence& evidence, const std::vector<bool>& free,
                                     const std::vector<std::size_t>& block_of_cycle);

/// Influence of each cycle on the free parameters: cycles x parameters, scaled so that the estimate's error is
/// the mean over cycles. Row c is minus n (H - H_c)^-1 J_c' r_c, the jackknife pseudo-value of one Newton step.
/// `free`: which parameters are estimated; the columns of the others are zero.
Eigen::MatrixXd influence(const CycleEvidence& evidence, const std::vector<bool>& free);

/// Parameters of which the data fix combinations only: the directions in which `total` is zero but for rounding, as
/// groups. One parameter of each group is taken out of `free`, so that the others have errors beside it.
std::vector<std::vector<std::size_t>> undetermined(const Eigen::MatrixXd& total, std::vector<bool>& free);

/// What the level of friction does slowly from cycle to cycle beside a model, in parts of friction.
SlowNoise slow_noise_of(const CycleEvidence& evidence);

/// The same, and how the level of each cycle moves the parameters: cycles x parameters. Nothing where no change of
/// level is known.
struct SlowLevels {
  SlowNoise noise;
  Eigen::MatrixXd influence;
};
SlowLevels slow_levels(const CycleEvidence& evidence, const std::vector<bool>& free);

/// What the influences say of the parameters. An error is no smaller than slow noise makes it beside scatter that is
/// independent from cycle to cycle.
struct Spread {
  Eigen::VectorXd std_error, degrees_of_freedom;
  Eigen::MatrixXd covariance;
};
Spread spread_of(const Eigen::MatrixXd& influence, const SlowLevels& slow = {});

}  // namespace tribofit
