#include "ladder_steps.hpp"

#include <algorithm>
#include <utility>

#include "limits.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit::diagnosis {

Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key) {
  Trial rest = without_effect(full, key);
  return try_model(context, level, rest.model, std::move(rest.p));
}

namespace {

/// The model of `without` with the effect of a judged candidate, at the values found when it was judged.
Trial try_instead(const DiagnosisContext& context, const Trial& without, const Candidate& candidate,
                  const Trial& judged) {
  FrictionModel model = with_effect(without.model, candidate.effect);
  const std::size_t offset = model.offset_of(candidate.info.key), added = model.count_of(candidate.info.key);
  const std::size_t from = judged.model.offset_of(candidate.info.key);
  std::vector<double> start = without.p;
  start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset),
               judged.p.begin() + static_cast<std::ptrdiff_t>(from),
               judged.p.begin() + static_cast<std::ptrdiff_t>(from + added));
  return try_model(context, context.fine, model, std::move(start));
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

/// The effect of a step and its rivals, each compared with the model `without` any of them.
std::vector<CandidateResult> judge_anew(const DiagnosisContext& context, const LadderStep& step, const Trial& full,
                                        const Trial& without, const std::vector<const CandidateResult*>& rivals,
                                        const std::vector<Candidate>& candidates, const Limits& least) {
  std::vector<CandidateResult> judged(rivals.size() + 1);
  judged[0] = compare(context, context.fine, without, full, candidates[*step.added], 1, least);
  judged[0].candidate = *step.added;
  run_tasks(rivals.size(), context.threads, [&](std::size_t r) {
    const Candidate& rival = candidates[rivals[r]->candidate];
    Trial instead = try_instead(context, without, rival, rivals[r]->trial);
    judged[r + 1] = compare(context, context.fine, without, std::move(instead), rival, 1, least);
    judged[r + 1].candidate = rivals[r]->candidate;
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

void prune(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
           const Limits& least) {
  struct Without {
    Trial trial;
    bool is_needed = false;
  };
  while (true) {
    const Trial& full = ladder.top();
    std::vector<Without> all(ladder.steps.size() - 1);  // without each of the effects
    run_tasks(all.size(), context.threads, [&](std::size_t k) {
      const Candidate& candidate = candidates[*ladder.steps[k + 1].added];
      all[k].trial = try_without(context, context.fine, full, candidate.info.key);
      all[k].is_needed =
          !all[k].trial.usable || compare(context, context.fine, all[k].trial, full, candidate, 1, least).passes;
    });
    const auto first = std::find_if(all.begin(), all.end(), [](const Without& without) { return !without.is_needed; });
    if (first == all.end()) return;
    ladder.steps.erase(ladder.steps.begin() + 1 + (first - all.begin()));
    put_in_order(context, ladder, candidates, std::move(first->trial));
  }
}

bool reconsider(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                const Limits& least) {
  if (ladder.steps.size() <= 2) return false;
  std::vector<std::vector<CandidateResult>> judged(ladder.steps.size() - 1);  // beside all effects but one
  run_tasks(judged.size(), context.threads, [&](std::size_t k) {
    const LadderStep& step = ladder.steps[k + 1];
    const Trial& full = ladder.top();
    std::vector<const CandidateResult*> rivals = rivals_of(step, full, candidates);
    if (rivals.empty()) return;
    const Trial without = try_without(context, context.fine, full, candidates[*step.added].info.key);
    if (!without.usable) return;
    std::erase_if(rivals,
                  [&](const CandidateResult* r) { return !without.model.acts_with(candidates[r->candidate].effect); });
    if (!rivals.empty()) judged[k] = judge_anew(context, step, full, without, rivals, candidates, least);
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
                           left >= limits::kWithdrawnLittle * shown && left > 0;
    if (!is_little && !(fall_of_all < swinging)) continue;
    for (std::size_t k = s; k < ladder.steps.size(); ++k) ladder.withdrawn.push_back(*ladder.steps[k].added);
    ladder.last = ladder.steps[s].judged;
    ladder.steps.resize(s);
    return;
  }
}

}  // namespace tribofit::diagnosis
