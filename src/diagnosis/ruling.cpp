#include "ruling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "evidence.hpp"
#include "limits.hpp"
#include "record_evidence.hpp"

namespace tribofit::diagnosis {

namespace {

/// Index of an effect as it is spelled among the candidates; their number where it is none.
std::size_t candidate_of(const std::vector<Candidate>& all, const std::string& spelled) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const Candidate& c) { return c.info.spelled() == spelled; });
  return static_cast<std::size_t>(at - all.begin());
}

/// The law with the effects that are not asked about, fitted one after the other.
Trial fit_beside(const DiagnosisContext& context, const Law& law, const std::vector<Effect>& beside,
                 const std::vector<Candidate>& all) {
  Trial top = try_base(context, context.fine, FrictionModel(law, {}, context.records.size()));
  for (const Effect& effect : beside) {
    const std::size_t k = candidate_of(all, describe(effect).spelled());
    if (k == all.size() || !top.usable || !top.model.acts_with(effect)) continue;
    top = try_with(context, context.fine, top, all[k]);
  }
  return top;
}

/// The trial with one effect more, searched for as a diagnosis does: among means over more samples where that shows it.
Trial search_effect(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                    const Candidate& effect) {
  if (effect.info.needs_full_resolution || !coarse_top.usable) return try_with(context, context.fine, top, effect);
  const Trial coarse = try_with(context, context.coarse, coarse_top, effect);
  Trial fine = try_model(context, context.fine, coarse.model, coarse.p);
  fine.places = coarse.places;
  return fine;
}

}  // namespace

Ruling rule_between(std::span<const Record> records, const Law& law, const std::vector<Effect>& beside,
                    const std::vector<Effect>& effects, const Instruments& instruments) {
  Ruling out;
  for (const Effect& effect : effects) out.effects.push_back({.spelled = describe(effect).spelled()});
  if (count_cycles(records) < limits::kFewestCycles) return out;
  const RecordEvidence evidence(records, 1);
  const DiagnosisContext& context = evidence.context;
  const std::vector<Candidate> all = candidates(records, evidence.fine, {}, instruments);
  const Trial top = fit_beside(context, law, beside, all);
  if (!top.usable) return out;
  const Trial coarse_top = try_model(context, context.coarse, top.model, top.p);

  std::vector<CandidateResult> judged;
  std::vector<std::size_t> asked;  // which effect each is
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::size_t k = candidate_of(all, out.effects[e].spelled);
    if (k == all.size() || !all[k].untestable.empty() || !top.model.acts_with(all[k].effect)) continue;
    Trial found = search_effect(context, top, coarse_top, all[k]);
    const double tests = found.places * static_cast<double>(all.size());
    judged.push_back(compare(context, context.fine, top, std::move(found), all[k], tests, Limits{}));
    judged.back().candidate = k;
    asked.push_back(e);
  }
  const Choice choice = choose(context, judged, all);
  const CandidateResult* best = nullptr;
  for (const CandidateResult& one : judged) {
    if (one.passes && (best == nullptr || one.trial.held_out_squares < best->trial.held_out_squares)) best = &one;
  }
  for (std::size_t t = 0; t < judged.size(); ++t) {
    Ruling::OfEffect& effect = out.effects[asked[t]];
    effect.passes = judged[t].passes;
    effect.p_value = judged[t].p_value;
    if (!judged[t].trial.usable) continue;
    const CandidateResult& unit_of = best != nullptr ? *best : judged[t];
    const double unit = noise_of(context.fine, unit_of.trial) * unit_of.design_effect;
    effect.fall = judged[t].fall / unit;
    if (best == nullptr) continue;
    effect.behind =
        judged[t].passes ? choice.behind[t] : (judged[t].trial.held_out_squares - best->trial.held_out_squares) / unit;
  }
  out.least_by_size = choice.least_by_size;
  if (choice.leader) out.leader = asked[*choice.leader];
  for (const std::size_t candidate : choice.group) {
    for (std::size_t t = 0; t < judged.size(); ++t) {
      if (judged[t].candidate == candidate) out.group.push_back(asked[t]);
    }
  }
  return out;
}

}  // namespace tribofit::diagnosis
