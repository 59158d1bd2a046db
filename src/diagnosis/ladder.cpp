#include "ladder.hpp"

#include <algorithm>
#include <utility>

#include "ladder_steps.hpp"
#include "limits.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

std::vector<CandidateResult> judge_beside(const DiagnosisContext& context, const LadderStep& step,
                                          const std::vector<Candidate>& candidates, const Limits& least) {
  return judge_all(context, step.trial, step.coarse, candidates, least);
}

/// Adds the effect that leads, if one passes.
void extend(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
            const Limits& least, int most_effects) {
  ladder.finished = true;
  ladder.last = judge_beside(context, ladder.steps.back(), candidates, least);
  if (static_cast<int>(ladder.steps.size()) > most_effects) return;
  const Choice choice = choose(context, ladder.last, candidates);
  if (!choice.leader) return;
  const CandidateResult& leader = ladder.last[*choice.leader];
  if (!leader.by_level && leader.fall < limits::kHopelessPart * largest_fall(ladder.steps.back())) {
    ladder.withdrawn.push_back(leader.candidate);
    return;
  }
  LadderStep step;
  step.added = leader.candidate;
  step.by_level = leader.by_level;
  step.trial = leader.trial;
  step.equivalent = choice.group;
  step.judged = std::move(ladder.last);
  look_beside(context, step);
  ladder.steps.push_back(std::move(step));
  ladder.finished = false;
}

/// What is done once, when nothing more passes.
void finish(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
            const Limits& least) {
  const std::size_t before = ladder.steps.size();
  prune(context, ladder, candidates, least);
  bool replaced = false;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {  // as often as there are effects, at the most
    if (!reconsider(context, ladder, candidates, least)) break;
    replaced = true;
  }
  if (replaced) prune(context, ladder, candidates, least);
  if (replaced || ladder.steps.size() < before)
    ladder.last = judge_beside(context, ladder.steps.back(), candidates, least);
  withdraw(ladder);
  // What was added after all is distinguishable: both are there.
  for (LadderStep& step : ladder.steps) {
    std::erase_if(step.equivalent, [&](std::size_t k) {
      return std::any_of(ladder.steps.begin(), ladder.steps.end(), [&](const LadderStep& s) {
        return s.added && candidates[*s.added].info.key == candidates[k].info.key;
      });
    });
  }
}

Ladder start_ladder(const DiagnosisContext& context, Law law, const std::vector<Candidate>& from_the_start) {
  Ladder ladder;
  ladder.law = law;
  LadderStep base;
  base.trial = try_base(context, context.fine, FrictionModel(law));
  for (const Candidate& effect : from_the_start) base.trial = try_with(context, context.fine, base.trial, effect);
  look_beside(context, base);
  ladder.finished = !base.trial.usable;
  ladder.steps.push_back(std::move(base));
  return ladder;
}

/// The second predicts held-out cycles better, or as well with fewer parameters.
bool is_better(const DiagnosisContext& context, const Trial& first, const Trial& second) {
  if (!second.usable || !first.usable) return second.usable;
  const double difference = first.held_out_squares - second.held_out_squares;
  const double noise = std::min(noise_of(context.fine, first), noise_of(context.fine, second));
  // A longer ladder must earn every rung that the other does without.
  const std::size_t more = std::max(first.p.size(), second.p.size()) - std::min(first.p.size(), second.p.size());
  const double least = std::max(limits::kDistinguishableSize, limits::kSizeOfParameter * static_cast<double>(more)) *
                       context.noise_squares();
  const bool apart = std::abs(difference) > std::max(limits::kDistinguishable * noise, least);
  return apart || more == 0 ? difference > 0 : second.p.size() < first.p.size();
}

/// A finished ladder leaves nothing, is no longer and does as well.
bool is_beaten(const DiagnosisContext& context, const Ladder& ladder, const std::vector<Ladder>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Ladder& other) {
    return other.finished && other.top().usable && largest_fall(other.steps.back()) == 0 &&
           ladder.steps.size() >= other.steps.size() && !is_better(context, other.top(), ladder.top());
  });
}

}  // namespace

std::vector<Ladder> climb(const DiagnosisContext& context, const std::vector<Law>& laws,
                          const std::vector<Candidate>& from_the_start, const std::vector<Candidate>& candidates,
                          const Limits& least, int most_effects,
                          const std::function<void(std::string_view, double)>& progress) {
  std::vector<Ladder> ladders(laws.size());
  run_tasks(laws.size(), context.threads,
            [&](std::size_t k) { ladders[k] = start_ladder(context, laws[k], from_the_start); });
  // Beside Coulomb friction the better ladder need not be the one to report (see reported_ladder): all are climbed.
  const bool all_matter = std::any_of(laws.begin(), laws.end(), constant_in_slip);
  for (double rounds = 0;; ++rounds) {
    Ladder* next = nullptr;
    for (Ladder& ladder : ladders) {
      if (ladder.finished || (!all_matter && is_beaten(context, ladder, ladders))) continue;
      if (next == nullptr || ladder.top().held_out_squares < next->top().held_out_squares) next = &ladder;
    }
    if (next == nullptr) break;
    if (progress) progress(next->top().model.name(), rounds / (rounds + 3));
    extend(context, *next, candidates, least, most_effects);
    if (next->finished) finish(context, *next, candidates, least);
  }
  return ladders;
}

std::size_t better_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < ladders.size(); ++k) {
    if (is_better(context, ladders[best].top(), ladders[k].top())) best = k;
  }
  return best;
}

}  // namespace tribofit::diagnosis
