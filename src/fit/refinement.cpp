#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "statistics/linear_algebra.hpp"

namespace tribofit {

namespace {

/// Residuals of all values at one place, with their derivatives.
struct Linearisation {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> jacobian;
};

std::optional<Linearisation> linearise(const ModelResiduals& residuals, const std::vector<double>& p) {
  const auto rows = static_cast<Eigen::Index>(residuals.count()), columns = static_cast<Eigen::Index>(p.size());
  Linearisation out{Eigen::VectorXd(rows), {}};
  out.jacobian.resize(rows, columns);
  if (!residuals.evaluate(p.data(), out.residual.data(), out.jacobian.data())) return std::nullopt;
  return out;
}

/// Parameters that a step may move: those that the data feel and that no bound holds back.
std::vector<Eigen::Index> movable(const Linearisation& here, const Bounds& bounds, const std::vector<double>& p) {
  const Eigen::VectorXd slope = here.jacobian.transpose() * here.residual;
  const Eigen::VectorXd norms = here.jacobian.colwise().squaredNorm().transpose();
  std::vector<Eigen::Index> out;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const bool held_back = (p[k] <= bounds.lower[k] && slope(i) > 0) || (p[k] >= bounds.upper[k] && slope(i) < 0);
    if (bounds.lower[k] < bounds.upper[k] && norms(i) > 0 && !held_back) out.push_back(i);
  }
  return out;
}

/// Takes one step, within the bounds; its length in standard errors, NaN where there is none. values: behind the rows.
double take_gauss_newton_step(const Linearisation& here, const Bounds& bounds, double values, std::vector<double>& p) {
  const std::vector<Eigen::Index> free = movable(here, bounds, p);
  if (free.empty()) return 0;
  Eigen::MatrixXd design = here.jacobian(Eigen::all, free);
  const Eigen::VectorXd scale = design.colwise().norm().transpose().cwiseInverse();
  design *= scale.asDiagonal();
  const Eigen::VectorXd change = scale.asDiagonal() * least_squares(design, -here.residual);
  const double variance = here.residual.squaredNorm() / std::max(1.0, values - static_cast<double>(free.size()));
  const Eigen::VectorXd std_error =
      std::sqrt(variance) * scale.cwiseProduct(inverse_triangular_factor(design).rowwise().norm());
  double longest = 0;
  bool moves = false;
  for (std::size_t j = 0; j < free.size(); ++j) {
    const auto k = static_cast<std::size_t>(free[j]);
    const auto i = static_cast<Eigen::Index>(j);
    const double to = std::clamp(p[k] + change(i), bounds.lower[k], bounds.upper[k]), length = std::abs(to - p[k]);
    if (!std::isfinite(change(i))) return std::numeric_limits<double>::quiet_NaN();
    constexpr double kRounding = 1e-11;
    moves |= length > kRounding * std::abs(p[k]);
    longest = std::max(longest, length / std_error(i));
    p[k] = to;
  }
  return moves ? longest : 0;  // without noise there is no standard error
}

}  // namespace

bool refine(FitContext& context, const std::optional<ChangePoint>& change, Bounds& held, std::vector<double>& p) {
  const std::vector<std::size_t> all = all_slips(context.observations);
  const ModelResiduals plain(context.model, context.observations, all, context.evaluation);
  const std::vector<double> begin = p;
  double last = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kMostRefiningSteps; ++step) {
    context.whiten_at(plain, p);
    if (change) find_change(context, *change, held, p);
    const std::optional<Linearisation> here = linearise(context.residuals(all), p);
    if (!here) break;
    const double length = take_gauss_newton_step(*here, held, static_cast<double>(context.observations.size()), p);
    if (length <= kLastStep) return true;
    if (!(length < kShortening * last)) break;
    last = length;
  }
  p = begin;
  context.whitening = {};
  return false;
}

ModelResiduals refine_look(FitContext& context, const std::optional<ChangePoint>& change, Bounds& held,
                           std::vector<double>& p) {
  const std::vector<std::size_t> all = all_slips(context.observations);
  const ModelResiduals plain(context.model, context.observations, all, context.evaluation);
  context.whiten_at(plain, p);
  if (change) find_change(context, *change, held, p);
  ModelResiduals residuals = context.residuals(all);
  const std::optional<Linearisation> here = linearise(residuals, p);
  if (!here) return residuals;
  std::vector<double> next = p;
  const double length = take_gauss_newton_step(*here, held, static_cast<double>(context.observations.size()), next);
  if (!std::isfinite(length)) return residuals;
  ModelResiduals there = residuals;  // holds the Jacobian at `next`, which is needed then if the step is taken
  linearise(there, next);
  const bool leads_astray =
      !(there.squares_with_scatter(next.data()) <= kRiseOfLook * residuals.squares_with_scatter(p.data()));
  if (leads_astray) return residuals;
  p = std::move(next);
  return there;
}

}  // namespace tribofit
