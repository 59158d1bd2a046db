#include "ladder.hpp"

#include <algorithm>
#include <utility>

#include "tribofit/statistics/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

std::vector<CandidateResult> judge_beside(const DiagnosisContext& bench, const LadderStep& step,
                                          const std::vector<Candidate>& candidates, const Limits& limits) {
  return judge_all(bench, step.trial, step.coarse, candidates, limits);
}

/// Fills in what is asked of every step.
void look_beside(const DiagnosisContext& bench, LadderStep& step) {
  if (!step.trial.usable) return;
  step.coarse = try_model(bench, bench.coarse, step.trial.model, step.trial.p);
  step.probes = probe_all(bench, step.coarse, step.trial, residual_of(bench, step.trial));
}

std::size_t index_of(const FrictionModel& model, const std::string& key) {
  const std::vector<std::string> keys = model.effect_keys();
  return static_cast<std::size_t>(std::find(keys.begin(), keys.end(), key) - keys.begin());
}

/// Puts the steps of a ladder in order anew, from the top down: what was found beside an effect that is gone need not
/// have come first. top: the trial with the effects of all its steps.
void put_in_order(const DiagnosisContext& bench, Ladder& ladder, const std::vector<Candidate>& candidates, Trial top) {
  const auto key = [&](const LadderStep& step) { return candidates[*step.added].info.key; };
  for (std::size_t last = ladder.steps.size() - 1; last > 0; --last) {
    std::size_t least = last;
    Trial below;
    for (std::size_t k = 1; k <= last && last > 1; ++k) {
      Trial without = try_without(bench, bench.fine, top, index_of(top.model, key(ladder.steps[k])));
      if (!without.usable || (below.usable && without.held_out_squares >= below.held_out_squares)) continue;
      below = std::move(without);
      least = k;
    }
    std::swap(ladder.steps[least], ladder.steps[last]);
    ladder.steps[last].trial = std::move(top);
    look_beside(bench, ladder.steps[last]);
    if (!below.usable) return;  // nothing lower can be fitted: the steps below stay as they were
    top = std::move(below);
  }
}

double largest_fall(const LadderStep& step) {
  const std::vector<Probe> structure = remaining_structure(step.probes);
  return structure.empty() ? 0 : structure.front().fall;
}

/// Where structure is left that no effect explains, a name that was given to a smaller part of the error while a free
/// function of one variable explained far more is probably wrong: it is withdrawn, with those that stand on it. Not
/// where the effects above it have explained nearly all of that after all.
void withdraw(Ladder& ladder) {
  constexpr double kLeastPart = 0.7, kLittle = 0.05;
  const double left = largest_fall(ladder.steps.back());
  if (left == 0) return;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {
    const double fall = ladder.steps[s - 1].trial.held_out_squares - ladder.steps[s].trial.held_out_squares;
    const double shown = largest_fall(ladder.steps[s - 1]);
    // What acts by the levels of break-away alone hardly shows in squares that are whitened against their scatter.
    if (ladder.steps[s].by_level || fall >= kLeastPart * shown || left < kLittle * shown) continue;
    for (std::size_t k = s; k < ladder.steps.size(); ++k) ladder.withdrawn.push_back(*ladder.steps[k].added);
    ladder.last = ladder.steps[s].judged;
    ladder.steps.resize(s);
    return;
  }
}

/// Drops effects that the ones added after them made redundant.
void prune(const DiagnosisContext& bench, Ladder& ladder, const std::vector<Candidate>& candidates,
           const Limits& limits) {
  for (std::size_t s = 1; s + 1 < ladder.steps.size();) {
    const Candidate& candidate = candidates[*ladder.steps[s].added];
    const Trial& full = ladder.top();
    Trial without = try_without(bench, bench.fine, full, index_of(full.model, candidate.info.key));
    const CandidateResult needed = compare(bench, bench.fine, without, full, candidate, 1, limits);
    if (!without.usable || needed.passes) {
      ++s;
      continue;
    }
    ladder.steps.erase(ladder.steps.begin() + static_cast<std::ptrdiff_t>(s));
    put_in_order(bench, ladder, candidates, std::move(without));
    s = 1;
  }
}

