#include "trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "fit/influence.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/fit/solver.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/statistics/stop.hpp"
#include "wave_start.hpp"

namespace tribofit::diagnosis {

namespace {

/// scatter: whether that of break-away is taken out.
ModelResiduals residuals_of(const Observations& observations, const FrictionModel& model,
                            const ModelResiduals::Whitening& whitening, int threads = 1, bool scatter = true) {
  ModelResiduals residuals(model, observations, all_slips(observations), {Loss::squares, 0, threads});
  residuals.weaken_stick(whitening.stick);
  if (scatter && whitening.any()) residuals.whiten(whitening);
  return residuals;
}

/// Adds what each cycle pays for the scatter of break-away.
void pay_for_scatter(const ModelResiduals::Whitening& whitening, std::vector<double>& squares) {
  for (std::size_t c = 0; c < std::min(squares.size(), whitening.log_spread.size()); ++c)
    squares[c] += whitening.noise * whitening.log_spread[c];
}

ModelResiduals::StickSquares all_sticks(const std::vector<ModelResiduals::StickSquares>& sticks) {
  ModelResiduals::StickSquares all;
  for (const auto& stick : sticks) {
    all.rigid += stick.rigid;
    all.left += stick.left;
    all.rows += stick.rows;
  }
  return all;
}

/// Whether a law of creep has earned what it gains in stick: of all that v_r shows there beyond its noise it must
/// explain most; less than that, something else moves the block.
bool is_earned(const ModelResiduals::StickSquares& stick, double noise) {
  const double gain = stick.rigid - stick.left, shown = stick.rigid - stick.rows * noise * noise;
  return gain <= 0 || gain >= limits::kCreepPart * shown;
}

/// Part to which squares of stick are weakened so that a law of creep leaves no more than noise there: none is exact,
/// as a quiet v_r shows, and errors that were stated too small are enlarged (R. T. Birge, Phys. Rev. 40 (1932) 207).
double part_of_stick(const ModelResiduals::StickSquares& stick, double noise) {
  return std::min(1.0, stick.rows * noise * noise / stick.left);
}

/// Fills what a trial says from its parameters; what is to be taken off the squares for the stick is returned. earned:
/// see is_earned().
double judge(const DiagnosisContext& context, const ModelResiduals& residuals, bool earned, const Bounds& bounds,
             Trial& trial) {
  trial.linear.rows = residuals.white_rows(trial.p.data());
  trial.usable = trial.linear.finite();
  if (!trial.usable) return 0;
  const std::size_t n = trial.p.size();
  trial.at_bound.assign(n, false);
  trial.linear.free.assign(n, true);
  for (std::size_t k = 0; k < n; ++k) {
    const double tolerance = 1e-3 * (bounds.upper[k] - bounds.lower[k]);
    trial.at_bound[k] = trial.p[k] <= bounds.lower[k] + 1e-3 * tolerance || trial.p[k] >= bounds.upper[k] - tolerance;
    trial.linear.free[k] = !trial.at_bound[k];
  }
  // Several records have levels of their own, which are no noise that wanders from one to the next.
  if (context.records.size() == 1) {
    trial.linear.level = level_change(trial.model, trial.p);
    trial.linear.known_flicker = context.fine.observations.flicker;
  }
  std::vector<double> squares = squares_after(trial.linear, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n)));
  trial.row_squares = sum(squares);
  trial.held_out = held_out_squares(trial.linear, context.blocks);
  pay_for_scatter(trial.whitening, squares);
  pay_for_scatter(trial.whitening, trial.held_out);
  const std::vector<ModelResiduals::StickSquares> sticks = residuals.stick_squares(trial.p.data());
  trial.stick = all_sticks(sticks);
  double off = 0;
  for (std::size_t c = 0; c < sticks.size(); ++c) {
    const double own = earned ? sticks[c].rigid : sticks[c].left;
    squares[c] -= own;
    trial.held_out[c] -= own;
    off += own;
  }
  if (!earned) trial.stick = {};
  trial.squares = sum(squares);
  trial.held_out_squares = sum(trial.held_out);
  return off;
}

