#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "rate_state_steps.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/wandering_noise.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {

namespace {

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
  /// Columns of the times that were fitted, behind those of the unknowns, and what turns at each.
  const std::vector<Eigen::Index>& times() const { return time_columns_; }
  const std::vector<Turn>& turns() const { return turns_; }
  double count() const { return std::accumulate(counts_.begin(), counts_.end(), 0.0); }

  /// Noise of what is left; the free unknowns, and the times, are those whose columns are kept.
  WanderingNoise noise(const std::vector<Eigen::Index>& free) const {
    return noise_of_rows(free, [](std::size_t) { return true; });
  }

  /// Minus twice the logarithm of the likelihood of what is left, with that noise.
  double whitened(const WanderingNoise& noise) const {
    return whitened_squares(series(), residual_.cwiseQuotient(root_count_), own_columns(), noise);
  }

  /// The same of friction that does not answer the steps: all of it is left.
  double whitened_without_answer(const WanderingNoise& noise) const {
    RowMatrix all(rows_, 1);
    for (Eigen::Index i = 0; i < rows_; ++i) all(i, 0) = data_.friction[problem_.value_of(static_cast<std::size_t>(i))];
    problem_.weigh(all);
    return whitened_squares(series(), all.col(0).cwiseQuotient(root_count_), own_columns(), noise);
  }

  /// Rows by which the noise moves the free unknowns.
  Eigen::MatrixXd influence(const std::vector<Eigen::Index>& free) const {
    Eigen::MatrixXd kept = weighted_(Eigen::all, free);
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
    for (Eigen::Index i = 0; i < n; ++i) {
      const std::size_t value = problem_.value_of(static_cast<std::size_t>(begin + i));
      right(i) = weights(i) * (data_.friction[value] - friction_(begin + i));
    }
    const Eigen::MatrixXd by_free = weights.asDiagonal() * derivatives_.middleRows(begin, n)(Eigen::all, free);
    design = weights.asDiagonal() * design;
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
    if (independent[0] < kFewestFreeVariances || independent[1] < kFewestFreeVariances) return std::nullopt;
    const double ratio = squares[0] / values[0] / (squares[1] / values[1]);
    if (!(ratio > 0) || !std::isfinite(ratio)) return std::nullopt;
    return Excess{std::sqrt(ratio), f_p_value(ratio, independent[0], independent[1])};
  }

