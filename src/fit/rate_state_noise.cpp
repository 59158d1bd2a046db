#include "rate_state_noise.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {

FitErrors::FitErrors(const RateStateProblem& problem, const std::vector<double>& p)
    : problem_(problem), data_(problem.data()), rows_(static_cast<Eigen::Index>(problem.count())) {
  residual_.resize(rows_);
  valid_ = problem.evaluate(p.data(), residual_.data(), nullptr) &&
           problem.response(p.data(), friction_, &derivatives_) && add_times(p);
  if (valid_) {
    weighted_ = derivatives_;
    problem.weigh(weighted_);
    valid_ = weighted_.allFinite();
  }
  root_count_.resize(rows_);
  for (Eigen::Index i = 0; i < rows_; ++i) {
    const std::size_t value = problem.value_of(static_cast<std::size_t>(i));
    times_.push_back(data_.time[value]);
    counts_.push_back(data_.count[value]);
    root_count_(i) = std::sqrt(data_.count[value]);
  }
  for (std::size_t k = 0; k < problem.steps().size(); ++k) begins_.push_back(problem.row_of(k));
}

double FitErrors::sum_of_squares() const {
  double sum = residual_.squaredNorm();
  for (Eigen::Index i = 0; i < rows_; ++i) sum += data_.scatter[problem_.value_of(static_cast<std::size_t>(i))];
  return sum;
}

WanderingNoise FitErrors::noise(const std::vector<Eigen::Index>& free) const {
  return noise_of_rows(free, [](std::size_t) { return true; });
}

double FitErrors::whitened(const WanderingNoise& noise) const {
  return whitened_squares(series(), residual_.cwiseQuotient(root_count_), own_columns(), noise);
}

double FitErrors::whitened_without_answer(const WanderingNoise& noise) const {
  RowMatrix all(rows_, 1);
  for (Eigen::Index i = 0; i < rows_; ++i) all(i, 0) = data_.friction[problem_.value_of(static_cast<std::size_t>(i))];
  problem_.weigh(all);
  return whitened_squares(series(), all.col(0).cwiseQuotient(root_count_), own_columns(), noise);
}

Eigen::MatrixXd FitErrors::influence(const std::vector<Eigen::Index>& free) const {
  Eigen::MatrixXd kept(rows_, static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k) kept.col(static_cast<Eigen::Index>(k)) = weighted_.col(free[k]);
  const Eigen::VectorXd scale = kept.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  kept *= scale.asDiagonal();
  const Eigen::MatrixXd inverse = inverse_triangular_factor(kept);
  Eigen::MatrixXd out = kept * (inverse * inverse.transpose()) * scale.asDiagonal();
  for (Eigen::Index i = 0; i < rows_; ++i) out.row(i) *= root_count_(i);
  return out;
}

Eigen::VectorXd FitErrors::own_values(std::size_t k, const std::vector<Eigen::Index>& free,
                                      const Eigen::MatrixXd& influence, Eigen::MatrixXd& rows) const {
  const auto begin = static_cast<Eigen::Index>(begins_[k]);
  Eigen::MatrixXd design = problem_.design_of(k);
  const Eigen::Index n = design.rows(), q = design.cols();
  const Eigen::VectorXd weights = root_count_.segment(begin, n);
  Eigen::VectorXd right(n);
  Eigen::MatrixXd by_free(n, static_cast<Eigen::Index>(free.size()));
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t value = problem_.value_of(static_cast<std::size_t>(begin + i));
    right(i) = weights(i) * (data_.friction[value] - friction_(begin + i));
    for (std::size_t c = 0; c < free.size(); ++c)
      by_free(i, static_cast<Eigen::Index>(c)) = weights(i) * derivatives_(begin + i, free[c]);
    design.row(i) *= weights(i);
  }
  const Eigen::VectorXd scale = design.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  design *= scale.asDiagonal();
  const Eigen::MatrixXd inverse = inverse_triangular_factor(design);
  const Eigen::MatrixXd normal = scale.asDiagonal() * (inverse * inverse.transpose());
  rows = -influence * (normal * (design.transpose() * by_free)).transpose();
  for (Eigen::Index i = 0; i < n; ++i) rows.row(begin + i) += weights(i) * (design.row(i) * normal.transpose());
  rows.conservativeResize(Eigen::NoChange, q);
  return normal * (design.transpose() * right);
}