/// The same as if there were no scatter to whiten against. off: for the stick.
void judge_plainly(const Blocks& blocks, const ModelResiduals& residuals, double off, Trial& trial) {
  Linearised& plain = trial.plain;
  plain.rows = residuals.white_rows(trial.p.data());
  plain.free = trial.linear.free;
  plain.level = trial.linear.level;
  const Eigen::VectorXd stay = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(trial.p.size()));
  trial.plain_squares = sum(squares_after(plain, stay)) - off;
  const Eigen::VectorXd step = gauss_newton_step(plain);
  for (Eigen::MatrixXd& rows : plain.rows) rows.col(rows.cols() - 1) += rows.leftCols(rows.cols() - 1) * step;
  trial.plain_minimum = sum(squares_after(plain, stay)) - off;
  trial.plain_cycles = held_out_squares(plain, blocks);
  trial.plain_held_out = sum(trial.plain_cycles) - off;
}

SolverOptions quick_search(int iterations) {
  SolverOptions options;
  options.max_iterations = iterations;
  options.relative_cost = 1e-5;  // far below what a comparison can see
  options.relative_step = 1e-7;
  options.careful = false, options.hold_at_bounds = true;
  return options;
}

/// How far a step may go.
struct StepRange {
  Eigen::VectorXd lower, upper;
};

StepRange step_range(const std::vector<double>& start, const Bounds& bounds) {
  const auto n = static_cast<Eigen::Index>(start.size());
  const Eigen::Map<const Eigen::VectorXd> from(start.data(), n);
  return {Eigen::Map<const Eigen::VectorXd>(bounds.lower.data(), n) - from,
          Eigen::Map<const Eigen::VectorXd>(bounds.upper.data(), n) - from};
}

/// A full turn more or less is the same phase.
void wrap_phases(const FrictionModel& model, std::vector<double>& p) {
  for (std::size_t k = 0; k < p.size(); ++k)
    if (model.parameters()[k].parameter.periodic) p[k] = std::remainder(p[k], 2 * std::numbers::pi);
}

}  // namespace

Bounds Level::bounds_of(const FrictionModel& model) const {
  Bounds bounds = tribofit::bounds_of(model, observations);
  apply_given(model, known, bounds);
  return bounds;
}

double noise_of(const Level& level, const Trial& trial) {
  return (trial.squares - trial.stick.left + trial.stick.rigid) / level.values;
}

Trial try_model(const DiagnosisContext& context, const Level& level, const FrictionModel& model,
                std::vector<double> start, int threads) {
  stop_point();
  Trial trial;
  trial.model = model;
  const Observations& observations = level.observations;
  const Bounds bounds = level.bounds_of(model);
  const ModelResiduals plain = residuals_of(observations, model, {}, threads);
  trial.whitening = plain.whitening_at(start.data());
  const ModelResiduals residuals = residuals_of(observations, model, trial.whitening, threads);
  trial.p = minimize(residuals, start, bounds.lower, bounds.upper, quick_search(20)).p;
  wrap_phases(model, trial.p);
  // Scatter is known better once the model is: a start may see as scatter what an effect explains.
  trial.whitening = plain.whitening_at(trial.p.data());
  const ModelResiduals::StickSquares stick = all_sticks(plain.stick_squares(trial.p.data()));
  trial.whitening.stick = part_of_stick(stick, context.noise);
  const ModelResiduals again = residuals_of(observations, model, trial.whitening, threads);
  trial.p = minimize(again, trial.p, bounds.lower, bounds.upper, quick_search(trial.whitening.stick < 1 ? 20 : 5)).p;
  const double off = judge(context, again, is_earned(stick, context.noise), bounds, trial);
  if (!trial.usable) return trial;
  judge_plainly(context.blocks, residuals_of(observations, model, trial.whitening, threads, false), off, trial);
  return trial;
}

