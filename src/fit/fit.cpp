#include "tribofit/fit/fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "change_point.hpp"
#include "errors.hpp"
#include "influence.hpp"
#include "messages.hpp"
#include "model_residuals.hpp"
#include "profile.hpp"
#include "published.hpp"
#include "starts.hpp"
#include "stick.hpp"
#include "systematic.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kFewestCycles = 3;

/// Evenly spread slips with about `values` values: enough to compare starts.
std::vector<std::size_t> sample_of_slips(const Observations& observations, std::size_t values) {
  const std::size_t every = std::max<std::size_t>(1, observations.size() / values);
  std::vector<std::size_t> slips;
  for (std::size_t k = 0; k < observations.slips.size(); k += every) slips.push_back(k);
  return slips;
}

std::size_t fold_count(const Observations& observations, const FitOptions& options) {
  return std::min(observations.cycles, static_cast<std::size_t>(std::max(2, options.folds)));
}

/// Good enough to compare.
SolverOptions quick_search() {
  SolverOptions quick;
  quick.max_iterations = 40;
  quick.relative_cost = 1e-8;
  quick.relative_step = 1e-7;
  quick.careful = false;
  return quick;
}

/// Good enough for a look: what has not been found by then is far away.
SolverOptions short_search() {
  SolverOptions look = quick_search();
  look.max_iterations = 12;
  look.relative_cost = 1e-6;
  return look;
}

/// One fit in the making: what all its steps share.
struct FitContext {
  const FrictionModel& model;
  std::span<const Record> records;
  const Observations& observations;
  const Instruments& instruments;
  const FitOptions& options;
  Bounds bounds{};
  ModelResiduals::Options loss{};
  ModelResiduals::Whitening whitening{};  ///< of every slip; without any: plain least squares

  ModelResiduals residuals(const std::vector<std::size_t>& slips, bool own_levels = true) const {
    ModelResiduals out(model, observations, slips, loss);
    if (whitening.part > 0) out.whiten(whitening, own_levels);
    return out;
  }
  SolverResult solve(const std::vector<std::size_t>& slips, const std::vector<double>& start,
                     const SolverOptions& solver, const Bounds& within) const {
    return minimize(residuals(slips), start, within.lower, within.upper, solver);
  }
  SolverResult solve(const std::vector<std::size_t>& slips, const std::vector<double>& start,
                     const SolverOptions& solver) const {
    return solve(slips, start, solver, bounds);
  }
};

/// Best of several starts, compared on a part of the slips; then all of them, first by plain least squares to see the
/// scatter of break-away, then with that scatter taken out.
SolverResult joint_estimate(FitContext& job, Fit& fit, std::vector<double>& start) {
  auto starts = make_starts(job.model, job.observations, job.bounds, job.options.starts, job.options.seed);
  if (!job.options.start.empty()) starts = {job.options.start};
  for (auto& s : starts) apply_given(job.model, job.options.given, job.bounds, s);
  for (std::size_t k = 1; k < starts.size();) {  // where all is given, all starts are one
    const auto here = starts.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::find(starts.begin(), here, *here) == here) {
      ++k;
    } else {
      starts.erase(here);
    }
  }
  const std::vector<std::size_t> part = sample_of_slips(job.observations, 4000);
  const bool look = job.options.starts == 0;
  const SolverOptions quick = look ? short_search() : quick_search();
  std::vector<SolverResult> tries;
  for (const auto& s : starts) tries.push_back(job.solve(part, s, quick));
  std::size_t best = 0;
  for (std::size_t k = 1; k < tries.size(); ++k) {
    if (tries[k].cost < tries[best].cost * (1 - 1e-6)) best = k;
  }
  start = starts[0];
  if (best != 0)
    fit.messages.push_back("the best fit was found from a random start, not from the one the data suggest");
  const std::vector<std::size_t> all = all_slips(job.observations);
  std::vector<double> p = job.solve(all, tries[best].p, quick).p;
  const std::optional<ChangePoint> change = change_point_of(job.model);
  Bounds held = job.bounds;
  // The direction in which a slip scatters is that of the law: known better once it has been taken out.
  const ModelResiduals plain(job.model, job.observations, all, job.loss);
  constexpr int kPasses = 3;
  for (int pass = 0; pass < kPasses; ++pass) {
    job.whitening = plain.whitening_at(p.data());
    if (change) {  // slips at levels of their own would hide a change that is misplaced
      p[change->time] = best_change(*change, job.residuals(all, false), job.observations, job.bounds, p);
      held.lower[change->time] = held.upper[change->time] = p[change->time];
    }
    if (pass < kPasses - 1) p = job.solve(all, p, quick, held).p;
  }
  if (look) return job.solve(all, p, quick, held);
  SolverOptions careful;
  careful.relative_cost = 1e-13;  // along a flat valley nothing is gained by going on
  return job.solve(all, p, careful, held);
}

