#pragma once

#include <Eigen/Dense>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cycle_evidence.hpp"
#include "errors.hpp"
#include "model_residuals.hpp"
#include "starts.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/fit/solver.hpp"

// The steps of one fit, in their order.

namespace tribofit {

/// Levels by per-cycle extremes ([D] 3.2, Protocol::published): the largest friction in stick and the smallest in slip,
/// cycle by cycle.
struct CycleExtremes {
  /// mu_s, mu_k of each unit of evidence; NaN where a cycle is not complete.
  std::array<std::vector<double>, 2> of_cycle;

  /// Means over the cycles that are not in `left_out` (or over all); NaN when fewer than three are left.
  std::array<double, 2> means(const std::vector<bool>& left_out = {}) const;
};
CycleExtremes extremes_of(const Observations& observations, std::span<const Record> records);

/// Influence of each cycle: that on the two means, and what the parameters fitted after them (free) make of both.
Eigen::MatrixXd published_influence(const CycleEvidence& evidence, const std::vector<bool>& free,
                                    const CycleExtremes& extremes);

/// One fit in the making: what all its steps share.
struct FitContext {
  const FrictionModel& model;
  std::span<const Record> records;
  const Observations& observations;
  const Instruments& instruments;
  const FitOptions& options;
  Bounds given{};                         ///< with what the user said of them
  Bounds bounds{};                        ///< `given`, but for what the protocol holds
  ModelResiduals::Options evaluation{};   ///< loss and threads
  ModelResiduals::Whitening whitening{};  ///< of every slip; without any: plain least squares

  // Set by estimate().
  Solution minimum{};
  std::vector<double> first_start{};           ///< of the search
  CycleExtremes extremes{};                    ///< by per-cycle extremes only
  std::optional<ModelResiduals> at_minimum{};  ///< of all slips, whitened there, where they are known

