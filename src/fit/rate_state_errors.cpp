#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "rate_state_noise.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {

namespace {

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
    fit.lacks = excess->p_value < kChanceOfRemark && excess->factor > kMuchLeft;
    if (*fit.lacks)
      fit.messages.push_back(fmt::format(
          "what is left is {} times as large over the first {} um behind the steps as elsewhere: this law does "
          "not describe the response",
          general(excess->factor, 2), general(1e6 * distance, 3)));
  } else if (fit.noise_time > 0 && fit.noise_slow > kMuchWander * fit.noise_white) {
    fit.messages.push_back(
        fmt::format("what is left wanders by {} over {} s, far above the noise of a sample: the measurement "
                    "drifts, or this law does not describe the response",
                    general(fit.noise_slow, 2), general(fit.noise_time, 2)));
  }
}

/// By how much a logarithm is off within its 95 % interval; not finite where that reaches where there is none.
template <class F>
double half_width(const F& logarithm, const std::vector<double>& p, double quantile,
                  const Eigen::Map<const RowMatrix>& covariance) {
  Eigen::VectorXd gradient(static_cast<Eigen::Index>(p.size()));
  for (std::size_t i = 0; i < p.size(); ++i) {
    constexpr double kPart = 1e-5;
    const double h = kPart * std::max(std::abs(p[i]), 1e-3);
    std::vector<double> up = p, down = p;
    up[i] += h, down[i] -= h;
    gradient(static_cast<Eigen::Index>(i)) = (logarithm(up) - logarithm(down)) / (2 * h);
  }
  return quantile * std::sqrt(gradient.dot(covariance * gradient));
}

/// k_c, and k over it with the interval that errors of ln(k/k_c) make: where friction falls beyond doubt, and where
/// that of two states rises and k_c is known to a factor.
void set_critical_stiffness(const std::vector<double>& p, double quantile,
                            const Eigen::Map<const RowMatrix>& covariance, RateStateFit& fit) {
  const bool falls = fit.rate_dependence_upper95 < 0;
  const bool rises = fit.rate_dependence_lower95 > 0;
  if (!falls && !(rises && fit.states > 1)) return;
  const auto critical = [&](const std::vector<double>& at) {
    return std::log(critical_stiffness(parameters_from(at.data(), fit.states), fit.states));
  };
  const auto ratio = [&](const std::vector<double>& at) {
    return std::log(parameters_from(at.data(), fit.states).stiffness) - critical(at);
  };
  const double half = half_width(ratio, p, quantile, covariance);
  if (!std::isfinite(half) ||
      (rises && !(2 * half_width(critical, p, quantile, covariance) < std::log(kWidestInterval))))
    return;
  fit.critical_stiffness = std::exp(critical(p));
  fit.stiffness_ratio = std::exp(ratio(p));
  fit.stiffness_ratio_lower95 = fit.stiffness_ratio * std::exp(-half);
  fit.stiffness_ratio_upper95 = fit.stiffness_ratio * std::exp(half);
}