/// [D] 3.2: levels from extremes, then the decay factor alone.
SolverResult published_estimate(FitContext& job, const CycleExtremes& extremes, Fit& fit, std::vector<double>& start) {
  start = start_from_data(job.model, job.observations, job.bounds);
  apply_given(job.model, job.options.given, job.bounds, start);
  const std::array<double, 2> levels = extremes.means();
  SolverResult failed;
  failed.p = start;
  failed.message = "the published protocol needs at least three cycles that stick and slip";
  for (std::size_t k = 0; k < 2; ++k) {
    if (!std::isfinite(levels[k])) return failed;
    start[k] = job.bounds.lower[k] = job.bounds.upper[k] = levels[k];
  }
  for (const GivenParameter& given : job.options.given) {
    if (given.name != "mu_s" && given.name != "mu_k") continue;
    fit.messages.push_back("the published protocol takes " + given.name +
                           " from the extremes of each cycle, not as given");
  }
  return job.solve(all_slips(job.observations), start, SolverOptions());
}

/// Error on cycles that took no part: contiguous blocks of cycles are left out in turn and the rest fitted, by one
/// Gauss-Newton step from the fit of all. The step is mostly short (a fraction of a standard error), so it ends where a
/// refit would; where it is not, the rest is fitted again.
/// Levels from extremes are those of the cycles kept.
void cross_validate(const FitContext& job, const std::vector<double>& p, const NormalEquations& equations,
                    const std::vector<bool>& free, const SampleErrors& errors, const CycleExtremes* extremes,
                    Fit& fit) {
  const std::size_t folds = fold_count(job.observations, job.options);
  fit.cycle_counts = errors.counts;
  fit.cycle_squares = errors.squares;
  fit.fold_parameters.assign(folds, p);
  fit.cycle_folds = blocks_of(job.observations, folds);
  for (std::size_t fold = 0; fold < folds; ++fold) {
    Eigen::MatrixXd curvature = equations.total;
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(curvature.rows());
    for (std::size_t c = 0; c < job.observations.cycles; ++c) {
      if (fit.cycle_folds[c] == fold) {
        curvature -= equations.curvature[c];
      } else {
        gradient += equations.gradient[c];
      }
    }
    std::vector<double>& q = fit.fold_parameters[fold];
    Eigen::VectorXd levels = Eigen::VectorXd::Zero(curvature.rows());
    if (extremes != nullptr) {
      std::vector<bool> left_out(job.observations.cycles);
      for (std::size_t c = 0; c < left_out.size(); ++c) {
        left_out[c] = fit.cycle_folds[c] == fold;
      }
      const std::array<double, 2> kept = extremes->means(left_out);
      for (std::size_t k = 0; k < 2; ++k) {
        if (std::isfinite(kept[k])) levels(static_cast<Eigen::Index>(k)) = kept[k] - p[k];
      }
    }
    const Eigen::VectorXd step =
        levels - inverse_where_known(curvature, equations.total, free) * (gradient + curvature * levels);
    std::vector<std::size_t> held, kept;
    for (const std::size_t s : all_slips(job.observations)) {
      (fit.cycle_folds[job.observations.slips[s].cycle] == fold ? held : kept).push_back(s);
    }
    bool is_long = false;  // too long for the model to be straight over it
    for (std::size_t k = 0; k < q.size(); ++k) {
      const double length = step(static_cast<Eigen::Index>(k));
      const double range = job.bounds.upper[k] - job.bounds.lower[k];
      is_long |= free[k] && std::abs(length) > 0.2 * std::abs(p[k]) + 1e-3 * range;
      q[k] += length;
      if (free[k]) q[k] = std::clamp(q[k], job.bounds.lower[k], job.bounds.upper[k]);
    }
    if (is_long && extremes == nullptr) q = job.solve(kept, p, quick_search()).p;
    // The squares on every sample at p are known; means over a few samples give their change exactly
    // where the two curves differ by a nearly constant amount within such a mean.
    const ModelResiduals residuals(job.model, job.observations, held);
    const std::vector<double> at_q = residuals.squares(q.data()), at_p = residuals.squares(p.data());
    for (std::size_t k = 0; k < std::min(at_q.size(), at_p.size()); ++k) {
      fit.cycle_squares[job.observations.slips[held[k]].cycle] += at_q[k] - at_p[k];
    }
  }
  const double squares = std::accumulate(fit.cycle_squares.begin(), fit.cycle_squares.end(), 0.0);
  const double counts = std::accumulate(fit.cycle_counts.begin(), fit.cycle_counts.end(), 0.0);
  fit.error.held_out_rmse = std::sqrt(std::max(0.0, squares) / counts);
}