/// The model of `without` with the effect of a judged candidate, at the values found when it was judged.
Trial try_instead(const DiagnosisContext& bench, const Trial& without, const Candidate& candidate,
                  const Trial& judged) {
  FrictionModel model = with_effect(without.model, candidate.effect);
  const std::size_t offset = model.offset_of(candidate.info.key), added = candidate.info.parameters.size();
  const std::size_t from = judged.model.offset_of(candidate.info.key);
  std::vector<double> start = without.p;
  start.insert(start.begin() + static_cast<std::ptrdiff_t>(offset),
               judged.p.begin() + static_cast<std::ptrdiff_t>(from),
               judged.p.begin() + static_cast<std::ptrdiff_t>(from + added));
  return try_model(bench, bench.fine, model, std::move(start));
}

/// Each effect was chosen beside what was known then. Once the others are there too, it is compared once more with
/// those that explained nearly as much: the better one takes its place, and its group is drawn anew. True where one was
/// replaced.
bool reconsider(const DiagnosisContext& bench, Ladder& ladder, const std::vector<Candidate>& candidates,
                const Limits& limits) {
  constexpr double kNearly = 0.5;
  for (std::size_t s = 1; s < ladder.steps.size() && ladder.steps.size() > 2; ++s) {
    LadderStep& step = ladder.steps[s];
    const Trial& full = ladder.top();
    const std::vector<std::string> present = full.model.effect_keys();
    const auto chosen = std::find_if(step.judged.begin(), step.judged.end(),
                                     [&](const CandidateResult& j) { return j.candidate == *step.added; });
    std::vector<const CandidateResult*> rivals;
    for (const CandidateResult& judged : step.judged) {
      const std::string& key = candidates[judged.candidate].info.key;
      const bool is_present = std::find(present.begin(), present.end(), key) != present.end();
      const bool near = chosen == step.judged.end() || judged.fall > kNearly * chosen->fall;
      if (judged.trial.usable && judged.plausible && !is_present && near) rivals.push_back(&judged);
    }
    if (rivals.empty()) continue;
    const Candidate& now = candidates[*step.added];
    const Trial without = try_without(bench, bench.fine, full, index_of(full.model, now.info.key));
    if (!without.usable) continue;
    std::erase_if(rivals,
                  [&](const CandidateResult* r) { return !without.model.acts_with(candidates[r->candidate].effect); });
    if (rivals.empty()) continue;
    std::vector<CandidateResult> judged(rivals.size() + 1);
    judged[0] = compare(bench, bench.fine, without, full, now, 1, limits);
    judged[0].candidate = *step.added;
    run_tasks(rivals.size(), bench.threads, [&](std::size_t r) {
      const Candidate& rival = candidates[rivals[r]->candidate];
      judged[r + 1] =
          compare(bench, bench.fine, without, try_instead(bench, without, rival, rivals[r]->trial), rival, 1, limits);
      judged[r + 1].candidate = rivals[r]->candidate;
    });
    const Choice choice = choose(bench, judged, candidates);
    if (!choice.leader) continue;
    step.equivalent = choice.group;
    if (*choice.leader == 0) continue;
    step.added = judged[*choice.leader].candidate;
    step.by_level = judged[*choice.leader].by_level;
    put_in_order(bench, ladder, candidates, std::move(judged[*choice.leader].trial));
    return true;
  }
  return false;
}

/// Adds the effect that leads, if one passes.
void extend(const DiagnosisContext& bench, Ladder& ladder, const std::vector<Candidate>& candidates,
            const Limits& limits, int most_effects) {
  ladder.finished = true;
  ladder.last = judge_beside(bench, ladder.steps.back(), candidates, limits);
  if (static_cast<int>(ladder.steps.size()) > most_effects) return;
  const Choice choice = choose(bench, ladder.last, candidates);
  if (!choice.leader) return;
  // Two effects of the same variable may each explain half of what a free function finds there, but not much less.
  constexpr double kHopeless = 0.35;
  const CandidateResult& leader = ladder.last[*choice.leader];
  if (!leader.by_level && leader.fall < kHopeless * largest_fall(ladder.steps.back())) {
    ladder.withdrawn.push_back(leader.candidate);
    return;
  }
  LadderStep step;
  step.added = leader.candidate;
  step.by_level = leader.by_level;
  step.trial = leader.trial;
  step.equivalent = choice.group;
  step.judged = std::move(ladder.last);
  look_beside(bench, step);
  ladder.steps.push_back(std::move(step));
  ladder.finished = false;
}

