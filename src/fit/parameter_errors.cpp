#include "parameter_errors.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <tuple>

#include "points.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

/// Influence of each cycle on the parameters. One on its bound is estimated all the same: what the data leave open of
/// it they leave open of those that go with it.
Eigen::MatrixXd influences_of(const FitContext& context, const Solution& solution, const NormalEquations& equations,
                              const Freedom& freedom) {
  if (context.by_extremes()) return published_influence(equations, freedom.free, solution.extremes);
  return influence(equations, freedom.free);
}

/// The unit of a parameter that scales with friction, where friction is a force.
std::string in_newtons(const std::string& unit) {
  if (unit == "1") return "N";
  return unit.rfind("1/", 0) == 0 ? "N" + unit.substr(1) : "N " + unit;
}

/// The parameter as the fit had it: with its bounds, in the unit of this record.
Parameter parameter_of(const FitContext& context, std::size_t k) {
  Parameter out = context.model.parameters()[k].parameter;
  out.lower = context.given.lower[k] / out.si;
  out.upper = context.given.upper[k] / out.si;
  if (out.scales_with_friction && context.records[0].motion->friction_kind == FrictionKind::force)
    out.unit = in_newtons(out.unit);
  return out;
}

FitParameter fitted_parameter(const FitContext& context, const Solution& solution, const Spread& spread,
                              std::size_t k) {
  const auto i = static_cast<Eigen::Index>(k);
  const double lower = context.bounds.lower[k], upper = context.bounds.upper[k];
  FitParameter out;
  out.parameter = parameter_of(context, k);
  out.effect = context.model.parameters()[k].effect;
  out.value = solution.values()[k];
  out.start = solution.start[k];
  out.std_error = spread.std_error(i);
  const double half = t_quantile_95(spread.degrees_of_freedom(i)) * out.std_error;
  out.lower95 = out.value - half;
  out.upper95 = out.value + half;
  if (lower < upper) {  // what is beyond the bounds was excluded before the data were seen
    out.lower95 = std::max(out.lower95, lower);
    out.upper95 = std::min(out.upper95, upper);
  }
  out.profile_lower95 = out.profile_upper95 = std::numeric_limits<double>::quiet_NaN();
  out.at_bound = context.options.protocol == Protocol::joint && on_bound(out.value, lower, upper);
  return out;
}

/// What the data do not determine has no finite error.
void open_intervals(const std::vector<std::vector<std::size_t>>& groups, Fit& fit) {
  for (const std::vector<std::size_t>& group : groups) {
    for (const std::size_t k : group) {
      FitParameter& parameter = fit.parameters[k];
      parameter.determined = false;
      parameter.std_error = parameter.upper95 = std::numeric_limits<double>::infinity();
      parameter.lower95 = -parameter.upper95;
    }
  }
}

}  // namespace

Freedom freedom_of(const FitContext& context, const std::vector<double>& p, const NormalEquations& equations) {
  const bool joint = !context.by_extremes();
  Freedom out;
  out.unconstrained = equations.unconstrained();
  if (joint) out.change = change_point_of(context.model);
  if (out.change) out.unconstrained[out.change->time] = false;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double lower = context.bounds.lower[k], upper = context.bounds.upper[k];
    out.free.push_back(!out.unconstrained[k] && lower < upper);
    out.inside.push_back(out.free[k] && !on_bound(p[k], lower, upper));
  }
  if (out.change) out.free[out.change->time] = out.inside[out.change->time] = false;
  if (!joint) return out;
  const std::vector<bool> all_inside = out.inside;
  out.groups = undetermined(equations.total, out.inside);
  for (std::size_t k = 0; k < p.size(); ++k) out.free[k] = out.free[k] && out.inside[k] == all_inside[k];
  return out;
}

void fill_parameters(const FitContext& context, const Solution& solution, const NormalEquations& equations,
                     const Freedom& freedom, Fit& fit) {
  SlowLevels slow;
  const bool points = are_points(context.records);
  // Several records have levels of their own, which are no noise that wanders from one to the next.
  if (!context.by_extremes() && context.records.size() == 1 && !points)
    slow = slow_levels(equations, level_change(context.model, solution.values()), freedom.free,
                       context.observations.flicker);
  const Spread spread = points ? spread_of_points(equations, 2 * solution.result.cost, freedom.free)
                               : spread_of(influences_of(context, solution, equations, freedom), slow);
  for (std::size_t k = 0; k < solution.values().size(); ++k) {
    fit.parameters.push_back(fitted_parameter(context, solution, spread, k));
    fit.degrees_of_freedom = spread.degrees_of_freedom(static_cast<Eigen::Index>(k));
  }
  fit.covariance.assign(spread.covariance.data(), spread.covariance.data() + spread.covariance.size());
  open_intervals(freedom.groups, fit);
  if (!freedom.change) return;
  FitParameter& time = fit.parameters[freedom.change->time];
  std::tie(time.lower95, time.upper95) = interval_of_change(
      *freedom.change, context.residuals(all_slips(context.observations), false), context.observations, equations,
      context.bounds, solution.values(), context.evaluation.threads);
  time.std_error = (time.upper95 - time.lower95) / 4;
}

}  // namespace tribofit