/// A value within a millionth of its range of a bound sits on it.
bool on_bound(double value, double lower, double upper) {
  const double tolerance = 1e-6 * (upper - lower);
  return lower < upper && (value <= lower + tolerance || value >= upper - tolerance);
}

/// The unit of a parameter that scales with friction, where friction is a force.
std::string in_newtons(const std::string& unit) {
  if (unit == "1") return "N";
  return unit.rfind("1/", 0) == 0 ? "N" + unit.substr(1) : "N " + unit;
}

void fill_parameters(const FitContext& job, const Bounds& given, const SolverResult& solution,
                     const std::vector<double>& start, const Eigen::MatrixXd& influences, Fit& fit) {
  const Spread spread = spread_of(influences);
  for (std::size_t k = 0; k < solution.p.size(); ++k) {
    const auto& slot = job.model.parameters()[k];
    const auto i = static_cast<Eigen::Index>(k);
    FitParameter out;
    out.parameter = slot.parameter;
    const bool held = !(job.bounds.lower[k] < job.bounds.upper[k]);  // by the published protocol
    out.parameter.lower = given.lower[k] / slot.parameter.si;
    out.parameter.upper = given.upper[k] / slot.parameter.si;
    if ((k < 2 || slot.parameter.friction_effects) && job.records[0].motion->friction_kind == FrictionKind::force) {
      out.parameter.unit = in_newtons(out.parameter.unit);
    }
    out.effect = slot.effect;
    out.value = solution.p[k];
    out.start = start[k];
    out.std_error = spread.std_error(i);
    fit.degrees_of_freedom = spread.degrees_of_freedom(i);
    const double half = t_quantile_95(spread.degrees_of_freedom(i)) * out.std_error;
    out.lower95 = out.value - half;
    out.upper95 = out.value + half;
    if (!held) {  // what is beyond the bounds was excluded before the data were seen
      out.lower95 = std::max(out.lower95, job.bounds.lower[k]);
      out.upper95 = std::min(out.upper95, job.bounds.upper[k]);
    }
    out.profile_lower95 = out.profile_upper95 = kNaN;
    out.at_bound =
        job.options.protocol == Protocol::joint && on_bound(out.value, job.bounds.lower[k], job.bounds.upper[k]);
    fit.parameters.push_back(out);
  }
  fit.covariance.assign(spread.covariance.data(), spread.covariance.data() + spread.covariance.size());
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

/// Means over the records, in squares.
Floor mean_floor(std::span<const Record> records) {
  Floor floor = estimate_floor(*records[0].motion, *records[0].segmentation);
  if (records.size() == 1) return floor;
  const auto count = static_cast<double>(records.size());
  double noise = floor.noise * floor.noise, scatter = floor.scatter * floor.scatter;
  for (std::size_t r = 1; r < records.size(); ++r) {
    const Floor next = estimate_floor(*records[r].motion, *records[r].segmentation);
    noise += next.noise * next.noise;
    scatter += next.scatter * next.scatter;
  }
  floor.noise = std::sqrt(noise / count);
  floor.scatter = std::sqrt(scatter / count);
  return floor;
}

void fill_floor(const FitContext& job, const std::vector<double>& p, const SampleErrors& errors, Fit& fit) {
  fit.floor = mean_floor(job.records);
  const double count = std::accumulate(errors.counts.begin(), errors.counts.end(), 0.0);
  const ModelResiduals::Whitening whitening =
      job.whitening.part > 0 ? job.whitening : job.residuals(all_slips(job.observations)).whitening_at(p.data());
  double sensitivity = 0;  // sum of squares of d model/d mu_s over the samples
  for (const Eigen::VectorXd& g : whitening.g) sensitivity += g.squaredNorm();
  const double scatter = std::pow(fit.floor.scatter, 2) * sensitivity / std::max(1.0, count);
  fit.floor.rmse = std::sqrt(std::pow(fit.floor.noise, 2) + scatter);
  fit.constant_rmse = errors.constant_rmse;
  set_floor(Floor(fit.floor), fit);
}

/// Starts that were given and cannot be had.
void tell_moved_starts(const FitContext& job, Fit& fit) {
  for (std::size_t k = 0; k < job.model.parameters().size(); ++k) {
    const FrictionModel::Slot& slot = job.model.parameters()[k];
    for (const GivenParameter& known : job.options.given) {
      if (!known.start || known.name != slot.full_name()) continue;
      if (*known.start >= job.bounds.lower[k] && *known.start <= job.bounds.upper[k]) continue;
      fit.messages.push_back(known.name +
                             " cannot start where it was told to: that is beyond its bounds, on the nearer " +
                             "of which the search began");
    }
  }
}

Fit failed_fit(Fit fit, const std::string& why) {
  fit.messages.insert(fit.messages.begin(), why);
  fit.converged = false;
  return fit;
}

}  // namespace

