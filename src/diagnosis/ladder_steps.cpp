#include "ladder.hpp"

#include <algorithm>
#include <utility>

#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit::diagnosis {

Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads) {
  Trial rest = without_effect(full, key);
  return try_model(context, level, rest.model, std::move(rest.p), threads);
}

namespace {

/// The model of `without` with the effect of a judged candidate, at the values found when it was judged.
Trial try_instead(const DiagnosisContext& context, const Level& level, const Trial& without, const Candidate& candidate,
                  const Trial& judged) {
  FrictionModel model = with_effect(without.model, candidate.effect);
  const std::size_t offset = model.offset_of(candidate.info.key), added = model.count_of(candidate.info.key);
  const std::size_t from = judged.model.offset_of(candidate.info.key);
  std::vector<double> start = without.p;
  start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset),
               judged.p.begin() + static_cast<std::ptrdiff_t>(from),
               judged.p.begin() + static_cast<std::ptrdiff_t>(from + added));
  return try_model(context, level, model, std::move(start));
}

/// Puts the steps of a ladder in order anew, from the top down: what was found beside an effect that is gone need not
/// have come first. top: the trial with the effects of all its steps.
void put_in_order(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                  Trial top) {
  const auto key = [&](const LadderStep& step) { return candidates[*step.added].info.key; };
  for (std::size_t last = ladder.steps.size() - 1; last > 0; --last) {
    std::vector<Trial> without(last > 1 ? last : 0);  // each of the effects
    run_tasks(without.size(), context.threads,
              [&](std::size_t k) { without[k] = try_without(context, context.fine, top, key(ladder.steps[k + 1])); });
    std::size_t least = last;
    Trial below;
    for (std::size_t k = 0; k < without.size(); ++k) {
      if (!without[k].usable || (below.usable && without[k].held_out_squares >= below.held_out_squares)) continue;
      below = std::move(without[k]);
      least = k + 1;
    }
    std::swap(ladder.steps[least], ladder.steps[last]);
    ladder.steps[last].trial = std::move(top);
    ladder.steps[last].without = below;
    look_beside(context, ladder.steps[last]);
    if (!below.usable) return;  // nothing lower can be fitted: the steps below stay as they were
    top = std::move(below);
  }
}

/// Candidates judged beside the step below `step` that explained nearly as much as the one chosen there, are not on the
/// ladder.
std::vector<const CandidateResult*> rivals_of(const LadderStep& step, const Trial& full,
                                              const std::vector<Candidate>& candidates) {
  const std::vector<std::string> present = full.model.effect_keys();
  const auto added = std::find_if(step.judged.begin(), step.judged.end(),
                                  [&](const CandidateResult& j) { return j.candidate == *step.added; });
  std::vector<const CandidateResult*> rivals;
  for (const CandidateResult& judged : step.judged) {
    const std::string& key = candidates[judged.candidate].info.key;
    const bool is_present = std::find(present.begin(), present.end(), key) != present.end();
    const bool near = added == step.judged.end() || judged.fall > limits::kRivalPart * added->fall;
    if (judged.trial.usable && judged.plausible && !is_present && near) rivals.push_back(&judged);
  }
  return rivals;
}

/// A rival in the place of the effect of a step, at low resolution.
struct Instead {
  const CandidateResult* rival = nullptr;
  Trial trial;
};

/// The rivals that come near the effect of a step at low resolution. full: the top there.
std::vector<Instead> near_rivals(const DiagnosisContext& context, const Trial& full, const std::string& key,
                                 const std::vector<const CandidateResult*>& rivals,
                                 const std::vector<Candidate>& candidates) {
  std::vector<Instead> all(rivals.size());
  const Trial without = try_without(context, context.coarse, full, key);
  if (!full.usable || !without.usable) return {};
  run_tasks(all.size(), context.threads, [&](std::size_t r) {
    const Candidate& rival = candidates[rivals[r]->candidate];
    all[r] = {rivals[r], try_instead(context, context.coarse, without, rival, rivals[r]->trial)};
  });
  const double fallen = without.held_out_squares - full.held_out_squares;
  std::erase_if(all, [&](const Instead& one) {
    const double behind = one.trial.held_out_squares - full.held_out_squares;
    return !one.trial.usable || is_far_behind(context, behind, fallen);
  });
  return all;
}

/// The effect of a step and its rivals, each compared with the model `without` any of them.
std::vector<CandidateResult> judge_anew(const DiagnosisContext& context, const LadderStep& step, const Trial& full,
                                        const Trial& without, const std::vector<Instead>& rivals,
                                        const std::vector<Candidate>& candidates, const Limits& least) {
  std::vector<CandidateResult> judged(rivals.size() + 1);
  judged[0] = compare(context, context.fine, without, full, candidates[*step.added], 1, least);
  judged[0].candidate = *step.added;
  run_tasks(rivals.size(), context.threads, [&](std::size_t r) {
    const std::size_t candidate = rivals[r].rival->candidate;
    Trial instead = try_model(context, context.fine, rivals[r].trial.model, rivals[r].trial.p);
    judged[r + 1] = compare(context, context.fine, without, std::move(instead), candidates[candidate], 1, least);
    judged[r + 1].candidate = candidate;
  });
  return judged;
}

}  // namespace

