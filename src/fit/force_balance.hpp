#pragma once

#include <Eigen/Dense>
#include <cstddef>
#include <string>
#include <vector>

#include "tribofit/fit/rig.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/segmentation/cycles.hpp"

namespace tribofit {

/// Normal force of every sample; `known` is false where friction is a coefficient and no load is known (it is 1 then).
struct NormalForce {
  std::vector<double> channel;  ///< empty: constant
  double constant = 1;
  bool known = true;
  bool nominal = false;  ///< the stated load was used
  double mean = 1;
  double at(std::size_t i) const { return channel.empty() ? constant : channel[i]; }
};
NormalForce normal_force(const Motion& motion);

/// Columns of the force balance.
enum BalanceColumn { kAcceleration, kVelocity, kDisplacement, kIntegral, kJerk, kForce, kBalanceColumns };

/// The force balance under one test function a row, unit of evidence by unit of evidence; in each, what is constant and
/// what goes straight with time is taken off every column.
struct Balance {
  std::vector<Eigen::MatrixXd> blocks;  ///< rows x kBalanceColumns
  std::vector<SampleRange> spans;       ///< samples of each block
  /// Covariance of what is noise in velocity, acceleration and jerk (zero for the other columns): their scatter in
  /// stick, where they are straight, or that of white noise where nothing sticks.
  Eigen::MatrixXd noise = Eigen::MatrixXd::Zero(kBalanceColumns, kBalanceColumns);
  double force_noise = 0;  ///< variance of kForce in stick [N^2]; 0 where nothing sticks
  double width = 0;        ///< of the test functions [s]
};

/// Stretches of samples that are one unit of evidence each: from the middle of a stick to that of the next, or, where
/// nothing sticks, pieces of at least two periods. Those shorter than `least` samples are joined to the next.
std::vector<SampleRange> balance_blocks(const Motion& motion, const Segmentation& segmentation, std::size_t least);

/// Period of the free block as the slips or the spectrum suggest it [s]; 0 where nothing does.
double period_guess(const Motion& motion, const Segmentation& segmentation);

/// period: of the free block [s]; the test functions are about a fifth of it wide.
Balance force_balance(const Motion& motion, const Segmentation& segmentation, const NormalForce& load, double period);

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

/// Why these values cannot be those of a rig; empty where they can.
std::string why_impossible(const RigFit& fit);

/// What a person should know of the values.
void add_messages(const Motion& motion, const Segmentation& segmentation, const Instruments& instruments, RigFit& fit);

}  // namespace tribofit