Approach nearest(const Level& level, const FrictionModel& model, const ModelResiduals::Whitening& whitening,
                 const std::vector<std::vector<double>>& starts) {
  const Bounds bounds = level.bounds_of(model);
  const ModelResiduals residuals = residuals_of(level.observations, model, whitening);
  Approach best;
  for (const auto& start : starts) {
    SolverResult next = minimize(residuals, start, bounds.lower, bounds.upper, quick_search(8));
    if (best.p.empty() || 2 * next.cost < best.squares) best = {std::move(next.p), 2 * next.cost};
  }
  return best;
}

std::vector<double> nearest_if_several(const Level& level, const FrictionModel& model,
                                       const ModelResiduals::Whitening& whitening,
                                       const std::vector<std::vector<double>>& starts) {
  return starts.size() == 1 ? starts[0] : nearest(level, model, whitening, starts).p;
}

Trial try_base(const DiagnosisContext& context, const Level& level, const FrictionModel& model, int threads) {
  const Bounds bounds = level.bounds_of(model);
  const ModelResiduals plain = residuals_of(level.observations, model, {}, threads);
  const std::vector<double> start = start_from_data(model, level.observations, bounds);
  return try_model(context, level, model, minimize(plain, start, bounds.lower, bounds.upper, quick_search(40)).p,
                   threads);
}

std::vector<double> residual_of(const DiagnosisContext& context, const Trial& trial) {
  const Observations& observations = context.fine.observations;
  std::vector<double> residual(observations.size()), mu;
  for (const auto& range : observations.slips) {
    const Slip slip = observations.slip(range);
    mu.resize(slip.size());
    evaluate<double>(trial.model, trial.p.data(), slip, slip.velocity, mu);
    for (std::size_t i = 0; i < mu.size(); ++i)
      residual[range.begin + i] = observations.friction[range.begin + i] - mu[i];
  }
  return residual;
}

FrictionModel with_effect(const FrictionModel& model, const Effect& effect) {
  std::vector<Effect> effects(model.effects().begin(), model.effects().end());
  effects.push_back(effect);
  return FrictionModel(model.law(), std::move(effects), model.records());
}