/// What is done once, when nothing more passes.
void finish(const DiagnosisContext& bench, Ladder& ladder, const std::vector<Candidate>& candidates,
            const Limits& limits) {
  const std::size_t before = ladder.steps.size();
  prune(bench, ladder, candidates, limits);
  bool replaced = false;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {  // as often as there are effects, at the most
    if (!reconsider(bench, ladder, candidates, limits)) break;
    replaced = true;
  }
  if (replaced) prune(bench, ladder, candidates, limits);
  if (replaced || ladder.steps.size() < before)
    ladder.last = judge_beside(bench, ladder.steps.back(), candidates, limits);
  withdraw(ladder);
  // What was added after all is told apart: both are there.
  for (LadderStep& step : ladder.steps) {
    std::erase_if(step.equivalent, [&](std::size_t k) {
      return std::any_of(ladder.steps.begin(), ladder.steps.end(), [&](const LadderStep& s) {
        return s.added && candidates[*s.added].info.key == candidates[k].info.key;
      });
    });
  }
}

Ladder start_ladder(const DiagnosisContext& bench, BaseLaw law, const std::vector<Candidate>& from_the_start) {
  Ladder ladder;
  ladder.law = law;
  LadderStep base;
  base.trial = try_base(bench, bench.fine, FrictionModel(law));
  for (const Candidate& effect : from_the_start) base.trial = try_with(bench, bench.fine, base.trial, effect);
  look_beside(bench, base);
  ladder.finished = !base.trial.usable;
  ladder.steps.push_back(std::move(base));
  return ladder;
}

/// The second predicts held-out cycles better, or as well with fewer parameters.
bool is_better(const DiagnosisContext& bench, const Trial& first, const Trial& second) {
  if (!second.usable || !first.usable) return second.usable;
  const double difference = first.held_out_squares - second.held_out_squares;
  const double noise = std::min(noise_of(bench.fine, first), noise_of(bench.fine, second));
  // A longer ladder must earn every rung that the other does without.
  const std::size_t more = std::max(first.p.size(), second.p.size()) - std::min(first.p.size(), second.p.size());
  const double least = std::max(kToldApartSize, 0.02 * static_cast<double>(more)) * bench.noise_squares();
  const bool apart = std::abs(difference) > std::max(kToldApart * noise, least);
  return apart || more == 0 ? difference > 0 : second.p.size() < first.p.size();
}

/// A finished ladder leaves nothing, is no longer and does as well.
bool is_beaten(const DiagnosisContext& bench, const Ladder& ladder, const std::vector<Ladder>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Ladder& other) {
    return other.finished && other.top().usable && largest_fall(other.steps.back()) == 0 &&
           ladder.steps.size() >= other.steps.size() && !is_better(bench, other.top(), ladder.top());
  });
}

}  // namespace

std::vector<Ladder> climb(const DiagnosisContext& bench, const std::vector<BaseLaw>& laws,
                          const std::vector<Candidate>& from_the_start, const std::vector<Candidate>& candidates,
                          const Limits& limits, int most_effects,
                          const std::function<void(std::string_view, double)>& progress) {
  std::vector<Ladder> ladders(laws.size());
  run_tasks(laws.size(), bench.threads,
            [&](std::size_t k) { ladders[k] = start_ladder(bench, laws[k], from_the_start); });
  // Beside Coulomb friction the better ladder need not be the one to tell (see told_ladder): all are climbed.
  const bool all_matter = std::find(laws.begin(), laws.end(), BaseLaw::coulomb) != laws.end();
  for (double rounds = 0;; ++rounds) {
    Ladder* next = nullptr;
    for (Ladder& ladder : ladders) {
      if (ladder.finished || (!all_matter && is_beaten(bench, ladder, ladders))) continue;
      if (next == nullptr || ladder.top().held_out_squares < next->top().held_out_squares) next = &ladder;
    }
    if (next == nullptr) break;
    if (progress) progress(next->top().model.name(), rounds / (rounds + 3));
    extend(bench, *next, candidates, limits, most_effects);
    if (next->finished) finish(bench, *next, candidates, limits);
  }
  return ladders;
}

std::size_t better_ladder(const DiagnosisContext& bench, const std::vector<Ladder>& ladders) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < ladders.size(); ++k) {
    if (is_better(bench, ladders[best].top(), ladders[k].top())) best = k;
  }
  return best;
}

}  // namespace tribofit::diagnosis
