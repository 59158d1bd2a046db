#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "limits.hpp"
#include "rate_state_steps.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {

namespace {

constexpr double kNoRate = std::numeric_limits<double>::quiet_NaN();

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

}  // namespace

double adapting_distance(const RateStateData& data, std::size_t states, const RateStateFit& fit) {
  double distance = 0, change = 0;
  for (std::size_t i = 0; i < states; ++i) distance = std::max(distance, fit.parameters[2 + 2 * i].value);
  for (const VelocityStep& step : data.steps) {
    const double ratio = step.hold > 0 ? kHoldAsRatio : std::abs(std::log(step.after / step.before));
    change = std::max(change, fit.parameters[0].value * ratio);
  }
  return kAdapted * distance + change / fit.parameters.back().value;
}

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
    fit.rate_dependence = {kNoRate, kNoRate, freedom};
    fit.rate_dependence_lower95 = fit.rate_dependence_upper95 = kNoRate;
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
