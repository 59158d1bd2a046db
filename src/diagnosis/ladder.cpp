#include "ladder.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/execution/stop.hpp"

namespace tribofit::diagnosis {

namespace {

std::vector<CandidateResult> judge_beside(const DiagnosisContext& context, const LadderStep& step,
                                          const std::vector<Candidate>& candidates, const Limits& least) {
  return judge_all(context, step.trial, step.coarse, candidates, least);
}

/// A rung for what was judged beside the last one.
void add_step(const DiagnosisContext& context, Ladder& ladder, const CandidateResult& leader,
              std::vector<std::size_t> group, Trial without = {}) {
  LadderStep step;
  step.added = leader.candidate;
  step.by_level = leader.by_level;
  step.trial = leader.trial;
  step.without = std::move(without);
  step.equivalent = std::move(group);
  step.judged = std::move(ladder.last);
  look_beside(context, step);
  ladder.steps.push_back(std::move(step));
  ladder.finished = false;
}

/// The least fall that is enough of what a free function explains. Those are fitted at low resolution, where other
/// scatter may have been taken out: what they explain counts as that part of what the trial leaves.
double worth_a_rung(const LadderStep& step) {
  const double here = step.trial.held_out_squares, there = step.coarse.held_out_squares;
  return limits::kHopelessPart * largest_fall(step) * (here > 0 && there > 0 ? std::min(1.0, here / there) : 1);
}

/// Adds two effects that hide each other, if there are two such that explain more than the one that leads (if any).
bool extend_by_pair(const DiagnosisContext& context, Ladder& ladder, const CandidateResult* leader,
                    const std::vector<Candidate>& candidates, const Limits& least, int most_effects) {
  if (static_cast<int>(ladder.steps.size()) >= most_effects) return false;
  const Trial& top = ladder.top();
  LeastOfPair least_of_pair;
  least_of_pair.fall = worth_a_rung(ladder.steps.back());
  if (leader != nullptr) {
    least_of_pair.size = limits::kRivalPart * leader->size;
    least_of_pair.fall =
        std::max(least_of_pair.fall, leader->fall + limits::kDistinguishableSize * context.noise_squares());
    least_of_pair.beside = leader->candidate;
  }
  const std::optional<HiddenPair> pair =
      find_hidden_pair(context, top, ladder.steps.back().coarse, ladder.last, least_of_pair, candidates, least);
  if (!pair) return false;
  const double fall = top.held_out_squares - pair->first.trial.held_out_squares;
  if (fall < worth_a_rung(ladder.steps.back())) return false;
  if (leader != nullptr && !are_distinguishable(context, pair->first, *leader)) return false;
  // What was judged beside the other one is what decided: it stands for the candidate from here on.
  for (CandidateResult& judged : ladder.last) {
    if (judged.candidate == pair->first.candidate) judged.p_value = pair->first.p_value;
  }
  add_step(context, ladder, pair->alone, {});
  // Beside the first one the second shows, with what these data do not distinguish from it.
  ladder.last = judge_beside(context, ladder.steps.back(), candidates, least);
  const Choice choice = choose(context, ladder.last, candidates);
  CandidateResult second = pair->second;
  std::vector<std::size_t> group;
  if (choice.leader) {
    const CandidateResult& shown = ladder.last[*choice.leader];
    if (shown.candidate == second.candidate) group = choice.group;
    const bool is_rival = std::find(choice.group.begin(), choice.group.end(), second.candidate) != choice.group.end();
    if (is_rival || shown.trial.held_out_squares <= second.trial.held_out_squares) {
      second = shown;
      group = choice.group;
    }
  }
  ladder.last.push_back(second);
  add_step(context, ladder, second, std::move(group));
  return true;
}

/// What a rung explains may be that its search ended in a lower minimum: the model `without` it, fitted anew from
/// there, then takes the place of the one it was compared with.
bool improve_top(const DiagnosisContext& context, Ladder& ladder, const Trial& leader, Trial& without) {
  LadderStep& last = ladder.steps.back();
  const double least = limits::kLowerMinimum * (last.trial.held_out_squares - leader.held_out_squares);
  const bool lower = without.usable && without.held_out_squares < last.trial.held_out_squares - std::max(0.0, least) &&
                     without.squares < last.trial.squares;
  if (!lower) return false;
  last.trial = std::move(without);
  look_beside(context, last);
  ladder.finished = false;
  return true;
}

/// Adds the effect that leads, if one passes.
void extend(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
            const Limits& least, int most_effects) {
  ladder.finished = true;
  ladder.last = judge_beside(context, ladder.steps.back(), candidates, least);
  if (static_cast<int>(ladder.steps.size()) > most_effects) return;
  const Choice choice = choose(context, ladder.last, candidates);
  std::optional<CandidateResult> leader;
  if (choice.leader) leader = ladder.last[*choice.leader];
  if (leader && !leader->by_level && leader->fall < worth_a_rung(ladder.steps.back())) {
    ladder.withdrawn.push_back(leader->candidate);
    leader.reset();
  }
  Trial without;
  if (leader) {
    without = try_without(context, context.fine, leader->trial, candidates[leader->candidate].info.key,
                          context.threads_each(1));
    if (improve_top(context, ladder, leader->trial, without)) return;
  }
  if (extend_by_pair(context, ladder, leader ? &*leader : nullptr, candidates, least, most_effects)) return;
  if (leader) add_step(context, ladder, *leader, choice.group, std::move(without));
}

/// What is done once, when nothing more passes.
void finish(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
            const Limits& least) {
  const std::size_t before = ladder.steps.size();
  std::vector<Trial> without = prune(context, ladder, candidates, least);
  bool replaced = false;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {  // as often as there are effects, at the most
    if (!reconsider(context, ladder, candidates, least, std::move(without))) break;
    without = {};
    replaced = true;
  }
  if (replaced) prune(context, ladder, candidates, least);
  if (replaced || ladder.steps.size() < before)
    ladder.last = judge_beside(context, ladder.steps.back(), candidates, least);
  const double excess = ladder.top().plain_held_out - context.noise_squares();
  withdraw(ladder, context.swing > 0 && excess > context.noise_squares() ? excess : 0);
  // What was added after all is distinguishable: both are there.
  for (LadderStep& step : ladder.steps) {
    std::erase_if(step.equivalent, [&](std::size_t k) {
      return std::any_of(ladder.steps.begin(), ladder.steps.end(), [&](const LadderStep& s) {
        return s.added && candidates[*s.added].info.key == candidates[k].info.key;
      });
    });
  }
}

Ladder start_ladder(const DiagnosisContext& context, Law law, const std::vector<Candidate>& from_the_start,
                    int threads) {
  Ladder ladder;
  ladder.law = law;
  LadderStep base;
  base.trial = try_base(context, context.fine, FrictionModel(law, {}, context.records.size()), threads);
  for (const Candidate& effect : from_the_start) base.trial = try_with(context, context.fine, base.trial, effect);
  look_beside(context, base);
  ladder.finished = !base.trial.usable;
  ladder.steps.push_back(std::move(base));
  return ladder;
}

/// By how much slow noise makes two shapes of friction differ more than independent noise would: the largest design
/// effect of what no change of level can do.
double slow_design(const Level& level, const Trial& trial) {
  const SlowNoise slow = slow_noise_of(trial.evidence);
  if (slow.covariance.empty()) return 1;
  double largest = 1;
  for (std::size_t k = 0; k < trial.p.size(); ++k) {
    if (trial.evidence.level(static_cast<Eigen::Index>(k)) != 0) continue;
    largest = std::max(largest, design_effect(trial.evidence, trial.free, k, 1, noise_of(level, trial), slow).of_slow);
  }
  return largest;
}

/// The second predicts held-out cycles better, or as well with fewer effects, or with as many and fewer parameters.
/// With more effects it must do so by both held-out errors, as for a name.
bool is_better(const DiagnosisContext& context, const Level& level, const Trial& first, const Trial& second) {
  if (!second.usable || !first.usable) return second.usable;
  const double difference = first.held_out_squares - second.held_out_squares;
  const std::size_t effects = first.model.effects().size(), other_effects = second.model.effects().size();
  const double slow = slow_design(level, first.p.size() > second.p.size() ? first : second);
  // An effect that another law does without has to be clearer than a law.
  const double sure = effects == other_effects
                          ? std::max(limits::kDistinguishable, limits::kDistinguishableInSlowNoise * slow)
                          : limits::kDistinguishable * slow;
  // A longer ladder must earn every rung that the other does without.
  const std::size_t more = std::max(first.p.size(), second.p.size()) - std::min(first.p.size(), second.p.size());
  const double least = std::max(limits::kDistinguishableSize, limits::kSizeOfParameter * static_cast<double>(more)) *
                       context.noise_squares();
  const double noise = std::min(noise_of(level, first), noise_of(level, second));
  const Trial &longer = effects > other_effects ? first : second, &shorter = effects > other_effects ? second : first;
  const bool by_both = effects == other_effects || longer.plain_held_out < shorter.plain_held_out;
  if (by_both && std::abs(difference) > std::max(sure * noise, least)) return difference > 0;
  if (effects != other_effects) return other_effects < effects;
  return more == 0 ? difference > 0 : second.p.size() < first.p.size();
}

/// A finished ladder leaves nothing, is no longer and does as well.
bool is_beaten(const DiagnosisContext& context, const Ladder& ladder, const std::vector<Ladder>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Ladder& other) {
    return other.finished && other.top().usable && largest_fall(other.steps.back()) == 0 &&
           ladder.steps.size() >= other.steps.size() && !is_better(context, context.fine, other.top(), ladder.top());
  });
}