void look_beside(const DiagnosisContext& context, LadderStep& step) {
  if (!step.trial.usable) return;
  step.coarse = try_model(context, context.coarse, step.trial.model, step.trial.p);
  step.probes = probe_all(context, step.coarse, step.trial, residual_of(context, step.trial));
}

double largest_fall(const LadderStep& step) {
  const std::vector<Probe> structure = remaining_structure(step.probes);
  return structure.empty() ? 0 : structure.front().fall;
}

namespace {

/// The top without the effect of step k + 1: taken from what is known, or fitted.
Trial without_step(const DiagnosisContext& context, const Ladder& ladder, const std::vector<Candidate>& candidates,
                   std::size_t k, int threads) {
  const LadderStep& step = ladder.steps[k + 1];
  if (k + 2 == ladder.steps.size() && step.without.usable) return step.without;
  return try_without(context, context.fine, ladder.top(), candidates[*step.added].info.key, threads);
}

}  // namespace

std::vector<Trial> prune(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                         const Limits& least) {
  while (true) {
    std::vector<Trial> without(ladder.steps.size() - 1);  // each of the effects
    std::vector<unsigned char> is_needed(without.size());
    run_tasks(without.size(), context.threads, [&](std::size_t k) {
      const Candidate& candidate = candidates[*ladder.steps[k + 1].added];
      without[k] = without_step(context, ladder, candidates, k, context.threads_each(without.size()));
      const bool needed =
          !without[k].usable || compare(context, context.fine, without[k], ladder.top(), candidate, 1, least).passes;
      is_needed[k] = needed ? 1 : 0;
    });
    const auto first = std::find(is_needed.begin(), is_needed.end(), 0) - is_needed.begin();
    if (first == std::ssize(is_needed)) return without;
    ladder.steps.erase(ladder.steps.begin() + 1 + first);
    put_in_order(context, ladder, candidates, std::move(without[static_cast<std::size_t>(first)]));
  }
}

bool reconsider(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                const Limits& least, std::vector<Trial> without) {
  if (ladder.steps.size() <= 2) return false;
  std::vector<std::vector<CandidateResult>> judged(ladder.steps.size() - 1);  // beside all effects but one
  without.resize(judged.size());
  run_tasks(judged.size(), context.threads, [&](std::size_t k) {
    const LadderStep& step = ladder.steps[k + 1];
    std::vector<const CandidateResult*> rivals = rivals_of(step, ladder.top(), candidates);
    const std::string& key = candidates[*step.added].info.key;
    const FrictionModel rest = without_effect(ladder.top(), key).model;
    std::erase_if(rivals, [&](const CandidateResult* r) { return !rest.acts_with(candidates[r->candidate].effect); });
    if (rivals.empty()) return;
    const std::vector<Instead> near = near_rivals(context, ladder.steps.back().coarse, key, rivals, candidates);
    if (!without[k].usable) without[k] = without_step(context, ladder, candidates, k, 1);
    if (without[k].usable) judged[k] = judge_anew(context, step, ladder.top(), without[k], near, candidates, least);
  });
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (judged[k].empty()) continue;
    const Choice choice = choose(context, judged[k], candidates);
    if (!choice.leader) continue;
    LadderStep& step = ladder.steps[k + 1];
    step.equivalent = choice.group;
    if (*choice.leader == 0) continue;
    CandidateResult& leader = judged[k][*choice.leader];
    step.added = leader.candidate;
    step.by_level = leader.by_level;
    put_in_order(context, ladder, candidates, std::move(leader.trial));
    return true;
  }
  return false;
}

void withdraw(Ladder& ladder, double swinging) {
  const double left = largest_fall(ladder.steps.back());
  if (left == 0 && swinging == 0) return;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {
    const double fall = ladder.steps[s - 1].trial.held_out_squares - ladder.steps[s].trial.held_out_squares;
    const double shown = largest_fall(ladder.steps[s - 1]);
    // What acts by the levels of break-away alone hardly shows in squares that are whitened against their scatter.
    const double fall_of_all = ladder.steps[s - 1].trial.plain_held_out - ladder.steps[s].trial.plain_held_out;
    const bool is_little = !ladder.steps[s].by_level && fall < limits::kWithdrawnPart * shown &&
                           left >= limits::kLeastStructure * shown && left > 0;
    if (!is_little && !(fall_of_all < swinging)) continue;
    for (std::size_t k = s; k < ladder.steps.size(); ++k) ladder.withdrawn.push_back(*ladder.steps[k].added);
    ladder.last = ladder.steps[s].judged;
    ladder.steps.resize(s);
    return;
  }
}

}  // namespace tribofit::diagnosis
