/// Coverage of the intervals of effects where law and effects are known: what the fit itself does, without the search.
#include <algorithm>
#include <cmath>
#include <utility>

#include "hidden_effects.hpp"
#include "tribofit/fit/fit.hpp"

namespace recovery {

using namespace tribofit;

namespace {

/// A record through the stages before the fit, as the diagnosis takes it.
struct Prepared {
  Motion motion;
  Segmentation segmentation;
};

Prepared prepare(const Trace& trace, bool wrong_plateau) {
  MotionOptions options;
  if (wrong_plateau) options.plateau = PlateauCorrection::radius;
  Prepared out;
  out.motion = compute_motion(trace, {}, options);
  out.segmentation = find_cycles(out.motion);
  return out;
}

/// Effects that act in friction, with what the truth says of them after the base law.
std::pair<FrictionModel, std::vector<double>> in_friction(const Simulated& simulated) {
  const FrictionModel& model = simulated.model;
  std::vector<Effect> effects;
  std::vector<double> truth(simulated.truth.begin(),
                            simulated.truth.begin() + static_cast<std::ptrdiff_t>(model.base_count()));
  for (std::size_t k = 0; k < model.effects().size(); ++k) {
    const Effect& effect = model.effects()[k];
    if (is_of_motion(effect)) continue;
    effects.push_back(effect);
    const std::size_t count = describe(effect).parameters.size();
    for (std::size_t i = 0; i < count; ++i) truth.push_back(simulated.truth[model.offset(k) + i]);
  }
  return {FrictionModel(model.law(), std::move(effects)), std::move(truth)};
}

}  // namespace

KnownFit fit_known(const Case& c, const Simulated& simulated) {
  const bool wrong_plateau = std::any_of(c.hidden.begin(), c.hidden.end(), [](const Ingredient& what) {
    return what.key == "radius-offset" || what.key == "velocity-gain";
  });
  std::vector<Prepared> prepared;
  for (const auto& trace : simulated.traces) prepared.push_back(prepare(*trace, wrong_plateau));
  auto [model, truth] = in_friction(simulated);
  std::size_t cycles = 0;
  for (const Prepared& p : prepared) cycles += p.segmentation.cycles.size();
  std::vector<Observations> parts;
  std::vector<Record> records;
  const std::size_t values = std::clamp<std::size_t>(20000 / std::max<std::size_t>(1, cycles), 80, 400);
  for (const Prepared& p : prepared) {
    parts.push_back(observe(p.motion, p.segmentation, model.needs(), values));
    records.push_back({&p.motion, &p.segmentation});
  }
  const Observations observations = parts.size() == 1 ? std::move(parts[0]) : join(std::move(parts));
  FitOptions options;
  options.start = truth;
  KnownFit out;
  out.truth = truth;
  out.fit = fit_model(model, records, observations, {}, options);
  return out;
}

}  // namespace recovery