/// The ladder that predicts best of those that are still worth a rung and not ahead of another by more than one; none
/// left: nullptr.
Ladder* next_to_climb(const DiagnosisContext& context, std::vector<Ladder>& ladders, bool all_matter) {
  std::vector<Ladder*> worthy;
  for (Ladder& ladder : ladders) {
    if (!ladder.finished && (all_matter || !is_beaten(context, ladder, ladders))) worthy.push_back(&ladder);
  }
  if (worthy.empty()) return nullptr;
  const auto height = [](const Ladder* ladder) { return ladder->steps.size(); };
  const std::size_t lowest = std::ranges::min(worthy, {}, height)->steps.size();
  std::erase_if(worthy, [&](const Ladder* ladder) { return height(ladder) > lowest + 1; });
  return std::ranges::min(worthy, {}, [](const Ladder* ladder) { return ladder->top().held_out_squares; });
}

/// A law does without one of the effects of a ladder what that ladder's law does with it, or better as it stands.
bool does_as_well(const DiagnosisContext& context, const Law& law, const Ladder& ladder) {
  const Trial& top = ladder.steps.back().coarse;
  if (!top.usable) return false;
  if (ladder.steps.size() == 1) return is_better(context, context.coarse, top, try_other_law(context, law, top));
  // Slow noise is no excuse here: it would let a law pass that leaves much of what the effect explains.
  const double least = std::max(limits::kDistinguishable * noise_of(context.coarse, top),
                                limits::kSizeOfParameter * context.noise_squares());
  for (std::size_t e = 0; e < top.model.effects().size(); ++e) {
    const Trial other = try_other_law(context, law, top, e);
    if (other.usable && other.held_out_squares - top.held_out_squares < least) return true;
  }
  return false;
}

