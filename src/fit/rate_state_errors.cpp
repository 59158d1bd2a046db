#include "rate_state_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "limits.hpp"
#include "rate_state_times.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/wandering_noise.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {

namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

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

class FitErrors {
 public:
  FitErrors(const RateStateProblem& problem, const std::vector<double>& p)
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

  bool valid() const { return valid_; }
  const NoisySeries series() const { return {times_, counts_, begins_}; }
  /// Of the samples, those that a value stands for included.
  double sum_of_squares() const {
    double sum = residual_.squaredNorm();
    for (Eigen::Index i = 0; i < rows_; ++i) sum += data_.scatter[problem_.value_of(static_cast<std::size_t>(i))];
    return sum;
  }
  /// Columns of the times that were fitted, behind those of the unknowns.
  const std::vector<Eigen::Index>& times() const { return time_columns_; }
  double count() const { return std::accumulate(counts_.begin(), counts_.end(), 0.0); }

  /// Noise of what is left; the free unknowns, and the times, are those whose columns are kept.
  WanderingNoise noise(const std::vector<Eigen::Index>& free) const {
    return noise_of_rows(free, [](std::size_t) { return true; });
  }

  /// Minus twice the logarithm of the likelihood of what is left, with that noise.
  double whitened(const WanderingNoise& noise) const {
    return whitened_squares(series(), residual_.cwiseQuotient(root_count_), own_columns(), noise);
  }

  /// Rows by which the noise moves the free unknowns.
  Eigen::MatrixXd influence(const std::vector<Eigen::Index>& free) const {
    Eigen::MatrixXd kept(rows_, static_cast<Eigen::Index>(free.size()));
    for (std::size_t k = 0; k < free.size(); ++k) kept.col(static_cast<Eigen::Index>(k)) = weighted_.col(free[k]);
    const Eigen::VectorXd scale = kept.colwise().norm().transpose().cwiseMax(1e-300).cwiseInverse();
    kept *= scale.asDiagonal();
    const Eigen::MatrixXd inverse = inverse_triangular_factor(kept);
    Eigen::MatrixXd out = kept * (inverse * inverse.transpose()) * scale.asDiagonal();
    for (Eigen::Index i = 0; i < rows_; ++i) out.row(i) *= root_count_(i);
    return out;
  }

