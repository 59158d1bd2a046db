#include "fit_laws.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "observing.hpp"
#include "requested_effects.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/effects/all.hpp"

namespace tribofit {

namespace {

/// Every model and protocol to fit: joint fits first, then the per-cycle extremes for the bare laws. Points have no
/// cycles; their laws are fitted with a viscous part as well, where no effect is asked for.
std::vector<std::pair<FrictionModel, FitOptions>> planned_fits(const IdentifyOptions& options,
                                                               const std::vector<Effect>& effects, bool has_cycles) {
  std::vector<std::pair<FrictionModel, FitOptions>> fits;
  FitOptions inner = options.fit;
  for (const Law& law : options.laws) fits.emplace_back(FrictionModel(law, effects), inner);
  // A table mostly reaches over the whole Stribeck curve, where friction rises again with speed.
  for (const Law& law : options.laws) {
    const Effect& rise = effect_with(&EffectInfo::proportional_to_speed);
    if (!has_cycles && effects.empty()) fits.emplace_back(FrictionModel(law, {rise}), inner);
  }
  inner.protocol = Protocol::published;
  for (const Law& law : options.laws) {
    const LawInfo info = describe(law);
    const bool fits_more = info.has_per_cycle_extremes() && !info.constant_in_slip;  // than the extremes themselves
    if (options.published_protocol && fits_more && has_cycles) fits.emplace_back(FrictionModel(law), inner);
  }
  return fits;
}

/// Index of the fit with the least error on held-out cycles, among those of the first fit's protocol.
std::size_t best_of(const std::vector<Fit>& fits) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < fits.size(); ++k) {
    if (fits[k].protocol != fits[0].protocol || fits[k].parameters.empty()) continue;
    if (fits[best].parameters.empty() || fits[k].error.held_out_rmse < fits[best].error.held_out_rmse) best = k;
  }
  return best;
}

/// One noise floor a trace, that of the best fit: it is a property of the data.
void share_floor(std::vector<Fit>& fits, std::size_t best) {
  const Floor floor = fits[best].floor;
  for (Fit& fit : fits) {
    if (!fit.parameters.empty()) set_floor(floor, fit);
  }
}

/// Effects may act within a few samples of break-away and re-stick, and so may some laws; the others are smooth.
std::size_t values_per_slip(const FrictionModel& model) {
  constexpr std::size_t kBare = 80, kFull = 1000;
  return model.effects().empty() && !describe(model.law()).steep_at_rest ? kBare : kFull;
}

/// What of a record a model looks at: models that look at the same share it.
struct View {
  explicit View(const FrictionModel& model)
      : needs(model.needs()), values(values_per_slip(model)), stick(model.acts_in_stick()) {}

  Observations of(const Record& record, const RecordNoise& noise) const {
    Observations out = observe(*record.motion, *record.segmentation, noise, needs, values);
    if (stick) add_stick_evidence(*record.motion, *record.segmentation, floor_of(noise).noise, out);
    return out;
  }

  bool operator==(const View&) const = default;

  Channels needs;
  std::size_t values;
  bool stick;
};

}  // namespace

Observations observations_for(const FrictionModel& model, std::span<const Record> records) {
  std::vector<Observations> parts;
  for (const Record& record : records) {
    const RecordNoise noise = noise_of(*record.motion, *record.segmentation);
    parts.push_back(View(model).of(record, noise));
  }
  return parts.size() == 1 ? std::move(parts[0]) : join(std::move(parts));
}

void fit_laws(const IdentifyOptions& options, const Motion& motion, TracePart& part) {
  const std::vector<Effect> effects = friction_effects(options.effects);
  if (slip_ranges(motion, part.segmentation).size() < kFewestCycles) {
    part.refuse("there are fewer than three cycles: no law can be fitted with an uncertainty");
    return;
  }
  const Record record = {&motion, &part.segmentation};
  auto fits = planned_fits(options, effects, !motion.is_points());
  part.fits.resize(fits.size());
  std::vector<View> views;
  std::vector<std::size_t> view_of;  // each fit
  for (const auto& [model, fit] : fits) {
    const auto known = std::find(views.begin(), views.end(), View(model));
    view_of.push_back(static_cast<std::size_t>(known - views.begin()));
    if (known == views.end()) views.emplace_back(model);
  }
  if (!part.noise) part.noise = noise_of(motion, part.segmentation, options.threads);
  std::vector<Observations> seen(views.size());
  run_tasks(views.size(), options.threads, [&](std::size_t v) { seen[v] = views[v].of(record, *part.noise); });
  run_tasks(fits.size(), options.threads, [&](std::size_t k) {
    auto& [model, fit] = fits[k];
    fit.threads = options.threads;  // one of them may take most of the time
    part.fits[k] = fit_model(model, motion, part.segmentation, seen[view_of[k]], options.instruments, fit);
  });
  part.best = best_of(part.fits);
  share_floor(part.fits, part.best);
}

}  // namespace tribofit