/// Whether a round of climbing comes to its end; where it does not, the ladder is as it was before.
template <class Round>
bool ends_in_time(const std::optional<std::chrono::steady_clock::time_point>& until, Ladder& ladder, Round&& round) {
  if (!until) {
    round();
    return true;
  }
  Ladder before = ladder;
  try {
    const StopScope scope([&until] { return std::chrono::steady_clock::now() >= *until; });
    round();
    return true;
  } catch (const Stopped&) {
    stop_point();  // it may have been stopped from outside
    ladder = std::move(before);
    return false;
  }
}

}  // namespace

Climb climb(const DiagnosisContext& context, const CompetingLaws& laws, const std::vector<Candidate>& from_the_start,
            const std::vector<Candidate>& candidates, const Limits& least, const ClimbLimits& limits,
            const std::function<void(std::string_view, double)>& progress) {
  Climb out;
  std::vector<Ladder>& ladders = out.ladders;
  double rounds = 0;
  const auto start_all = [&](const std::vector<Law>& from) {
    std::vector<Ladder> started(from.size());
    run_tasks(from.size(), context.threads, [&](std::size_t k) {
      started[k] = start_ladder(context, from[k], from_the_start, context.threads_each(from.size()));
    });
    std::move(started.begin(), started.end(), std::back_inserter(ladders));
  };
  const auto climb_all = [&] {
    // Beside Coulomb friction the better ladder need not be the one to report (see reported_ladder): all are climbed.
    const bool all_matter =
        std::any_of(ladders.begin(), ladders.end(), [](const Ladder& ladder) { return constant_in_slip(ladder.law); });
    Ladder* next = nullptr;
    while (!out.out_of_time && (next = next_to_climb(context, ladders, all_matter)) != nullptr) {
      if (progress) progress(next->top().model.name(), rounds / (rounds + 3));
      ++rounds;
      out.out_of_time = !ends_in_time(limits.until, *next, [&] {
        extend(context, *next, candidates, least, limits.most_effects);
        if (next->finished) finish(context, *next, candidates, least);
      });
    }
  };
  start_all(laws.first);
  climb_all();
  if (out.out_of_time) return out;
  const Ladder& best = ladders[better_ladder(context, ladders)];
  std::vector<Law> instead;
  for (const Law& law : laws.others) {
    if (does_as_well(context, law, best)) instead.push_back(law);
  }
  start_all(instead);
  climb_all();
  return out;
}

std::size_t better_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < ladders.size(); ++k) {
    if (is_better(context, context.fine, ladders[best].top(), ladders[k].top())) best = k;
  }
  return best;
}

}  // namespace tribofit::diagnosis
