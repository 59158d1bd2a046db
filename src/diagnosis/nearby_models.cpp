#include "nearby_models.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "fit/starts.hpp"
#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit::diagnosis {

Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads) {
  Trial rest = without_effect(full, key);
  return try_model(context, level, rest.model, std::move(rest.p), threads);
}

namespace {

/// The model of `rest` with the effect of a candidate, at the values found when it was judged, at low resolution.
Trial try_instead(const DiagnosisContext& context, const Trial& rest, const Candidate& candidate, const Trial& judged) {
  FrictionModel model = with_effect(rest.model, candidate.effect);
  const std::size_t offset = model.offset_of(candidate.info.key), added = model.count_of(candidate.info.key);
  const auto from = judged.p.begin() + static_cast<std::ptrdiff_t>(judged.model.offset_of(candidate.info.key));
  std::vector<double> start = rest.p;
  start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset), from, from + static_cast<std::ptrdiff_t>(added));
  return try_model(context, context.coarse, model, std::move(start));
}

}  // namespace

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

std::vector<CandidateResult> judge_near(const DiagnosisContext& context, const LadderStep& term, const Trial& full,
                                        const Trial& coarse_full, const Trial& without,
                                        const std::vector<Candidate>& candidates, const Limits& least) {
  const std::vector<std::string> present = without.model.effect_keys();
  const auto added = std::ranges::find(term.judged, *term.added, &CandidateResult::candidate);
  std::vector<const CandidateResult*> rivals;
  for (const CandidateResult& judged : term.judged) {
    const Candidate& candidate = candidates[judged.candidate];
    const bool near = added == term.judged.end() || judged.fall > limits::kRivalPart * added->fall;
    const bool is_present = std::ranges::find(present, candidate.info.key) != present.end();
    if (judged.trial.usable && judged.plausible && near && !is_present &&
        candidate.info.key != candidates[*term.added].info.key && without.model.acts_with(candidate.effect)) {
      rivals.push_back(&judged);
    }
  }
  std::vector<CandidateResult> out(rivals.size() + 1);
  out[0] = compare(context, context.fine, without, full, candidates[*term.added], 1, least);
  out[0].candidate = *term.added;
  const Trial rest = try_model(context, context.coarse, without.model, without.p);
  run_tasks(rivals.size(), context.threads, [&](std::size_t r) {
    const std::size_t k = rivals[r]->candidate;
    const Trial coarse = try_instead(context, rest, candidates[k], rivals[r]->trial);
    const double behind = coarse.held_out_squares - coarse_full.held_out_squares;
    out[r + 1].candidate = k;
    if (!coarse.usable || is_far_behind(context, behind, rest.held_out_squares - coarse_full.held_out_squares)) return;
    out[r + 1] = compare(context, context.fine, without, try_model(context, context.fine, coarse.model, coarse.p),
                         candidates[k], 1, least);
    out[r + 1].candidate = k;
  });
  return out;
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
