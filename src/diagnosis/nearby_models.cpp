#include "nearby_models.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fit/starts.hpp"
#include "limits.hpp"

namespace tribofit::diagnosis {

Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads) {
  Trial rest = without_effect(full, key);
  return try_model(context, level, rest.model, std::move(rest.p), threads);
}

Trial try_law(const DiagnosisContext& context, const Law& law, const Trial& known) {
  std::vector<Effect> effects(known.model.effects().begin(), known.model.effects().end());
  if (!std::ranges::all_of(effects, [&](const Effect& e) { return obstacle_on(law, e).empty(); })) return {};
  const FrictionModel model(law, std::move(effects), known.model.records());
  const Level& level = context.coarse;
  std::vector<double> from_data = start_from_data(model, level.observations, level.bounds_of(model));
  std::vector<double> from_levels = from_data;
  for (std::size_t k = 0; k < model.parameters().size(); ++k) {
    const std::string name = model.parameters()[k].full_name();
    for (std::size_t i = 0; i < known.p.size(); ++i) {
      if (known.model.parameters()[i].full_name() != name) continue;
      from_levels[k] = known.p[i];
      if (k >= model.base_count()) from_data[k] = known.p[i];
    }
  }
  std::vector<std::vector<double>> starts = {std::move(from_data)};
  if (!model.effects().empty()) {
    std::ranges::move(falling_elsewhere(level.observations, model, from_levels), std::back_inserter(starts));
    starts.push_back(std::move(from_levels));
  }
  return try_model(context, level, model, nearest_if_several(level, model, {}, starts));
}

LawStanding standing_of(const DiagnosisContext& context, const Trial& trial) {
  if (!trial.usable) return LawStanding::another;
  const Law& law = trial.model.law();
  const double fastest = context.fine.observations.fastest;
  const bool rises = !constant_in_slip(law) && friction_at_rest(law, trial.p) < kinetic_friction(law, trial.p, fastest);
  if (rises && remaining_fall(law, trial.p, fastest)) return LawStanding::another;
  const auto last = trial.at_bound.begin() + static_cast<std::ptrdiff_t>(trial.model.base_count());
  const bool on_bound = std::find(trial.at_bound.begin(), last, true) != last;
  return rises || on_bound ? LawStanding::doubtful : LawStanding::sound;
}

std::vector<Law> competing_laws(const std::vector<Law>& given, std::span<const Effect> effects) {
  if (given.size() == 1) return given;
  std::vector<Law> laws;
  for (const Law& law : law_catalogue()) {
    if (std::ranges::all_of(effects, [&](const Effect& e) { return obstacle_on(law, e).empty(); })) laws.push_back(law);
  }
  return laws;
}

}  // namespace tribofit::diagnosis