  /// Constant and slope of the k-th step, and the rows by which the noise moves them.
  Eigen::VectorXd own_values(std::size_t k, const std::vector<Eigen::Index>& free, const Eigen::MatrixXd& influence,
                             Eigen::MatrixXd& rows) const {
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

  /// What is left while a contact adapts to a step or a hold, over what is left elsewhere. Noise knows nothing of the
  /// steps, so that a law that describes them leaves as much behind them as elsewhere, however the noise wanders. That
  /// noise is the one elsewhere: what a law that fails leaves behind the steps wanders too. distance: of the load
  /// point, over which the contact adapts. Nothing where there are too few independent values on either side.
  std::optional<Excess> excess_behind_steps(double distance, const std::vector<Eigen::Index>& free) const {
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
    if (independent[0] < kFewestOfExcess || independent[1] < kFewestOfExcess) return std::nullopt;
    const double ratio = squares[0] / values[0] / (squares[1] / values[1]);
    if (!(ratio > 0) || !std::isfinite(ratio)) return std::nullopt;
    return Excess{std::sqrt(ratio), f_p_value(ratio, independent[0], independent[1])};
  }

  Errors errors_of(const Eigen::MatrixXd& rows, const WanderingNoise& noise) const {
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

 private:
  /// Columns of the times of steps that were fitted; false where sliding runs away.
  bool add_times(const std::vector<double>& p) {
    for (const Turn& turn : free_turns(data_)) {
      if (std::find(problem_.steps().begin(), problem_.steps().end(), turn.step) == problem_.steps().end()) continue;
      const Eigen::VectorXd column = response_by_time(problem_, p, turn);
      if (column.size() == 0) return false;
      if (!(column.squaredNorm() > 0)) continue;  // nothing tells of it
      time_columns_.push_back(derivatives_.cols());
      derivatives_.conservativeResize(Eigen::NoChange, derivatives_.cols() + 1);
      derivatives_.rightCols(1) = column;
    }
    return true;
  }

  std::size_t end_of(std::size_t k) const { return k + 1 < begins_.size() ? begins_[k + 1] : times_.size(); }

  /// Noise of what is left at some of the values.
  template <class IsSelected>
  WanderingNoise noise_of_rows(const std::vector<Eigen::Index>& free, const IsSelected& is_selected) const {
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

  /// Of the mean of `count` samples over a time that lasts.
  static double variance_of_mean(double lasts, double count, const WanderingNoise& noise) {
    const double white = noise.white * noise.white / count;
    if (!(noise.time > 0)) return white;
    const double times = count > 1 ? lasts / noise.time : 0;  // a sample is no mean
    const double kept = times > 1e-3 ? 2 / times * (1 - (1 - std::exp(-times)) / times) : 1;
    return white + noise.slow * noise.slow * kept;
  }

  /// Constant and slope of each step, one below the other.
  Eigen::MatrixXd own_columns() const {
    Eigen::MatrixXd own(rows_, problem_.design_of(0).cols());
    for (std::size_t k = 0; k < begins_.size(); ++k) {
      Eigen::MatrixXd design = problem_.design_of(k);
      for (Eigen::Index c = 0; c < design.cols(); ++c) design.col(c) /= std::max(design.col(c).norm(), 1e-300);
      own.middleRows(static_cast<Eigen::Index>(begins_[k]), design.rows()) = design;
    }
    return own;
  }

  const RateStateProblem& problem_;
  const RateStateData& data_;
  Eigen::Index rows_;
  bool valid_ = false;
  Eigen::VectorXd residual_, friction_, root_count_;
  RowMatrix weighted_, derivatives_;
  std::vector<double> times_, counts_;
  std::vector<std::size_t> begins_;
  std::vector<Eigen::Index> time_columns_;
};

void set_interval(const RateStateUnknowns& unknowns, std::size_t k, double searched, double error, double freedom,
                  FitParameter& out) {
  const double half = t_quantile_95(freedom) * error;
  out.lower95 = unknowns.value(k, searched - half);
  out.upper95 = unknowns.value(k, searched + half);
  out.std_error = unknowns.logarithmic[k] ? out.value * error : error;
  // Of a length or stiffness: known to a factor at least.
  out.determined = !unknowns.logarithmic[k] || out.upper95 / out.lower95 < kWidestInterval;
}

/// Values of the unknowns before their errors are known; returns those that are free.
std::vector<Eigen::Index> take_values(const RateStateUnknowns& unknowns, const std::vector<double>& p,
                                      RateStateFit& fit) {
  std::vector<Eigen::Index> free;
  for (std::size_t k = 0; k < p.size(); ++k) {
    FitParameter parameter;
    parameter.parameter = unknowns.parameters[k];
    parameter.value = unknowns.value(k, p[k]);
    parameter.start = unknowns.value(k, unknowns.starts.front()[k]);
    parameter.profile_lower95 = parameter.profile_upper95 = kUnknown;
    const bool held = unknowns.lower[k] == unknowns.upper[k];
    const double near = 1e-6 * std::abs(unknowns.upper[k] - unknowns.lower[k]);
    parameter.at_bound = !held && (p[k] <= unknowns.lower[k] + near || p[k] >= unknowns.upper[k] - near);
    parameter.lower95 = held ? parameter.value : -kUnbounded;
    parameter.upper95 = held ? parameter.value : kUnbounded;
    parameter.std_error = held ? 0 : kUnbounded;
    parameter.determined = !parameter.at_bound;
    if (!held && !parameter.at_bound) free.push_back(static_cast<Eigen::Index>(k));
    fit.parameters.push_back(std::move(parameter));
  }
  return free;
}

void set_errors(const RateStateUnknowns& unknowns, const std::vector<double>& p, const std::vector<Eigen::Index>& free,
                const Errors& errors, RateStateFit& fit) {
  const std::size_t n = p.size();
  fit.covariance.assign(n * n, 0.0);
  fit.degrees_of_freedom = kUnbounded;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const auto at = static_cast<std::size_t>(free[i]);
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t j = 0; j < free.size(); ++j)
      fit.covariance[at * n + static_cast<std::size_t>(free[j])] = errors.covariance(row, static_cast<Eigen::Index>(j));
    fit.degrees_of_freedom = std::min(fit.degrees_of_freedom, errors.freedom[i]);
    set_interval(unknowns, at, p[at], std::sqrt(errors.covariance(row, row)), errors.freedom[i], fit.parameters[at]);
  }
}

/// mu_0 and slope of each step.
void set_own_values(const FitErrors& found, std::size_t steps, const std::vector<Eigen::Index>& free,
                    const Eigen::MatrixXd& influence, const WanderingNoise& noise, RateStateFit& fit) {
  for (std::size_t k = 0; k < steps; ++k) {
    Eigen::MatrixXd rows;
    const Eigen::VectorXd own = found.own_values(k, free, influence, rows);
    const Errors errors = found.errors_of(rows, noise);
    const auto estimate = [&](Eigen::Index i) {
      return Estimate{own(i), std::sqrt(errors.covariance(i, i)), errors.freedom[static_cast<std::size_t>(i)]};
    };
    fit.base_friction.push_back(estimate(0));
    fit.trend.push_back(own.size() > 1 ? estimate(1) : Estimate{});
  }
}

/// Of the load point, over which the contact adapts to the steps: D_c of the slower state, and what the machine gives
/// way while friction changes.
double adapting_distance(const RateStateData& data, std::size_t states, const RateStateFit& fit) {
  double distance = 0, change = 0;
  for (std::size_t i = 0; i < states; ++i) distance = std::max(distance, fit.parameters[2 + 2 * i].value);
  for (const VelocityStep& step : data.steps) {
    const double ratio = step.hold > 0 ? kHoldAsRatio : std::abs(std::log(step.after / step.before));
    change = std::max(change, fit.parameters[0].value * ratio);
  }
  return kAdapted * distance + change / fit.parameters.back().value;
}

/// Says where a law leaves more while the contact adapts than elsewhere; where that cannot be judged, that what is left
/// wanders by much more than the noise of a sample.
void say_excess(const FitErrors& found, double distance, const std::vector<Eigen::Index>& free, RateStateFit& fit) {
  const std::optional<Excess> excess = found.excess_behind_steps(distance, free);
  if (excess) {
    fit.lacks = excess->p_value < kChanceOfExcess && excess->factor > kMuchLeft;
    if (*fit.lacks)
      fit.messages.push_back(fmt::format(
          "what is left is {:.2g} times as large over the first {:.3g} um behind the steps as elsewhere: this law does "
          "not describe the response",
          excess->factor, 1e6 * distance));
  } else if (fit.noise_time > 0 && fit.noise_slow > kMuchWander * fit.noise_white) {
    fit.messages.push_back(
        fmt::format("what is left wanders by {:.2g} over {:.2g} s, far above the noise of a sample: the measurement "
                    "drifts, or this law does not describe the response",
                    fit.noise_slow, fit.noise_time));
  }
}

}  // namespace

