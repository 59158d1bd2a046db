#include "joint_sharing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "fit/shared_fit.hpp"
#include "kept_samples.hpp"
#include "limits.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace tribofit {
namespace {

/// Why means over a few samples, without channels, are not enough for a model; empty where they are.
std::string needs_more(const FrictionModel& model) {
  for (const Effect& effect : model.effects()) {
    const EffectInfo info = describe(effect);
    const bool own =
        std::ranges::find(info.parameters, ParameterScope::record, &Parameter::scope) != info.parameters.end();
    if (own || info.needs_full_resolution || model.state_count() > 0 || info.needs != Channels{})
      return info.key + " acts on more than speed";
  }
  return "";
}

/// The runs as their fit sees them, read one after the other.
struct Together {
  std::deque<Observations> observations;
  std::vector<SharingRecord> records;
  Bounds bounds;
  std::size_t values = 0;
  double squares_within = 0, samples = 0;  ///< of friction about the values
};

/// The widest bounds of the runs; a parameter that is held in all of them stays held.
void widen_bounds(const CondensedRun::OfFit& fit, Bounds& bounds) {
  if (bounds.lower.empty()) bounds = {fit.lower, fit.upper};
  for (std::size_t k = 0; k < fit.lower.size(); ++k) {
    bounds.lower[k] = std::min(bounds.lower[k], fit.lower[k]);
    bounds.upper[k] = std::max(bounds.upper[k], fit.upper[k]);
  }
}

/// Adds a run; why it cannot be where it cannot.
std::string add_run(const ResultReader& results, const RunResult& run, const ResultFit& own, const FrictionModel& model,
                    Together& out) {
  CondensedRun condensed = results.condensed(run.position).value_or(CondensedRun());
  const auto fit =
      std::ranges::find_if(condensed.fits, [&](const auto& f) { return f.law == own.law && f.effects == own.effects; });
  if (fit == condensed.fits.end() || fit->lower.size() != own.parameters.size())
    return run.run.name + " was kept by an earlier version; --again fits it anew";
  const auto& slips = condensed.observations.slips;
  const bool sticks = std::ranges::any_of(slips, [](const auto& slip) { return slip.from_stick; });
  if (describe(model.law()).steep_at_rest && sticks)
    return "the " + own.law + " law is steep at rest, where a run keeps means only";
  out.values += condensed.observations.size();
  if (out.values > kMostValuesTogether) return fmt::format("the runs have more than {} values", kMostValuesTogether);
  for (const double weight : condensed.observations.weight) {
    out.squares_within += weight * condensed.within;
    out.samples += weight;
  }
  SharingRecord& record = out.records.emplace_back();
  widen_bounds(*fit, out.bounds);
  record.is_points = condensed.is_points;
  record.observations = &out.observations.emplace_back(std::move(condensed.observations));
  record.common.assign(own.parameters.size(), SharingRecord::kOwn);
  for (std::size_t k = 0; k < own.parameters.size(); ++k) {
    record.values.push_back(own.parameters[k].value * model.parameters()[k].parameter.si);
    if (!std::isfinite(record.values.back())) return "the fit of " + run.run.name + " failed";
  }
  return "";
}

std::size_t members_of(const SharedLaw& law, std::size_t common, std::size_t level) {
  return static_cast<std::size_t>(std::ranges::count(law.level[common], level));
}

/// Every value is known from the single fits of all of its runs.
bool all_know(const SharedLaw& law, const SharedFit& fit) {
  for (std::size_t c = 0; c < fit.common.size(); ++c) {
    for (std::size_t l = 0; l < fit.common[c].values.size(); ++l) {
      if (fit.common[c].values[l].runs != members_of(law, c, l)) return false;
    }
  }
  return true;
}

void take_common(const RecordsFit& found, const FrictionModel& model, const SharedLaw& law, SharedFit& fit) {
  std::size_t next = 0;
  for (std::size_t c = 0; c < fit.common.size(); ++c) {
    const double si = model.parameters()[law.parameters[c]].parameter.si;
    for (std::size_t l = 0; l < fit.common[c].values.size(); ++l) {
      const SharedEstimate& estimate = found.common[next++];
      PooledValue& value = fit.common[c].values[l];
      value.runs = members_of(law, c, l);
      const auto known = [&](double error) { return estimate.determined ? error / si : kUnknown; };
      value.value = estimate.value / si;
      value.std_error = known(estimate.std_error);
      value.lower95 = known(estimate.lower95);
      value.upper95 = known(estimate.upper95);
      value.statistical = known(estimate.statistical);
      // Scatter between the runs that would widen the error as much.
      const double beyond = std::max(0.0, value.std_error * value.std_error - value.statistical * value.statistical);
      value.between = value.runs > 1 ? std::sqrt(beyond * static_cast<double>(value.runs)) : kUnknown;
      if (!estimate.determined) fit.notes.push_back(fit.common[c].at(l) + " is not determined by these runs");
    }
  }
}

void take_runs(const RecordsFit& found, const FrictionModel& model, const SharedLaw& law, SharedFit& fit) {
  fit.runs.clear();
  for (std::size_t i = 0; i < law.runs.size(); ++i) {
    SharedFit::OfRun& run = fit.runs.emplace_back();
    run.run = law.runs[i];
    for (std::size_t k = 0; k < found.records[i].size(); ++k) {
      const SharedEstimate& estimate = found.records[i][k];
      const double si = model.parameters()[k].parameter.si;
      run.value.push_back(estimate.value / si);
      run.std_error.push_back(estimate.determined ? estimate.std_error / si : kUnknown);
    }
  }
}

/// Whether the runs allow it; held-out errors over all samples, which scatter about the values alike in both.
void take_test(const RecordsFit& found, std::span<const RunResult> runs, const SharedLaw& law, const Together& all,
               SharedFit& fit) {
  const double within = all.squares_within / all.samples;
  fit.test.p_value = found.test.degrees_of_freedom > 0 ? found.test.p_value : kUnknown;
  fit.test.ratio = found.test.ratio;
  fit.test.is_refused = found.test.is_refused();
  fit.test.most_different = runs[law.runs[found.test.most_different]].run.name;
  fit.test.held_out_alone = std::hypot(found.held_out_rmse_alone, std::sqrt(within));
  fit.test.held_out_together = std::hypot(found.held_out_rmse_together, std::sqrt(within));
  fit.test.held_out_p_value = found.held_out.p_value;
}

}  // namespace