namespace {

/// A start of a model with one effect more, and what a linear step from there promises.
struct Promise {
  std::vector<double> start;  ///< of all parameters
  std::vector<double> place;  ///< the values of the effect that are no phases
  double score = 0, squares = 0;
};

/// The start with the effect's `values` among the parameters of the base: the model has an order of its own. Phases
/// that further records have are those of the first.
Promise start_with(const std::vector<double>& base, const FrictionModel& model, const EffectInfo& effect,
                   const std::vector<double>& values, const Bounds& bounds) {
  Promise promise;
  const std::size_t offset = model.offset_of(effect.key), added = model.count_of(effect.key);
  promise.start = base;
  promise.start.insert(promise.start.begin() + static_cast<std::ptrdiff_t>(offset), added, 0.0);
  for (std::size_t k = 0; k < values.size(); ++k) {
    for (std::size_t record = 0; record < model.records(); ++record)
      promise.start[model.slot_of(offset + k, record)] = values[k];
    if (!effect.parameters[k].periodic) promise.place.push_back(values[k]);
  }
  for (std::size_t k = 0; k < promise.start.size(); ++k)
    promise.start[k] = std::clamp(promise.start[k], bounds.lower[k], bounds.upper[k]);
  return promise;
}

/// Parameters of the base from which a search begins: as fitted, and where nothing sticks and the law has become a
/// straight line also with the law falling at other speeds. Without a break-away to hold it a law may have taken the
/// place of the effect, and from there no step leads back.
std::vector<std::vector<double>> bases_of_search(const Level& level, const Trial& base) {
  std::vector<std::vector<double>> out = {base.p};
  const auto& slips = level.observations.slips;
  if (std::any_of(slips.begin(), slips.end(), [](const auto& slip) { return slip.from_stick; })) return out;
  const bool alone = base.model.effects().empty();
  if (!alone || remaining_fall(base.model.law(), base.p, level.observations.fastest).value_or(0) < limits::kStraight)
    return out;
  std::vector<double> anew = start_from_data(base.model, level.observations, level.bounds_of(base.model));
  std::copy(base.p.begin() + static_cast<std::ptrdiff_t>(base.model.base_count()), base.p.end(),
            anew.begin() + static_cast<std::ptrdiff_t>(base.model.base_count()));
  for (std::size_t k = 0; k < base.model.base_count(); ++k) {
    const BoundScaling scaling = base.model.parameters()[k].parameter.bound_scaling;
    if (scaling != BoundScaling::against_speed && scaling != BoundScaling::with_speed) continue;
    for (const double part : limits::kFallsWithin) {  // of the fastest slip
      const double speed = part * level.observations.fastest;
      out.push_back(anew);
      out.back()[k] = scaling == BoundScaling::with_speed ? speed : 1 / speed;
    }
  }
  return out;
}

/// Squares at a start and after a linear step from it, less those of a rigid stick (the same at every start); nothing
/// where they are not finite.
struct StepSquares {
  double here = 0, there = 0;
};
std::optional<StepSquares> squares_of_step(const ModelResiduals& residuals, const std::vector<double>& start,
                                           const Bounds& bounds, double rigid) {
  Linearised linear;
  linear.rows = residuals.white_rows(start.data());
  if (!linear.finite()) return std::nullopt;
  linear.free.assign(start.size(), true);
  const StepRange range = step_range(start, bounds);
  return StepSquares{sum(squares_after(linear, Eigen::VectorXd::Zero(range.lower.size()))) - rigid,
                     sum(squares_after(linear, bounded_step(linear, range.lower, range.upper))) - rigid};
}

/// The start of one place in which every record has the phases with which it leaves least, of those that were tried.
std::optional<Promise> combined_phases(const FrictionModel& model, const ModelResiduals& residuals,
                                       const Observations& observations, const std::vector<Promise>& tried) {
  std::optional<Promise> best;
  std::vector<double> least(model.records(), std::numeric_limits<double>::infinity());
  for (const Promise& one : tried) {
    const std::vector<double> squares = residuals.squares(one.start.data());
    if (squares.empty()) continue;
    if (!best) best = one;
    std::vector<double> of_record(model.records(), 0.0);
    for (std::size_t s = 0; s < squares.size(); ++s) of_record[observations.slips[s].record] += squares[s];
    for (std::size_t record = 0; record < model.records(); ++record) {
      if (!(of_record[record] < least[record])) continue;
      least[record] = of_record[record];
      for (std::size_t k = 0; k < one.start.size(); ++k) {
        const std::size_t slot = model.slot_of(k, record);
        if (record == 0 ? model.slot_of(k, 1) != k : slot != k) best->start[slot] = one.start[slot];
      }
    }
  }
  return best;
}

/// Of the starts in one place, which differ in their phases alone, the one that is lowest now: a linear step promises
/// the same from every phase, and costs a few times as much as a look at the squares.
std::optional<Promise> nearest_phase(const ModelResiduals& residuals, const std::vector<Promise>& tried) {
  if (tried.size() == 1) return tried[0];
  std::map<double, const Promise*> by_squares;
  for (const Promise& one : tried) {
    const double here = residuals.white_squares(one.start.data());
    if (std::isfinite(here)) by_squares.emplace(here, &one);
  }
  return by_squares.empty() ? std::nullopt : std::optional(*by_squares.begin()->second);
}

}  // namespace