RateStateFit fit_from(const RateStateProblem& problem, const RateStateUnknowns& unknowns,
                      const RateStateSolution& solution) {
  RateStateFit fit;
  fit.evolution = problem.evolution();
  if (!solution.found) {
    fit.messages.push_back("the fit failed: " + solution.message);
    return fit;
  }
  const FitErrors found(problem, solution.p);
  if (!found.valid()) {
    fit.messages.emplace_back("the fit failed: the simulated sliding runs away at its minimum");
    return fit;
  }
  fit.converged = true;
  fit.samples = static_cast<std::size_t>(found.count());
  fit.rmse = std::sqrt(found.sum_of_squares() / found.count());
  const std::vector<Eigen::Index> free = take_values(unknowns, solution.p, fit);
  std::vector<Eigen::Index> fitted = free;
  fitted.insert(fitted.end(), found.times().begin(), found.times().end());
  const WanderingNoise noise = found.noise(fitted);
  fit.noise_white = noise.white;
  fit.noise_slow = noise.slow;
  fit.noise_time = noise.time;
  const Eigen::MatrixXd influence = found.influence(fitted);
  set_errors(unknowns, solution.p, free, found.errors_of(influence, noise), fit);
  set_stability(problem.states(), solution.p, fit.degrees_of_freedom, fit);
  set_correlations(fit);
  set_own_values(found, problem.steps().size(), fitted, influence, noise, fit);
  say_excess(found, adapting_distance(problem.data(), problem.states(), fit), fitted, fit);
  return fit;
}

double log_likelihood_below(const RateStateProblem& best, const RateStateSolution& best_solution,
                            const RateStateProblem& other, const RateStateSolution& other_solution,
                            const RateStateFit& fit) {
  const FitErrors one(best, best_solution.p), two(other, other_solution.p);
  if (!one.valid() || !two.valid() || !(fit.noise_white > 0)) return kUnknown;
  const WanderingNoise noise = {fit.noise_white, fit.noise_slow, fit.noise_time};
  return 0.5 * (two.whitened(noise) - one.whitened(noise));
}

}  // namespace tribofit::fit