std::string fit_jointly(const ResultReader& results, std::span<const RunResult> runs, const SharedLaw& law,
                        SharedFit& fit) {
  std::vector<Effect> effects;
  for (const std::string& key : law.like.effects) {
    const auto catalogue = effect_catalogue();
    const auto known =
        std::ranges::find_if(catalogue, [&](const Effect& effect) { return describe(effect).key == key; });
    if (known == catalogue.end()) return key + " is not of the catalogue";
    effects.push_back(*known);
  }
  const FrictionModel model(make_law(law.like.law), std::move(effects));
  if (std::string why = needs_more(model); !why.empty()) return why;
  if (model.parameters().size() != fit.names.size()) return "a run was fitted with another form of an effect";
  Together all;
  for (const std::size_t r : law.runs) {
    std::string why = add_run(results, runs[r], *runs[r].fit(law.like.law, law.like.protocol), model, all);
    if (!why.empty()) return why;
  }
  std::size_t count = 0;  // the common values of all levels, one after the other
  for (std::size_t c = 0; c < fit.common.size(); ++c) {
    for (std::size_t i = 0; i < all.records.size(); ++i)
      all.records[i].common[law.parameters[c]] = count + law.level[c][i];
    count += fit.common[c].values.size();
  }
  const RecordsFit found = fit_sharing_records(model, all.records, all.bounds, count);
  if (!found.converged) return "it " + found.message;
  take_test(found, runs, law, all, fit);
  if (fit.test.is_refused && all_know(law, fit)) return "";
  fit.is_joint = true;
  take_common(found, model, law, fit);
  take_runs(found, model, law, fit);
  return "";
}

}  // namespace tribofit
