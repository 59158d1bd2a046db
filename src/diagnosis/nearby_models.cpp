#include "nearby_models.hpp"

#include <algorithm>
#include <utility>

#include "fit/starts.hpp"
#include "limits.hpp"
#include "stepwise.hpp"

namespace tribofit::diagnosis {

Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads) {
  Trial rest = without_effect(full, key);
  return try_model(context, level, rest.model, std::move(rest.p), threads);
}

Trial try_instead(const DiagnosisContext& context, const Trial& rest, const Candidate& candidate, const Trial& judged) {
  FrictionModel model = with_effect(rest.model, candidate.effect);
  const std::size_t offset = model.offset_of(candidate.info.key), added = model.count_of(candidate.info.key);
  const auto from = judged.p.begin() + static_cast<std::ptrdiff_t>(judged.model.offset_of(candidate.info.key));
  std::vector<double> start = rest.p;
  start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset), from, from + static_cast<std::ptrdiff_t>(added));
  return try_model(context, context.coarse, model, std::move(start));
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
  if (!model.effects().empty()) starts.push_back(std::move(from_levels));
  return try_model(context, level, model, nearest_if_several(level, model, {}, starts));
}

bool is_law_of_its_own(const DiagnosisContext& context, const Trial& trial) {
  const Law& law = trial.model.law();
  if (!trial.usable) return false;
  const double fastest = context.fine.observations.fastest;
  return constant_in_slip(law) || friction_at_rest(law, trial.p) > kinetic_friction(law, trial.p, fastest) ||
         remaining_fall(law, trial.p, fastest).value_or(0) < limits::kStraight;
}

bool is_on_bound(const Trial& trial) {
  const auto last = trial.at_bound.begin() + static_cast<std::ptrdiff_t>(trial.model.base_count());
  return std::find(trial.at_bound.begin(), last, true) != last;
}

double largest_fall(const std::vector<Probe>& probes) {
  const std::vector<Probe> structure = remaining_structure(probes);
  return structure.empty() ? 0 : structure.front().fall;
}

void withdraw(Ladder& ladder, double swinging) {
  const double left = largest_fall(ladder.steps.back().probes);
  if (left == 0 && swinging == 0) return;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {
    const Trial &below = ladder.steps[s - 1].trial, &trial = ladder.steps[s].trial;
    const double shown = largest_fall(ladder.steps[s - 1].probes);
    const bool is_little = !ladder.steps[s].by_level && left >= limits::kLeastStructure * shown && left > 0 &&
                           below.held_out_squares - trial.held_out_squares < limits::kWithdrawnPart * shown;
    // What acts by the levels of break-away alone hardly shows in squares that are whitened against their scatter.
    if (!is_little && !(below.plain_held_out - trial.plain_held_out < swinging)) continue;
    for (std::size_t k = s; k < ladder.steps.size(); ++k) ladder.withdrawn.push_back(*ladder.steps[k].added);
    ladder.last = ladder.steps[s].judged;
    ladder.steps.resize(s);
    return;
  }
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
