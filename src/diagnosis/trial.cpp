#include "trial.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "limits.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/fit/solver.hpp"
#include "tribofit/friction/evaluate.hpp"

namespace tribofit::diagnosis {

ModelResiduals residuals_of(const Observations& observations, const FrictionModel& model,
                            const ModelResiduals::Whitening& whitening, int threads, bool scatter) {
  ModelResiduals residuals(model, observations, all_slips(observations), {Loss::squares, 0, threads});
  residuals.weaken_stick(whitening.stick);
  if (scatter && whitening.any()) residuals.whiten(whitening);
  return residuals;
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

namespace {

/// Adds what each cycle pays for the scatter of break-away.
void pay_for_scatter(const ModelResiduals::Whitening& whitening, std::vector<double>& squares) {
  for (std::size_t c = 0; c < std::min(squares.size(), whitening.log_spread.size()); ++c)
    squares[c] += whitening.noise * whitening.log_spread[c];
}

/// Whether a law of creep has earned what it gains in stick: of all that v_r shows there beyond its noise it must
/// explain most; less than that, something else moves the block.
bool is_earned(const ModelResiduals::StickSquares& stick, double noise) {
  const double gain = stick.rigid - stick.left, shown = stick.rigid - stick.rows * noise * noise;
  return gain <= 0 || gain >= limits::kMostOfTheError * shown;
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
  trial.evidence = evidence_of(residuals.white_rows(trial.p.data()));
  trial.usable = trial.evidence.finite;
  if (!trial.usable) return 0;
  const std::size_t n = trial.p.size();
  trial.at_bound.assign(n, false);
  trial.free.assign(n, true);
  for (std::size_t k = 0; k < n; ++k) {
    const double tolerance = 1e-3 * (bounds.upper[k] - bounds.lower[k]);
    trial.at_bound[k] = trial.p[k] <= bounds.lower[k] + 1e-3 * tolerance || trial.p[k] >= bounds.upper[k] - tolerance;
    trial.free[k] = !trial.at_bound[k];
  }
  // Several records have levels of their own, which are no noise that wanders from one to the next.
  if (context.records.size() == 1) {
    trial.evidence.level = level_change(trial.model, trial.p);
    trial.evidence.known_flicker = context.fine.observations.flicker;
  }
  std::vector<double> squares = trial.evidence.squares;
  trial.row_squares = sum(squares);
  trial.held_out = held_out_squares(trial.evidence, trial.free, context.blocks);
  trial.row_held_out_squares = sum(trial.held_out);
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
void judge_plainly(const std::vector<std::size_t>& blocks, const ModelResiduals& residuals, double off, Trial& trial) {
  CycleEvidence& plain = trial.plain;
  plain = evidence_of(residuals.white_rows(trial.p.data()));
  plain.level = trial.evidence.level;
  trial.plain_squares = sum(plain.squares) - off;
  plain = moved(plain, gauss_newton_step(plain, trial.free));
  trial.plain_minimum = sum(plain.squares) - off;
  trial.plain_cycles = held_out_squares(plain, trial.free, blocks);
  trial.plain_held_out = sum(trial.plain_cycles) - off;
}

/// As far as a comparison can see.
SolverOptions search_of(int iterations) {
  return {.max_iterations = iterations,
          .relative_step = 1e-7,
          .relative_cost = 1e-5,
          .careful = false,
          .hold_at_bounds = true};
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
  trial.p = minimize(residuals, start, bounds.lower, bounds.upper, search_of(20)).p;
  wrap_phases(model, trial.p);
  // Scatter is known better once the model is: a start may see as scatter what an effect explains.
  trial.whitening = plain.whitening_at(trial.p.data());
  const ModelResiduals::StickSquares stick = all_sticks(plain.stick_squares(trial.p.data()));
  trial.whitening.stick = part_of_stick(stick, context.noise);
  const ModelResiduals again = residuals_of(observations, model, trial.whitening, threads);
  trial.p = minimize(again, trial.p, bounds.lower, bounds.upper, search_of(trial.whitening.stick < 1 ? 20 : 5)).p;
  const double off = judge(context, again, is_earned(stick, context.noise), bounds, trial);
  if (!trial.usable) return trial;
  judge_plainly(context.blocks, residuals_of(observations, model, trial.whitening, threads, false), off, trial);
  return trial;
}

Solution nearest(const Level& level, const FrictionModel& model, const ModelResiduals::Whitening& whitening,
                 const std::vector<std::vector<double>>& starts) {
  const Bounds bounds = level.bounds_of(model);
  const ModelResiduals residuals = residuals_of(level.observations, model, whitening);
  Solution best;
  for (const auto& start : starts) {
    Solution next = minimize(residuals, start, bounds.lower, bounds.upper, search_of(8));
    if (best.p.empty() || next.cost < best.cost) best = std::move(next);
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
  return try_model(context, level, model, minimize(plain, start, bounds.lower, bounds.upper, search_of(40)).p, threads);
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
