#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

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

FitParameter fitted_parameter(const FitContext& context, const Spread& spread, std::size_t k) {
  const auto i = static_cast<Eigen::Index>(k);
  const double lower = context.bounds.lower[k], upper = context.bounds.upper[k];
  FitParameter out;
  out.parameter = parameter_of(context, k);
  out.effect = context.model.parameters()[k].effect;
  out.value = context.minimum.p[k];
  out.start = context.first_start[k];
  out.std_error = spread.std_error(i);
  const double half = t_quantile_95(spread.degrees_of_freedom(i)) * out.std_error;
  out.lower95 = out.value - half;
  out.upper95 = out.value + half;
  if (lower < upper) {  // what is beyond the bounds was excluded before the data were seen
    out.lower95 = std::max(out.lower95, lower);
    out.upper95 = std::min(out.upper95, upper);
  }
  out.profile_lower95 = out.profile_upper95 = kNaN;
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

std::array<double, 2> CycleExtremes::means(const std::vector<bool>& left_out) const {
  std::array<double, 2> out{};
  for (std::size_t k = 0; k < 2; ++k) {
    double sum = 0;
    std::size_t count = 0;
    for (std::size_t c = 0; c < of_cycle[k].size(); ++c) {
      if (!std::isfinite(of_cycle[k][c]) || (!left_out.empty() && left_out[c])) continue;
      sum += of_cycle[k][c];
      ++count;
    }
    out[k] = count < kFewestCycles ? kNaN : sum / static_cast<double>(count);
  }
  return out;
}

CycleExtremes extremes_of(const Observations& observations, std::span<const Record> records) {
  CycleExtremes out;
  for (auto& values : out.of_cycle) values.assign(observations.cycles, kNaN);
  for (const auto& slip : observations.slips) {
    const Cycle& cycle = records[slip.record].segmentation->cycles[slip.segment];
    if (cycle.stick.size() == 0 || !cycle.slip_complete) continue;
    out.of_cycle[0][slip.cycle] = cycle.stick_maximum;
    out.of_cycle[1][slip.cycle] = cycle.slip_minimum;
  }
  return out;
}

Eigen::MatrixXd published_influence(const CycleEvidence& evidence, const std::vector<bool>& free,
                                    const CycleExtremes& extremes) {
  Eigen::MatrixXd levels =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(evidence.curvature.size()), evidence.total.cols());
  const std::array<double, 2> means = extremes.means();
  for (std::size_t k = 0; k < 2; ++k) {
    double known = 0;
    for (const double value : extremes.of_cycle[k]) known += std::isfinite(value) ? 1 : 0;
    for (std::size_t c = 0; c < extremes.of_cycle[k].size(); ++c) {
      if (!std::isfinite(extremes.of_cycle[k][c])) continue;
      levels(static_cast<Eigen::Index>(c), static_cast<Eigen::Index>(k)) =
          static_cast<double>(extremes.of_cycle[k].size()) / known * (extremes.of_cycle[k][c] - means[k]);
    }
  }
  const Eigen::MatrixXd follows = inverse_over(evidence.total, free) * evidence.total;
  return influence(evidence, free) + levels - levels * follows.transpose();
}

Freedom freedom_of(const FitContext& context, const CycleEvidence& evidence) {
  const std::vector<double>& p = context.minimum.p;
  const bool joint = !context.by_extremes();
  Freedom out;
  out.unconstrained = evidence.unconstrained();
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
  out.groups = undetermined(evidence.total, out.inside);
  for (std::size_t k = 0; k < p.size(); ++k) out.free[k] = out.free[k] && out.inside[k] == all_inside[k];
  return out;
}

void fill_parameters(const FitContext& context, const CycleEvidence& evidence, const Freedom& freedom, Fit& fit) {
  Spread spread;
  if (are_points(context.records)) {
    spread = spread_of_points(evidence, 2 * context.minimum.cost, freedom.free);
  } else if (context.by_extremes()) {
    spread = spread_of(published_influence(evidence, freedom.free, context.extremes));
  } else {
    // One on its bound is estimated all the same: what the data leave open of it they leave open of those that go with
    // it.
    spread = spread_of(influence(evidence, freedom.free), slow_levels(evidence, freedom.free));
  }
  for (std::size_t k = 0; k < context.minimum.p.size(); ++k) {
    fit.parameters.push_back(fitted_parameter(context, spread, k));
    fit.degrees_of_freedom = spread.degrees_of_freedom(static_cast<Eigen::Index>(k));
  }
  fit.covariance.assign(spread.covariance.data(), spread.covariance.data() + spread.covariance.size());
  open_intervals(freedom.groups, fit);
  if (!freedom.change) return;
  FitParameter& time = fit.parameters[freedom.change->time];
  std::tie(time.lower95, time.upper95) =
      interval_of_change(*freedom.change, context.residuals(all_slips(context.observations), false),
                         context.observations, evidence, context.bounds, context.minimum.p, context.evaluation.threads);
  time.std_error = (time.upper95 - time.lower95) / 4;
}

}  // namespace tribofit
