#include <cmath>
#include <limits>

#include "limits.hpp"
#include "rate_state_errors.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit::fit {

void set_stability(std::size_t states, const std::vector<double>& p, double freedom, RateStateFit& fit) {
  constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
  const auto n = static_cast<Eigen::Index>(p.size());
  const Eigen::Map<const RowMatrix> covariance(fit.covariance.data(), n, n);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(n);
  gradient(0) = 1;
  double value = p[0];
  for (std::size_t i = 0; i < states; ++i) {
    gradient(static_cast<Eigen::Index>(1 + 2 * i)) = -1;
    value -= p[1 + 2 * i];
  }
  for (std::size_t i = 0; i < 1 + states; ++i) {
    if (!fit.parameters[i == 0 ? 0 : 2 * i - 1].at_bound) continue;
    fit.rate_dependence = {kNotKnown, kNotKnown, freedom};
    fit.rate_dependence_lower95 = fit.rate_dependence_upper95 = kNotKnown;
    return;
  }
  const double quantile = t_quantile_95(freedom);
  fit.rate_dependence = {value, std::sqrt(gradient.dot(covariance * gradient)), freedom};
  fit.rate_dependence_lower95 = value - quantile * fit.rate_dependence.std_error;
  fit.rate_dependence_upper95 = value + quantile * fit.rate_dependence.std_error;
  if (states != 1 || !(fit.rate_dependence_upper95 < 0)) return;
  const RateStateParameters<double> found = parameters_from(p.data(), 1);
  fit.critical_stiffness = critical_stiffness(found.a, found.b[0], found.distance[0]);
  fit.stiffness_ratio = found.stiffness / fit.critical_stiffness;
  gradient << 1 / (found.b[0] - found.a), -1 / (found.b[0] - found.a), 1, 1;  // of ln(k D/(b - a))
  const double half = quantile * std::sqrt(gradient.dot(covariance * gradient));
  fit.stiffness_ratio_lower95 = fit.stiffness_ratio * std::exp(-half);
  fit.stiffness_ratio_upper95 = fit.stiffness_ratio * std::exp(half);
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

}  // namespace tribofit::fit