  bool by_extremes() const { return options.protocol == Protocol::published; }
  bool is_look() const { return options.starts == 0; }
  /// Sets the whitening to what the residuals at p call for; `plain` are those of all slips, not whitened.
  void whiten_at(const ModelResiduals& plain, const std::vector<double>& p) {
    whitening = plain.whitening_at(p.data());
  }
  ModelResiduals residuals(const std::vector<std::size_t>& slips, bool own_levels = true) const {
    ModelResiduals out(model, observations, slips, evaluation);
    if (whitening.any()) out.whiten(whitening, own_levels);
    return out;
  }
  Solution solve(const std::vector<std::size_t>& slips, const std::vector<double>& start, const SolverOptions& solver,
                 const Bounds& within) const {
    return minimize(residuals(slips), start, within.lower, within.upper, solver);
  }
  Solution solve(const std::vector<std::size_t>& slips, const std::vector<double>& start,
                 const SolverOptions& solver) const {
    return solve(slips, start, solver, bounds);
  }
};

/// A search that is good enough to compare.
inline constexpr SolverOptions kQuickSearch{
    .max_iterations = 40, .relative_step = 1e-7, .relative_cost = 1e-8, .careful = false};

/// Good enough for a look: what has not been found by then is far away, and a step over all values follows.
inline constexpr SolverOptions kShortSearch{
    .max_iterations = 12, .relative_step = 1e-7, .relative_cost = 1e-4, .careful = false, .hold_at_bounds = true};

/// Two ends of quick searches, which stop at steps of 1e-7: no further apart than ten of those.
bool are_alike(const std::vector<double>& a, const std::vector<double>& b);

/// A value within a millionth of its range of a bound sits on it.
bool on_bound(double value, double lower, double upper);

/// Evenly spread slips with about `values` values; every so many that both directions take part.
std::vector<std::size_t> some_slips(const Observations& observations, std::size_t values);

// ---- a sudden change

/// A parameter that is the time of a sudden change and the size that changes there, which is the parameter before it
/// (see ParameterSearch::moment_of_change).
///
/// Its likelihood is flat while nothing slides and has walls elsewhere, so no derivative leads to it or says how well
/// it is known: it is searched, and its interval is where the likelihood ratio stays below the point that holds 95 % of
/// change points.
struct ChangePoint {
  std::size_t time = 0, size = 0;  ///< indices of the parameters
};

/// The change point of a model; nothing when it has none.
std::optional<ChangePoint> change_point_of(const FrictionModel& model);

/// Time of change within its bounds that leaves least, the other parameters staying [s]; as it is where the bounds hold
/// it. residuals: over all slips of the observations.
/// Cost: an evaluation, and some 120 of single slips, which threads share.
double best_change(const ChangePoint& point, const ModelResiduals& residuals, const Observations& observations,
                   const Bounds& bounds, std::vector<double> p, int threads);

/// 95 % interval of the time of change [s], within the bounds. Squares may rise by 7.35 times the variance that the
/// cycles show for the size of the change (B. E. Hansen, Econometrica 68 (2000) 575, doi:10.1111/1468-0262.00124), so
/// coloured noise widens it.
std::pair<double, double> interval_of_change(const ChangePoint& point, const ModelResiduals& residuals,
                                             const Observations& observations, const CycleEvidence& evidence,
                                             const Bounds& bounds, std::vector<double> p, int threads);

/// Moves the time of the change in p to where it leaves least, with the whitening of the context, and holds it there.
void find_change(FitContext& context, const ChangePoint& change, Bounds& held, std::vector<double>& p);

// ---- the search

/// Finds the parameters by the protocol of the context, and holds in its bounds what the protocol holds. What a person
/// should know goes to `fit`. False: the extremes of too few cycles are known.
bool estimate(FitContext& context, Fit& fit);

/// Takes p, where a search on fewer values ended, to where all values of the context lead: Gauss-Newton steps within
/// the bounds, each with the scatter of break-away seen anew, until one moves no parameter by more than kLastStep of
/// its standard error, as independent noise would make it. So the parameters are those of all values, whatever the
/// search saw. Sets the whitening of the context; the time of a change is held in `held`.
///
/// false: the steps do not get shorter, or the model is not finite; p is as it was. Cost: two evaluations a step.
bool refine(FitContext& context, const std::optional<ChangePoint>& change, Bounds& held, std::vector<double>& p);

/// The same for a look: one such step, where it leads no further from the data. Sets the whitening of the context to
/// that at the p given. Returns the residuals of all slips with it.
ModelResiduals refine_look(FitContext& context, const std::optional<ChangePoint>& change, Bounds& held,
                           std::vector<double>& p);

// ---- what the values are worth

/// Which parameters the data determine where a fit ended.
struct Freedom {
  std::vector<bool> unconstrained;               ///< no residual depends on it
  std::vector<bool> free;                        ///< determined, and not held
  std::vector<bool> inside;                      ///< free, and not on a bound
  std::vector<std::vector<std::size_t>> groups;  ///< of which only combinations are determined, see undetermined()
  /// A change point is known far better than what depends on it smoothly, or not by a derivative: held for the others.
  std::optional<ChangePoint> change;
};
Freedom freedom_of(const FitContext& context, const CycleEvidence& evidence);

/// Sets the parameters of a fit with their statistical errors, from the influence of each cycle.
void fill_parameters(const FitContext& context, const CycleEvidence& evidence, const Freedom& freedom, Fit& fit);

/// Adds a step, within the bounds. True where it is too long for the model to be straight over it.
bool take_step(const Bounds& bounds, const std::vector<bool>& free, const Eigen::VectorXd& step,
               std::vector<double>& q);

/// Sets the held-out error of a fit: contiguous blocks of cycles are left out in turn and the rest fitted, by one
/// Gauss-Newton step from the fit of all. The step is mostly short (a fraction of a standard error), so it ends where a
/// refit would; where it is not, the rest is fitted again. Levels from extremes are those of the cycles kept.
/// free: parameters that a step may move.
void cross_validate(const FitContext& context, const CycleEvidence& evidence, const std::vector<bool>& free,
                    const SampleErrors& errors, Fit& fit);

/// Standard uncertainty of each parameter from what the instruments file declares (and from a high-pass that was found
/// and undone): every declared uncertainty moves velocity or friction by one standard deviation, one Newton step says
/// how far the parameters follow, and independent sources add in squares. So does the offset between the clocks of two
/// instruments. What is declared moves all records alike, what was found in a record moves that one. Zero where nothing
/// is declared; NaN where something is whose effect on these records is not known.
std::vector<double> systematic_errors(const FitContext& context, const std::vector<bool>& free);

/// Standard uncertainty of each parameter from when a spring slider breaks away, which its smoothed velocity shows
/// early or late by a part of the smoothing, in every cycle alike. Zero for other records.
std::vector<double> smoothing_errors(const FitContext& context, const std::vector<bool>& free);

/// Opens the interval of every parameter that holds all of its bounds: the data say nothing of it, or only that it
/// lies above or below a value, which its profile then says.
void open_whole_ranges(const ModelResiduals& residuals, const Bounds& bounds, const Eigen::MatrixXd& inverse_curvature,
                       Fit& fit);

/// Adds profile-likelihood 95 % intervals to a fit.
///
/// Each parameter is moved away from its best value while the others are refitted, until the sum of squares has
/// risen by as much as it would at the end of the symmetric interval if the model were linear. The scale of the rise is
/// that of the cycle-to-cycle standard error, so correlated samples do not shorten the interval; only its asymmetry is
/// new.
void add_profiles(const ModelResiduals& residuals, const Bounds& bounds, const Eigen::MatrixXd& inverse_curvature,
                  Fit& fit);

/// Adds what a careful person would say of the parameters: at a bound, not moved by the data, strongly correlated,
/// beyond what the data reach.
void add_messages(const Freedom& freedom, Fit& fit);

}  // namespace tribofit