std::string_view to_string(Protocol protocol) {
  return protocol == Protocol::published ? "published" : "joint";
}

std::vector<double> Fit::values() const {
  std::vector<double> p;
  for (const FitParameter& parameter : parameters) p.push_back(parameter.value);
  return p;
}

void set_floor(const Floor& floor, Fit& fit) {
  fit.floor = floor;
  const double above = std::pow(fit.constant_rmse, 2) - std::pow(floor.rmse, 2);
  const double left = std::pow(fit.error.rmse, 2) - std::pow(floor.rmse, 2);
  fit.explained = above > 0 ? std::clamp(1 - left / above, 0.0, 1.0) : 0;
}

Fit fit_model(const FrictionModel& model, const Motion& motion, const Segmentation& segmentation,
              const Observations& observations, const Instruments& instruments, const FitOptions& options) {
  const Record record = {&motion, &segmentation};
  return fit_model(model, std::span(&record, 1), observations, instruments, options);
}

Fit fit_model(const FrictionModel& model, std::span<const Record> records, const Observations& observations,
              const Instruments& instruments, const FitOptions& options) {
  Fit fit;
  fit.model = model;
  fit.protocol = options.protocol;
  fit.cycles = observations.cycles;
  fit.fastest = observations.fastest;
  fit.slowest = observations.slowest;
  fit.stick_rmse = kNaN;
  if (observations.cycles < kFewestCycles) {
    return failed_fit(std::move(fit), "there are fewer than three cycles: no law can be fitted with an uncertainty");
  }
  FitContext job{model, records, observations, instruments, options};
  job.bounds = bounds_of(model, observations);
  apply_given(model, options.given, job.bounds);
  const Bounds given = job.bounds;
  tell_moved_starts(job, fit);
  if (options.loss != Loss::squares) {
    job.loss = {options.loss, options.loss_scale * mean_floor(records).noise};
  }

  std::vector<double> start;
  CycleExtremes extremes;
  const bool published = options.protocol == Protocol::published && records.size() == 1;
  if (published) extremes = extremes_of(observations, *records[0].segmentation);
  const SolverResult solution =
      published ? published_estimate(job, extremes, fit, start) : joint_estimate(job, fit, start);
  fit.converged = solution.converged;
  if (!solution.converged) fit.messages.push_back(solution.message);
  if (published && !(std::isfinite(extremes.means()[0]) && std::isfinite(extremes.means()[1]))) return fit;

  const std::vector<double>& p = solution.p;
  const ModelResiduals residuals = job.residuals(all_slips(observations));
  const NormalEquations equations = normal_equations(residuals, observations, p);
  if (!equations.finite) {
    return failed_fit(std::move(fit),
                      "the model is not finite on these data: an effect or formula divides by zero, "
                      "overflows or leaves its domain");
  }
  std::vector<bool> unconstrained = equations.unconstrained();
  // A change point is known far better than what depends on it smoothly, or not by a derivative: held for the others.
  const std::optional<ChangePoint> change = published ? std::nullopt : change_point_of(model);
  if (change) unconstrained[change->time] = false;
  std::vector<bool> free(p.size()), inside(p.size());
  for (std::size_t k = 0; k < p.size(); ++k) {
    free[k] = !unconstrained[k] && job.bounds.lower[k] < job.bounds.upper[k];
    inside[k] = free[k] && !on_bound(p[k], job.bounds.lower[k], job.bounds.upper[k]);
  }
  if (change) free[change->time] = inside[change->time] = false;
  std::vector<std::vector<std::size_t>> groups;
  if (!published) {
    const std::vector<bool> all_inside = inside;
    groups = undetermined(equations.total, inside);
    for (std::size_t k = 0; k < p.size(); ++k) free[k] = free[k] && inside[k] == all_inside[k];
  }
  Eigen::MatrixXd influences =
      published ? published_influence(equations, free, extremes) : influence(equations, inside);
  if (!published && inside != free) {
    // A parameter on its bound is fixed for the others; its own error is what it would have if it were not.
    const Eigen::MatrixXd with_bound = influence(equations, free);
    for (std::size_t k = 0; k < p.size(); ++k) {
      if (free[k] && !inside[k])
        influences.col(static_cast<Eigen::Index>(k)) = with_bound.col(static_cast<Eigen::Index>(k));
    }
  }
  fill_parameters(job, given, solution, start, influences, fit);
  open_intervals(groups, fit);
  if (change) {
    FitParameter& time = fit.parameters[change->time];
    std::tie(time.lower95, time.upper95) = interval_of_change(*change, job.residuals(all_slips(observations), false),
                                                              observations, equations, job.bounds, p);
    time.std_error = (time.upper95 - time.lower95) / 4;
  }

  const FullRecord record(records, observations, model.needs());
  const SampleErrors errors = sample_errors(model, p, record, observations);
  fit.error = errors.figures;
  fit.observations = static_cast<std::size_t>(std::accumulate(errors.counts.begin(), errors.counts.end(), 0.0));
  fill_floor(job, p, errors, fit);
  cross_validate(job, p, equations, inside, errors, published ? &extremes : nullptr, fit);
  if (records.size() == 1) {
    const Motion& motion = *records[0].motion;
    const std::vector<double> systematic =
        systematic_errors(model, p, motion, observations, instruments, inside, published);
    for (std::size_t k = 0; k < p.size(); ++k) fit.parameters[k].systematic = systematic[k];
    if (model.acts_in_stick()) fit.stick_rmse = stick_creep_rmse(model, p, motion, *records[0].segmentation);
  }
  if (options.profile && !published) add_profiles(residuals, given, inverse_over(equations.total, inside), fit);
  add_messages(unconstrained, groups, fit);
  return fit;
}

}  // namespace tribofit
