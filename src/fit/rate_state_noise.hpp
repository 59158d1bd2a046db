#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <numeric>
#include <optional>
#include <vector>

#include "rate_state_steps.hpp"
#include "statistics/wandering_noise.hpp"

namespace tribofit::fit {

/// Covariance of values that are weighted sums of the noise, with the freedom of each variance: few independent values
/// of what wanders lie in a record.
struct Errors {
  Eigen::MatrixXd covariance;
  std::vector<double> freedom;
};

/// Root of the mean square of what is left behind the steps over that elsewhere, and the chance that noise makes it so
/// large.
struct Excess {
  double factor = 1, p_value = 1;
};

/// What a solution leaves of the steps of a problem, its noise, and what that noise does to the values fitted.
class FitErrors {
 public:
  FitErrors(const RateStateProblem& problem, const std::vector<double>& p);

  bool valid() const { return valid_; }
  const NoisySeries series() const { return {times_, counts_, begins_}; }
  /// Of the samples, those that a value stands for included.
  double sum_of_squares() const;
  /// Columns of the times that were fitted, behind those of the unknowns, and what turns at each.
  const std::vector<Eigen::Index>& times() const { return time_columns_; }
  const std::vector<Turn>& turns() const { return turns_; }
  double count() const { return std::accumulate(counts_.begin(), counts_.end(), 0.0); }

  /// Noise of what is left; the free unknowns, and the times, are those whose columns are kept.
  WanderingNoise noise(const std::vector<Eigen::Index>& free) const;

  /// Minus twice the logarithm of the likelihood of what is left, with that noise.
  double whitened(const WanderingNoise& noise) const;

  /// The same of friction that does not answer the steps: all of it is left.
  double whitened_without_answer(const WanderingNoise& noise) const;

  /// Rows by which the noise moves the free unknowns.
  Eigen::MatrixXd influence(const std::vector<Eigen::Index>& free) const;

  /// Constant and slope of the k-th step, and the rows by which the noise moves them.
  Eigen::VectorXd own_values(std::size_t k, const std::vector<Eigen::Index>& free, const Eigen::MatrixXd& influence,
                             Eigen::MatrixXd& rows) const;

  /// What is left while a contact adapts to a step or a hold, over what is left elsewhere. Noise knows nothing of the
  /// steps, so that a law that describes them leaves as much behind them as elsewhere, however the noise wanders. That
  /// noise is the one elsewhere: what a law that fails leaves behind the steps wanders too. distance: of the load
  /// point, over which the contact adapts. Nothing where there are too few independent values on either side.
  std::optional<Excess> excess_behind_steps(double distance, const std::vector<Eigen::Index>& free) const;

  Errors errors_of(const Eigen::MatrixXd& rows, const WanderingNoise& noise) const;

 private:
  /// Columns of the times of steps that were fitted; false where sliding runs away.
  bool add_times(const std::vector<double>& p);

  std::size_t end_of(std::size_t k) const { return k + 1 < begins_.size() ? begins_[k + 1] : times_.size(); }

  /// Noise of what is left at some of the values.
  template <class IsSelected>
  WanderingNoise noise_of_rows(const std::vector<Eigen::Index>& free, const IsSelected& is_selected) const;

  /// Of the mean of `count` samples over a time that lasts.
  static double variance_of_mean(double lasts, double count, const WanderingNoise& noise);

  /// Constant and slope of each step, one below the other.
  Eigen::MatrixXd own_columns() const;

  const RateStateProblem& problem_;
  const RateStateData& data_;
  Eigen::Index rows_;
  bool valid_ = false;
  Eigen::VectorXd residual_, friction_, root_count_;
  RowMatrix weighted_, derivatives_;
  std::vector<double> times_, counts_;
  std::vector<std::size_t> begins_;
  std::vector<Eigen::Index> time_columns_;
  std::vector<Turn> turns_;
};

}  // namespace tribofit::fit