/// a - b, and whether sliding is stable on this machine, from the values and their covariance.
void set_stability(const std::vector<double>& p, double freedom, RateStateFit& fit) {
  const auto n = static_cast<Eigen::Index>(p.size());
  const Eigen::Map<const RowMatrix> covariance(fit.covariance.data(), n, n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  gradient(0) = 1;
  double value = p[0];
  for (std::size_t i = 0; i < fit.states; ++i) {
    gradient(static_cast<Eigen::Index>(1 + 2 * i)) = -1;
    value -= p[1 + 2 * i];
  }
  for (std::size_t i = 0; i < 1 + fit.states; ++i) {
    if (!fit.parameters[i == 0 ? 0 : 2 * i - 1].at_bound) continue;
    fit.rate_dependence = {kUnknown, kUnknown, freedom};
    fit.rate_dependence_lower95 = fit.rate_dependence_upper95 = kUnknown;
    return;
  }
  const double quantile = t_quantile_95(freedom);
  fit.rate_dependence = {value, std::sqrt(gradient.dot(covariance * gradient)), freedom};
  fit.rate_dependence_lower95 = value - quantile * fit.rate_dependence.std_error;
  fit.rate_dependence_upper95 = value + quantile * fit.rate_dependence.std_error;
  set_critical_stiffness(p, quantile, covariance, fit);
}

void set_correlations(RateStateFit& fit) {
  const std::size_t n = fit.parameters.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      const double value = fit.covariance[i * n + j] / std::sqrt(fit.covariance[i * n + i] * fit.covariance[j * n + j]);
      if (std::abs(value) > kStrongCorrelation) fit.correlations.push_back({i, j, value});
    }
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
  fit.rmse = std::sqrt(found.sum_of_squares() / found.count());
  const std::vector<Eigen::Index> free = take_values(unknowns, minimum.p, fit);
  std::vector<Eigen::Index> fitted = free;
  fitted.insert(fitted.end(), found.times().begin(), found.times().end());
  const WanderingNoise noise = found.noise(fitted);
  fit.noise_white = noise.white;
  fit.noise_slow = noise.slow;
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
  const bool is_noise = fit.noise_white > 0 && !fit.lacks.value_or(false) &&
                        !(fit.noise_time > 0 && fit.noise_slow > kMuchWander * fit.noise_white);
  const auto free = std::count_if(fit.parameters.begin(), fit.parameters.end(),
                                  [](const FitParameter& p) { return p.std_error > 0 && !p.at_bound; });
  if (!is_noise || free == 0) return kUnknown;
  const FitErrors found(problem, minimum.p);
  if (!found.valid()) return kUnknown;
  const WanderingNoise noise = {fit.noise_white, fit.noise_slow, fit.noise_time};
  const auto values = static_cast<double>(free) + static_cast<double>(found.turns().size());
  const double more = found.whitened_without_answer(noise) - found.whitened(noise);
  return more > 0 ? f_p_value(more / values, values, kLargeFreedom) : kUnknown;
}

double log_likelihood_below(const RateStateProblem& best, const Solution& best_minimum, const RateStateProblem& other,
                            const Solution& other_minimum, const RateStateFit& fit) {
  const FitErrors one(best, best_minimum.p), two(other, other_minimum.p);
  if (!one.valid() || !two.valid() || !(fit.noise_white > 0)) return kUnknown;
  const WanderingNoise noise = {fit.noise_white, fit.noise_slow, fit.noise_time};
  return 0.5 * (two.whitened(noise) - one.whitened(noise));
}

void add_messages(RateStateFit& fit) {
  for (std::size_t k = 0; k < fit.parameters.size(); ++k) {
    const FitParameter& p = fit.parameters[k];
    const std::string& name = p.parameter.name;
    const double si = p.parameter.si;
    if (p.at_bound) {
      const bool upper = p.value / si > 0.5 * (p.parameter.lower + p.parameter.upper);
      fit.messages.push_back(
          name == "k" && upper
              ? fmt::format("k is not resolved: the machine is stiffer than the samples behind the steps can show; "
                            "sample faster there, or hold k by --bounds")
              : fmt::format("{} ended at its {} bound, {} {}", name, upper ? "upper" : "lower",
                            general(p.value / si, 4), p.parameter.unit));
    } else if (!p.determined) {
      fit.messages.push_back(
          fmt::format("{} is not known from these data: its 95 % interval reaches from {} to "
                      "{} {}",
                      name, general(p.lower95 / si, 3), general(p.upper95 / si, 3), p.parameter.unit));
    }
  }
  for (const Correlation& c : fit.correlations) {
    fit.messages.push_back(fmt::format(
        "{} and {} are correlated by {}: the data fix a combination of them better "
        "than either",
        fit.parameters[c.first].parameter.name, fit.parameters[c.second].parameter.name, fixed(c.value, 3)));
  }
}

}  // namespace tribofit::fit
