#include "differing_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "fit/assessment.hpp"
#include "fit/fit_laws.hpp"
#include "limits.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

/// What the law leaves of each run by itself, over all samples.
struct OwnFits {
  double held_out_rmse = 0, floor_rmse = 0;
  bool known = false;
};

/// The fit of one run by the law that leaves the least of it on cycles that are held out.
Fit own_fit(const Identification& trace, const IdentifyOptions& options, const std::vector<Effect>& effects) {
  const Record record = {&trace.motion, &trace.segmentation};
  Fit least;
  for (const Law& law : options.laws) {
    const FrictionModel model(law, effects);
    Fit fit = fit_model(model, {&record, 1}, observations_for(model, {&record, 1}), options.instruments, options.fit);
    if (fit.parameters.empty()) continue;
    const bool less = least.parameters.empty() || fit.error.held_out_rmse < least.error.held_out_rmse;
    if (less) least = std::move(fit);
  }
  return least;
}

OwnFits fit_each(const std::vector<PreparedTrace>& traces, const IdentifyOptions& options,
                 const std::vector<Effect>& effects) {
  std::vector<Fit> fits(traces.size());
  run_tasks(traces.size(), options.threads,
            [&](std::size_t k) { fits[k] = own_fit(traces[k].trace, options, effects); });
  OwnFits own;
  double squares = 0, floors = 0, count = 0;
  for (const Fit& fit : fits) {
    if (fit.parameters.empty() || fit.cycles < limits::kFewestCyclesOfARun) return own;
    const auto n = static_cast<double>(fit.observations);
    squares += n * fit.error.held_out_rmse * fit.error.held_out_rmse;
    floors += n * fit.floor.rmse * fit.floor.rmse;
    count += n;
  }
  own.held_out_rmse = std::sqrt(squares / count);
  own.floor_rmse = std::sqrt(floors / count);
  own.known = std::isfinite(own.held_out_rmse) && std::isfinite(own.floor_rmse);
  return own;
}

void take_effects_back(Diagnosed& diagnosed) {
  Diagnosis& diagnosis = diagnosed.diagnosis;
  for (EffectFinding& effect : diagnosis.effects) {
    const bool follows = effect.status == EffectStatus::found || effect.status == EffectStatus::equivalent ||
                         effect.status == EffectStatus::possible || effect.status == EffectStatus::superseded;
    if (!follows) continue;
    effect.status = EffectStatus::not_supported;
    effect.reason = "each run by itself is described without it; it follows what differs between the runs";
  }
  diagnosed.fits.resize(1);
  diagnosis.ladder.resize(1);
  diagnosis.remaining = diagnosis.where;
  diagnosis.formula.clear();
  diagnosis.messages.clear();  // of what the effects left
}

}  // namespace

void withhold_of_differing_runs(const std::vector<PreparedTrace>& traces, const IdentifyOptions& options,
                                const std::vector<Effect>& from_the_start, Diagnosed& diagnosed) {
  Diagnosis& diagnosis = diagnosed.diagnosis;
  const bool ended = diagnosis.verdict == Verdict::effect_found || diagnosis.verdict == Verdict::unexplained;
  if (traces.size() < 2 || !ended || diagnosed.fits.empty()) return;
  const double floor = diagnosis.floor_rmse, together = diagnosed.fits.back().error.held_out_rmse;
  if (!(together > kWellAbove * floor)) return;
  const OwnFits own = fit_each(traces, options, from_the_start);
  if (!own.known) return;
  const double left = own.held_out_rmse * own.held_out_rmse - own.floor_rmse * own.floor_rmse;
  if (!(left < limits::kLeftByOwnFits * (together * together - floor * floor))) return;
  take_effects_back(diagnosed);
  diagnosis.verdict = Verdict::unexplained;
  diagnosis.messages.push_back(fmt::format(
      "the law differs from run to run: each run fitted by itself leaves {:.3g} on cycles that are held out (noise "
      "floor {:.3g}), all together leave {:.3g}; no effect is named from differences between runs",
      own.held_out_rmse, own.floor_rmse, diagnosed.fits.front().error.held_out_rmse));
  diagnosis.next_experiment =
      "Diagnose each run by itself, and fit them as a campaign: --vary mu_s:radius gives one value of a parameter for "
      "each value of a condition, and the trends show what it goes with.";
}

}  // namespace tribofit::diagnosis