  Errors errors_of(const Eigen::MatrixXd& rows, const WanderingNoise& noise) const {
    const NoiseMoments moments = noise_moments(series(), rows, noise);
    Errors out{moments.white + moments.slow, {}};
    double independent = 0;
    for (std::size_t k = 0; k < begins_.size() && noise.time > 0; ++k) {
      independent += (times_[end_of(k) - 1] - times_[begins_[k]]) / (2 * noise.time);
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
      turns_.push_back(turn);
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
    Eigen::MatrixXd jacobian = root_count_(rows).cwiseInverse().asDiagonal() * weighted_(rows, free);
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
  std::vector<Turn> turns_;
};

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr double kUnbounded = std::numeric_limits<double>::infinity();

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
    parameter.at_bound = on_bound(p[k], unknowns.lower[k], unknowns.upper[k]);
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

/// Of the times of steps that were fitted: their columns lie behind the free unknowns.
void set_errors_of_times(const FitErrors& found, const RateStateProblem& problem, const Errors& errors,
                         std::size_t free, RateStateFit& fit) {
  fit.time_std_error.assign(problem.steps().size(), kUnknown);
  for (std::size_t k = 0; k < found.turns().size(); ++k) {
    if (found.turns()[k].ends_hold) continue;
    const auto row = static_cast<Eigen::Index>(free + k);
    const auto step = std::find(problem.steps().begin(), problem.steps().end(), found.turns()[k].step);
    fit.time_std_error[static_cast<std::size_t>(step - problem.steps().begin())] =
        std::sqrt(errors.covariance(row, row));
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

/// Says where a law leaves more while the contact adapts than elsewhere; where that cannot be judged, that what is left
/// wanders by much more than the noise of a sample.
void say_excess(const FitErrors& found, double distance, const std::vector<Eigen::Index>& free, RateStateFit& fit) {
  const std::optional<Excess> excess = found.excess_behind_steps(distance, free);
  if (excess) {
    fit.lacks = excess->p_value < kChanceOfRemark && excess->factor > kMuchLeft;
    if (*fit.lacks)
      fit.messages.push_back(fmt::format(
          "what is left is {} times as large over the first {} um behind the steps as elsewhere: this law does "
          "not describe the response",
          general(excess->factor, 2), general(1e6 * distance, 3)));
  } else if (fit.noise_time > 0 && fit.floor.slow_noise > kMuchWander * fit.floor.noise) {
    fit.messages.push_back(
        fmt::format("what is left wanders by {} over {} s, far above the noise of a sample: the measurement "
                    "drifts, or this law does not describe the response",
                    general(fit.floor.slow_noise, 2), general(fit.noise_time, 2)));
  }
}

}  // namespace

RateStateFit fit_from(const RateStateProblem& problem, const RateStateUnknowns& unknowns, const Solution& minimum) {
  RateStateFit fit;
  fit.evolution = problem.model().evolution;
  fit.states = problem.model().states;
  if (!minimum.converged) {
    fit.messages.push_back("the fit failed: " + minimum.message);
    return fit;
  }
  const FitErrors found(problem, minimum.p);
  if (!found.valid()) {
    fit.messages.emplace_back("the fit failed: the simulated sliding runs away at its minimum");
    return fit;
  }
  fit.converged = true;
  fit.samples = static_cast<std::size_t>(found.count());
  fit.error.rmse = std::sqrt(found.sum_of_squares() / found.count());
  const std::vector<Eigen::Index> free = take_values(unknowns, minimum.p, fit);
  std::vector<Eigen::Index> fitted = free;
  fitted.insert(fitted.end(), found.times().begin(), found.times().end());
  const WanderingNoise noise = found.noise(fitted);
  fit.floor.noise = noise.white;
  fit.floor.slow_noise = noise.slow;
  fit.floor.rmse = std::hypot(noise.white, noise.slow);
  fit.noise_time = noise.time;
  const Eigen::MatrixXd influence = found.influence(fitted);
  const Errors errors = found.errors_of(influence, noise);
  set_errors(unknowns, minimum.p, free, errors, fit);
  set_errors_of_times(found, problem, errors, free.size(), fit);
  set_stability(minimum.p, fit.degrees_of_freedom, fit);
  set_correlations(fit);
  set_own_values(found, problem.steps().size(), fitted, influence, noise, fit);
  say_excess(found, adapting_distance(problem.data(), problem.model().states, fit), fitted, fit);
  return fit;
}

double p_value_of_no_answer(const RateStateProblem& problem, const Solution& minimum, const RateStateFit& fit) {
  const bool is_noise = fit.floor.noise > 0 && !fit.lacks.value_or(false) &&
                        !(fit.noise_time > 0 && fit.floor.slow_noise > kMuchWander * fit.floor.noise);
  const auto free = std::count_if(fit.parameters.begin(), fit.parameters.end(),
                                  [](const FitParameter& p) { return p.std_error > 0 && !p.at_bound; });
  if (!is_noise || free == 0) return kUnknown;
  const FitErrors found(problem, minimum.p);
  if (!found.valid()) return kUnknown;
  const WanderingNoise noise = {fit.floor.noise, fit.floor.slow_noise, fit.noise_time};
  const auto values = static_cast<double>(free) + static_cast<double>(found.turns().size());
  const double more = found.whitened_without_answer(noise) - found.whitened(noise);
  return more > 0 ? f_p_value(more / values, values, kLargeFreedom) : kUnknown;
}

double log_likelihood_below(const RateStateProblem& best, const Solution& best_minimum, const RateStateProblem& other,
                            const Solution& other_minimum, const RateStateFit& fit) {
  const FitErrors one(best, best_minimum.p), two(other, other_minimum.p);
  if (!one.valid() || !two.valid() || !(fit.floor.noise > 0)) return kUnknown;
  const WanderingNoise noise = {fit.floor.noise, fit.floor.slow_noise, fit.noise_time};
  return 0.5 * (two.whitened(noise) - one.whitened(noise));
}

}  // namespace tribofit::fit