std::optional<Excess> FitErrors::excess_behind_steps(double distance, const std::vector<Eigen::Index>& free) const {
  std::vector<bool> adapts(times_.size());
  for (std::size_t k = 0; k < begins_.size(); ++k) {
    const VelocityStep& step = data_.steps[problem_.steps()[k]];
    for (std::size_t i = begins_[k]; i < end_of(k); ++i) {
      const double moved = data_.displacement[problem_.value_of(i)] - step.displacement;
      adapts[i] = times_[i] > step.time && moved < distance;  // through a hold the load point does not move
    }
  }
  const WanderingNoise noise = noise_of_rows(free, [&](std::size_t i) { return !adapts[i]; });
  if (!(noise.white > 0)) return std::nullopt;
  double squares[2] = {0, 0}, values[2] = {0, 0}, independent[2] = {0, 0};
  for (std::size_t k = 0; k < begins_.size(); ++k) {
    for (std::size_t i = begins_[k]; i < end_of(k); ++i) {
      const double lasts = i + 1 < end_of(k) ? times_[i + 1] - times_[i] : times_[i] - times_[i - 1];
      const double left = residual_(static_cast<Eigen::Index>(i)) / root_count_(static_cast<Eigen::Index>(i));
      const std::size_t where = adapts[i] ? 0 : 1;
      squares[where] += left * left / variance_of_mean(lasts, counts_[i], noise);
      values[where] += 1;
      independent[where] += noise.time > 0 ? std::min(1.0, lasts / (2 * noise.time)) : 1;
    }
  }
  independent[1] -= static_cast<double>(begins_.size() * static_cast<std::size_t>(problem_.design_of(0).cols()));
  if (independent[0] < kFewestFreeVariances || independent[1] < kFewestFreeVariances) return std::nullopt;
  const double ratio = squares[0] / values[0] / (squares[1] / values[1]);
  if (!(ratio > 0) || !std::isfinite(ratio)) return std::nullopt;
  return Excess{std::sqrt(ratio), f_p_value(ratio, independent[0], independent[1])};
}

Errors FitErrors::errors_of(const Eigen::MatrixXd& rows, const WanderingNoise& noise) const {
  const NoiseMoments moments = noise_moments(series(), rows, noise);
  Errors out{moments.white + moments.slow, {}};
  double independent = 0;
  for (std::size_t k = 0; k < begins_.size() && noise.time > 0; ++k) {
    const std::size_t end = k + 1 < begins_.size() ? begins_[k + 1] : times_.size();
    independent += (times_[end - 1] - times_[begins_[k]]) / (2 * noise.time);
  }
  const double of_slow = std::max(2.0, independent), of_white = std::max(2.0, count());
  for (Eigen::Index i = 0; i < rows.cols(); ++i) {
    const double all = out.covariance(i, i), slow = all > 0 ? moments.slow(i, i) / all : 0;
    out.freedom.push_back(1 / (slow * slow / of_slow + (1 - slow) * (1 - slow) / of_white));
  }
  return out;
}

bool FitErrors::add_times(const std::vector<double>& p) {
  for (const Turn& turn : free_turns(data_)) {
    if (std::find(problem_.steps().begin(), problem_.steps().end(), turn.step) == problem_.steps().end()) continue;
    const Eigen::VectorXd column = response_by_time(problem_, p, turn);
    if (column.size() == 0) return false;
    if (!(column.squaredNorm() > 0)) continue;  // nothing tells of it
    turns_.push_back(turn);
    time_columns_.push_back(derivatives_.cols());
    derivatives_.conservativeResize(Eigen::NoChange, derivatives_.cols() + 1);
    derivatives_.rightCols(1) = column;
  }
  return true;
}

template <class IsSelected>
WanderingNoise FitErrors::noise_of_rows(const std::vector<Eigen::Index>& free, const IsSelected& is_selected) const {
  std::vector<Eigen::Index> rows;
  std::vector<double> times, counts;
  std::vector<std::size_t> begins;
  for (std::size_t k = 0; k < begins_.size(); ++k) {
    begins.push_back(rows.size());
    for (std::size_t i = begins_[k]; i < end_of(k); ++i) {
      if (!is_selected(i)) continue;
      rows.push_back(static_cast<Eigen::Index>(i));
      times.push_back(times_[i]);
      counts.push_back(counts_[i]);
    }
  }
  const Eigen::VectorXd left = residual_(rows).cwiseQuotient(root_count_(rows));
  Eigen::MatrixXd jacobian(left.size(), static_cast<Eigen::Index>(free.size()));
  for (std::size_t k = 0; k < free.size(); ++k)
    jacobian.col(static_cast<Eigen::Index>(k)) = weighted_(rows, free[k]).cwiseQuotient(root_count_(rows));
  const Eigen::VectorXd scale = jacobian.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
  jacobian *= scale.asDiagonal();
  return estimate_noise({times, counts, begins}, left, jacobian, own_columns()(rows, Eigen::all));
}

double FitErrors::variance_of_mean(double lasts, double count, const WanderingNoise& noise) {
  const double white = noise.white * noise.white / count;
  if (!(noise.time > 0)) return white;
  const double times = count > 1 ? lasts / noise.time : 0;  // a sample is no mean
  const double kept = times > 1e-3 ? 2 / times * (1 - (1 - std::exp(-times)) / times) : 1;
  return white + noise.slow * noise.slow * kept;
}

Eigen::MatrixXd FitErrors::own_columns() const {
  Eigen::MatrixXd own(rows_, problem_.design_of(0).cols());
  for (std::size_t k = 0; k < begins_.size(); ++k) {
    Eigen::MatrixXd design = problem_.design_of(k);
    for (Eigen::Index c = 0; c < design.cols(); ++c) design.col(c) /= std::max(design.col(c).norm(), 1e-300);
    own.middleRows(static_cast<Eigen::Index>(begins_[k]), design.rows()) = design;
  }
  return own;
}

}  // namespace tribofit::fit
