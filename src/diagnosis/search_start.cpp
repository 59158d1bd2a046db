#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "limits.hpp"
#include "trial.hpp"

namespace tribofit::diagnosis {

std::vector<double> with_amplitude_and_phase(const ModelResiduals& residuals, const FrictionModel& model,
                                             const EffectInfo& effect, const Bounds& bounds,
                                             std::vector<double> start) {
  const auto& parameters = effect.parameters;
  const auto is_phase = [](const Parameter& q) { return q.periodic; };
  if (std::count_if(parameters.begin(), parameters.end(), is_phase) != 1 || parameters[0].neutral != 0) return start;
  if (model.count_of(effect.key) != parameters.size()) return start;  // phases of several records
  const std::size_t amplitude = model.offset_of(effect.key);
  const auto found = std::find_if(parameters.begin(), parameters.end(), is_phase);
  const std::size_t phase = amplitude + static_cast<std::size_t>(found - parameters.begin());
  const CycleEvidence evidence = evidence_of(residuals.white_rows(start.data()));
  if (!evidence.finite || !(start[amplitude] > 0)) return start;
  std::vector<bool> free(start.size(), true);
  for (std::size_t k = 1; k < parameters.size(); ++k) free[amplitude + k] = amplitude + k == phase;
  const Eigen::VectorXd step = gauss_newton_step(evidence, free);
  const double along = start[amplitude] + step[static_cast<Eigen::Index>(amplitude)];
  const double across = start[amplitude] * step[static_cast<Eigen::Index>(phase)];
  std::vector<double> better = start;
  better[amplitude] = std::clamp(std::hypot(along, across), bounds.lower[amplitude], bounds.upper[amplitude]);
  better[phase] = std::remainder(start[phase] + std::atan2(across, along), 2 * std::numbers::pi);
  return residuals.white_squares(better.data()) < residuals.white_squares(start.data()) ? better : start;
}

namespace {

/// A start of a model with one effect more, and what a linear step from there promises.
struct RankedStart {
  std::vector<double> start;  ///< of all parameters
  std::vector<double> place;  ///< the values of the effect that are no phases
  double score = 0, squares = 0;
};

/// The start with the effect's `values` among the parameters of the base: the model has an order of its own. Phases
/// that further records have are those of the first.
RankedStart start_with(const std::vector<double>& base, const FrictionModel& model, const EffectInfo& effect,
                       const std::vector<double>& values, const Bounds& bounds) {
  RankedStart promise;
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

/// Parameters of the base from which a search begins: as fitted, and where the law alone has become a straight line
/// also with the law falling at other speeds: it may have taken the place of the effect, and no step leads back.
std::vector<std::vector<double>> bases_of_search(const Level& level, const Trial& base) {
  std::vector<std::vector<double>> out = {base.p};
  const Law& law = base.model.law();
  const double fastest = level.observations.fastest;
  const bool rises = friction_at_rest(law, base.p) < kinetic_friction(law, base.p, fastest) ||
                     remaining_fall(law, base.p, fastest).value_or(0) >= limits::kStraight;
  if (!base.model.effects().empty() || !rises) return out;
  std::vector<double> anew = start_from_data(base.model, level.observations, level.bounds_of(base.model));
  std::copy(base.p.begin() + static_cast<std::ptrdiff_t>(base.model.base_count()), base.p.end(),
            anew.begin() + static_cast<std::ptrdiff_t>(base.model.base_count()));
  std::ranges::move(falling_elsewhere(level.observations, base.model, anew), std::back_inserter(out));
  return out;
}

/// Squares at a start and after a linear step from it, less those of a rigid stick (the same at every start); nothing
/// where they are not finite.
struct StepSquares {
  double here = 0, there = 0;
};
std::optional<StepSquares> squares_of_step(const ModelResiduals& residuals, const std::vector<double>& start,
                                           const Bounds& bounds, double rigid) {
  const CycleEvidence evidence = evidence_of(residuals.white_rows(start.data()));
  if (!evidence.finite) return std::nullopt;
  const auto n = static_cast<Eigen::Index>(start.size());
  const Eigen::Map<const Eigen::VectorXd> from(start.data(), n), lower(bounds.lower.data(), n),
      upper(bounds.upper.data(), n);
  return StepSquares{sum(evidence.squares) - rigid,
                     sum(squares_after(evidence, bounded_step(evidence, lower - from, upper - from))) - rigid};
}

/// The start of one place in which every record has the phases with which it leaves least, of those that were tried.
std::optional<RankedStart> combined_phases(const FrictionModel& model, const ModelResiduals& residuals,
                                           const Observations& observations, const std::vector<RankedStart>& tried) {
  std::optional<RankedStart> best;
  std::vector<double> least(model.records(), std::numeric_limits<double>::infinity());
  for (const RankedStart& one : tried) {
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
std::optional<RankedStart> nearest_phase(const ModelResiduals& residuals, const std::vector<RankedStart>& tried) {
  if (tried.size() == 1) return tried[0];
  std::map<double, const RankedStart*> by_squares;
  for (const RankedStart& one : tried) {
    const double here = residuals.white_squares(one.start.data());
    if (std::isfinite(here)) by_squares.emplace(here, &one);
  }
  return by_squares.empty() ? std::nullopt : std::optional(*by_squares.begin()->second);
}

}  // namespace

std::vector<std::vector<double>> falling_elsewhere(const Observations& observations, const FrictionModel& model,
                                                   const std::vector<double>& start) {
  std::vector<std::vector<double>> out;
  if (std::ranges::any_of(observations.slips, [](const auto& slip) { return slip.from_stick; })) return out;
  for (std::size_t k = 0; k < model.base_count(); ++k) {
    const BoundScaling scaling = model.parameters()[k].parameter.bound_scaling;
    if (scaling != BoundScaling::against_speed && scaling != BoundScaling::with_speed) continue;
    for (const double part : limits::kFallsWithin) {  // of the fastest slip
      const double speed = part * observations.fastest;
      out.push_back(start);
      out.back()[k] = scaling == BoundScaling::with_speed ? speed : 1 / speed;
    }
  }
  return out;
}

SearchStart search_start_of(const DiagnosisContext& context, const Level& level, const Trial& base,
                            const Candidate& candidate, std::span<const double> residual, const LeastFalls& least) {
  const FrictionModel model = with_effect(base.model, candidate.effect);
  const ModelResiduals residuals = residuals_of(level.observations, model, base.whitening);
  const Bounds bounds = level.bounds_of(model);
  const Starts starts = starts_of(candidate, context.records, context.fine.observations, residual);
  std::vector<RankedStart> promises;
  const std::vector<std::vector<double>> bases = bases_of_search(level, base);
  std::optional<double> rigid;
  const auto try_start = [&](RankedStart promise) {
    if (!rigid) rigid = all_sticks(residuals.stick_squares(promise.start.data())).rigid;
    const std::optional<StepSquares> step = squares_of_step(residuals, promise.start, bounds, *rigid);
    if (!step) return;
    promise.squares = std::min(step->here, step->there);
    promise.score = step->there + 1e-2 * step->here;  // the start that is lower now is the nearer one
    promises.push_back(std::move(promise));
  };
  std::map<std::vector<double>, std::vector<RankedStart>> places;
  for (const auto& values : starts.values) {
    for (std::size_t from = 0; from < bases.size(); ++from) {
      RankedStart promise = start_with(bases[from], model, candidate.info, values, bounds);
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
                   [](const RankedStart& a, const RankedStart& b) { return a.score < b.score; });
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

Trial try_with(const DiagnosisContext& context, const Level& level, const Trial& base, const Candidate& effect) {
  const SearchStart search = search_start_of(context, level, base, effect, residual_of(context, base), LeastFalls());
  const FrictionModel model = with_effect(base.model, effect.effect);
  Trial out = search.starts.empty()
                  ? try_base(context, level, model)
                  : try_model(context, level, model, nearest_if_several(level, model, base.whitening, search.starts));
  out.places = search.places;
  return out;
}

}  // namespace tribofit::diagnosis
