#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "fit_steps.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit {

namespace {

/// How far the levels by per-cycle extremes move when the cycles of a fold are left out.
Eigen::VectorXd shift_of_levels(const FitContext& context, const Fit& fit, std::size_t fold) {
  const std::vector<double>& p = context.minimum.p;
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(p.size()));
  if (!context.by_extremes()) return shift;
  std::vector<bool> left_out;
  for (const std::size_t own : fit.cycle_folds) left_out.push_back(own == fold);
  const std::array<double, 2> kept = context.extremes.means(left_out);
  for (std::size_t k = 0; k < 2; ++k) {
    if (std::isfinite(kept[k])) shift(static_cast<Eigen::Index>(k)) = kept[k] - p[k];
  }
  return shift;
}

/// One Gauss-Newton step from the fit of all towards that of the cycles outside a fold. directions: known_directions().
Eigen::VectorXd step_without(const FitContext& context, const CycleEvidence& evidence,
                             const Eigen::MatrixXd& directions, const Fit& fit, std::size_t fold) {
  const NormalSum kept = sum_of(evidence, fit.cycle_folds, fold);
  const Eigen::VectorXd levels = shift_of_levels(context, fit, fold);
  return levels - inverse_where_known(kept.curvature, directions) * (kept.gradient + kept.curvature * levels);
}

/// Every value is one sample, and none is spoilt: the observations hold all that the record does.
bool are_all_samples(const Observations& observations, const std::vector<double>& counts) {
  double values = static_cast<double>(observations.size());
  for (const auto& slip : observations.slips) {
    if (slip.from_stick) values += slip.break_away_root_weight * slip.break_away_root_weight;
  }
  return observations.velocity_variance.empty() &&
         std::abs(values - std::accumulate(counts.begin(), counts.end(), 0.0)) < 0.5;
}

/// Sets the squares of the cycles that a fold holds out, at q. every_sample: see are_all_samples().
///
/// The squares on every sample at p are known; means over a few samples give their change exactly where the two curves
/// differ by a nearly constant amount within such a mean. Where the change is as large as the squares themselves that
/// is not so, and every sample is looked at.
void set_squares_of_fold(const FitContext& context, const std::vector<std::size_t>& held, const std::vector<double>& p,
                         const std::vector<double>& q, bool every_sample, Fit& fit) {
  const Observations& observations = context.observations;
  const ModelResiduals residuals(context.model, observations, held);
  const std::vector<double> at_q = residuals.squares(q.data());
  if (every_sample && at_q.size() == held.size()) {
    for (const std::size_t s : held) fit.cycle_squares[observations.slips[s].cycle] = 0;
    for (std::size_t k = 0; k < held.size(); ++k) fit.cycle_squares[observations.slips[held[k]].cycle] += at_q[k];
    return;
  }
  const std::vector<double> at_p = residuals.squares(p.data());
  double known = 0, change = 0;
  const std::size_t count = std::min(at_q.size(), at_p.size());
  for (std::size_t k = 0; k < count; ++k) change += std::abs(at_q[k] - at_p[k]);
  for (const std::size_t s : held) known += fit.cycle_squares[observations.slips[s].cycle];
  if (!(change > known) || context.is_look()) {
    for (std::size_t k = 0; k < count; ++k) fit.cycle_squares[observations.slips[held[k]].cycle] += at_q[k] - at_p[k];
    return;
  }
  const FullRecord record(context.records, observations, context.model.needs());
  const FrictionModel own(context.model);  // its formulas must not be shared between threads
  const std::vector<double> exact = sample_errors(own, q, record, observations).squares;
  for (const std::size_t s : held) {
    const std::size_t cycle = observations.slips[s].cycle;
    fit.cycle_squares[cycle] = exact[cycle];
  }
}

/// For a look: where a step from p leads, shortened until it describes the slips kept, or every so many of them, no
/// worse than p does; p where no part of it does.
std::vector<double> shortened_step(const FitContext& context, const std::vector<std::size_t>& kept,
                                   const std::vector<double>& p, const std::vector<bool>& free, Eigen::VectorXd step) {
  constexpr int kHalvings = 4;
  const std::size_t every = (context.observations.size() / kWholeSlipsOfLook) | 1U;  // both directions
  std::vector<std::size_t> some;
  for (std::size_t k = 0; k < kept.size(); k += every) some.push_back(kept[k]);
  const ModelResiduals residuals = context.residuals(some);
  const double here = residuals.white_squares(p.data());
  for (int k = 0; k <= kHalvings; ++k, step /= 2) {
    std::vector<double> q = p;
    take_step(context.bounds, free, step, q);
    if (residuals.white_squares(q.data()) <= here) return q;
  }
  return p;
}

}  // namespace

bool take_step(const Bounds& bounds, const std::vector<bool>& free, const Eigen::VectorXd& step,
               std::vector<double>& q) {
  bool is_long = false;
  for (std::size_t k = 0; k < q.size(); ++k) {
    const double length = step(static_cast<Eigen::Index>(k));
    const double range = bounds.upper[k] - bounds.lower[k];
    is_long |= free[k] && std::abs(length) > 0.2 * std::abs(q[k]) + 1e-3 * range;
    q[k] += length;
    if (free[k]) q[k] = std::clamp(q[k], bounds.lower[k], bounds.upper[k]);
  }
  return is_long;
}

void cross_validate(const FitContext& context, const CycleEvidence& evidence, const std::vector<bool>& free,
                    const SampleErrors& errors, Fit& fit) {
  const Observations& observations = context.observations;
  const std::vector<double>& p = context.minimum.p;
  const std::size_t folds = std::min(observations.cycles, static_cast<std::size_t>(std::max(2, context.options.folds)));
  fit.cycle_counts = errors.counts;
  fit.cycle_squares = errors.squares;
  fit.fold_parameters.assign(folds, p);
  fit.cycle_folds = blocks_of(observations, folds);
  const bool every_sample = are_all_samples(observations, errors.counts);
  const Eigen::MatrixXd directions = known_directions(evidence.total, free);
  run_tasks(folds, context.evaluation.threads, [&](std::size_t fold) {
    std::vector<std::size_t> held, kept;
    for (const std::size_t s : all_slips(observations)) {
      (fit.cycle_folds[observations.slips[s].cycle] == fold ? held : kept).push_back(s);
    }
    std::vector<double>& q = fit.fold_parameters[fold];
    const Eigen::VectorXd step = step_without(context, evidence, directions, fit, fold);
    const bool is_long = take_step(context.bounds, free, step, q);
    if (is_long && !context.by_extremes())
      q = context.is_look() ? shortened_step(context, kept, p, free, step) : context.solve(kept, p, kQuickSearch).p;
    set_squares_of_fold(context, held, p, q, every_sample, fit);
  });
  const double squares = std::accumulate(fit.cycle_squares.begin(), fit.cycle_squares.end(), 0.0);
  const double counts = std::accumulate(fit.cycle_counts.begin(), fit.cycle_counts.end(), 0.0);
  fit.error.held_out_rmse = std::sqrt(std::max(0.0, squares) / counts);
}

}  // namespace tribofit