SearchStart search_start_of(const DiagnosisContext& context, const Level& level, const Trial& base,
                            const Candidate& candidate, std::span<const double> residual, const LeastFalls& least) {
  const FrictionModel model = with_effect(base.model, candidate.effect);
  const ModelResiduals residuals = residuals_of(level.observations, model, base.whitening);
  const Bounds bounds = level.bounds_of(model);
  const Starts starts = starts_of(candidate, context.records, context.fine.observations, residual);
  std::vector<Promise> promises;
  const std::vector<std::vector<double>> bases = bases_of_search(level, base);
  std::optional<double> rigid;
  const auto try_start = [&](Promise promise) {
    if (!rigid) rigid = all_sticks(residuals.stick_squares(promise.start.data())).rigid;
    const std::optional<StepSquares> step = squares_of_step(residuals, promise.start, bounds, *rigid);
    if (!step) return;
    promise.squares = std::min(step->here, step->there);
    promise.score = step->there + 1e-2 * step->here;  // the start that is lower now is the nearer one
    promises.push_back(std::move(promise));
  };
  std::map<std::vector<double>, std::vector<Promise>> places;
  for (const auto& values : starts.values) {
    for (std::size_t from = 0; from < bases.size(); ++from) {
      Promise promise = start_with(bases[from], model, candidate.info, values, bounds);
      promise.place.push_back(static_cast<double>(from));
      places[promise.place].push_back(std::move(promise));
    }
  }
  const bool of_each = model.count_of(candidate.info.key) > candidate.info.parameters.size();  // phases of each record
  for (const auto& [place, tried] : places) {
    auto best =
        of_each ? combined_phases(model, residuals, level.observations, tried) : nearest_phase(residuals, tried);
    if (best) try_start(std::move(*best));
  }
  std::stable_sort(promises.begin(), promises.end(),
                   [](const Promise& a, const Promise& b) { return a.score < b.score; });
  SearchStart found;
  found.places = starts.places * static_cast<double>(bases.size());
  if (promises.empty()) return found;
  found.promised = base.row_squares - base.stick.rigid - promises[0].squares;
  found.squares = promises[0].squares + *rigid;
  if (found.promised < least.whitened) {
    // What acts through the level of break-away may look like its scatter, which has been taken out.
    const ModelResiduals unwhitened = residuals_of(level.observations, model, base.whitening, 1, false);
    const auto plain = squares_of_step(unwhitened, promises[0].start, bounds, *rigid);
    if (!plain || base.plain_squares - plain->there < least.plain) return found;
  }
  for (std::size_t k = 0; k < std::min(limits::kMostStarts, promises.size()); ++k)
    found.starts.push_back(with_amplitude_and_phase(residuals, model, candidate.info, bounds, promises[k].start));
  return found;
}

Searched try_with(const DiagnosisContext& context, const Level& level, const Trial& base, const Candidate& effect) {
  const SearchStart search = search_start_of(context, level, base, effect, residual_of(context, base), LeastFalls());
  const FrictionModel model = with_effect(base.model, effect.effect);
  if (search.starts.empty()) return {try_base(context, level, model), search.places};
  return {try_model(context, level, model, nearest_if_several(level, model, base.whitening, search.starts)),
          search.places};
}

Trial without_effect(const Trial& full, std::string_view key) {
  const std::vector<std::string> keys = full.model.effect_keys();
  std::vector<Effect> effects;
  Trial out;
  out.whitening = full.whitening;
  out.p.assign(full.p.begin(), full.p.begin() + static_cast<std::ptrdiff_t>(full.model.base_count()));
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (keys[k] == key) continue;
    effects.push_back(full.model.effects()[k]);
    for (std::size_t i = 0; i < full.model.count(k); ++i) out.p.push_back(full.p[full.model.offset(k) + i]);
  }
  out.model = FrictionModel(full.model.law(), effects, full.model.records());
  return out;
}

}  // namespace tribofit::diagnosis
