#include "stepwise.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "hidden_pairs.hpp"
#include "limits.hpp"
#include "nearby_models.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/execution/stop.hpp"

namespace tribofit::diagnosis {

namespace {

/// A model at both resolutions.
struct Fitted {
  Trial fine, coarse;
};

/// What is known when a step begins.
struct Progress {
  std::vector<Fitted> laws;            ///< every law with the effects that were found
  std::size_t best = 0;                ///< of them
  std::vector<LadderStep> terms = {};  ///< without their trials
  std::vector<CandidateResult> last = {};
  std::vector<std::size_t> withdrawn = {};
  bool finished = false;
};

/// A candidate that is named beside a law.
struct Named {
  std::size_t law = 0;
  CandidateResult result;
  std::vector<std::size_t> equivalent;
  std::vector<CandidateResult> judged;
};

/// What the largest structure that free functions found would take away of the held-out squares; 0 where none is left.
double largest_fall(const std::vector<Probe>& probes) {
  const std::vector<Probe> structure = remaining_structure(probes);
  return structure.empty() ? 0 : structure.front().fall;
}

/// The search of climb(), step by step.
class Stepwise {
 public:
  Stepwise(const DiagnosisContext& context, const std::vector<Candidate>& candidates, const Limits& least)
      : context_(context), candidates_(candidates), least_(least) {}

  void start(const std::vector<Law>& laws, const std::vector<Candidate>& from_the_start);
  /// Adds the effect that leads, if one is named.
  void extend(int most_effects);
  /// What is done once, when nothing more is named.
  void finish();
  Ladder ladder() &&;

  Progress now;
  const Fitted& best() const { return now.laws[now.best]; }

 private:
  const std::string& key(std::size_t candidate) const { return candidates_[candidate].info.key; }
  std::vector<CandidateResult> judge_beside(std::size_t law, const Trial* to_beat = nullptr) const {
    return judge_all(context_, now.laws[law].fine, now.laws[law].coarse, candidates_, least_, to_beat);
  }
  Fitted coarse_too(Trial fine) const;
  std::size_t best_law() const;
  void fit_laws(Fitted known);
  Named leader_beside(std::size_t law, const Trial* to_beat = nullptr) const;
  std::optional<Named> leader_of_all(bool is_noise);
  bool improve(const Named& leader);
  bool extend_by_pair(const Named* leader, double worth, int most_effects);
  void add_term(const CandidateResult& result, std::vector<std::size_t> equivalent,
                std::vector<CandidateResult> judged);
  bool drop_one();
  bool exchange_one();
  std::vector<LadderStep> in_order() const;

  const DiagnosisContext& context_;
  const std::vector<Candidate>& candidates_;
  const Limits& least_;
};

Fitted Stepwise::coarse_too(Trial fine) const {
  Trial coarse = fine.usable ? try_model(context_, context_.coarse, fine.model, fine.p) : Trial();
  return {std::move(fine), std::move(coarse)};
}

/// The law that predicts best, or a simpler one that does as well. A doubtful one only where no sound one explains half
/// as much, one that has become another only where there is none.
std::size_t Stepwise::best_law() const {
  const auto rank = [&](std::size_t k) {
    const Trial& trial = now.laws[k].fine;
    const LawStanding standing = standing_of(context_, trial);
    const double left = trial.usable ? trial.held_out_squares - context_.noise_squares() : HUGE_VAL;
    return std::pair(standing == LawStanding::another,
                     standing == LawStanding::sound ? limits::kMostOfTheError * left : left);
  };
  std::size_t lowest = 0;
  for (std::size_t k = 1; k < now.laws.size(); ++k) {
    if (rank(k) < rank(lowest)) lowest = k;
  }
  const auto moved = [&](std::size_t k) {  // parameters that the data say something about
    return std::ranges::count(now.laws[k].fine.evidence.unconstrained(), false);
  };
  std::size_t simplest = lowest;
  for (std::size_t k = 0; k < now.laws.size(); ++k) {
    const Trial& trial = now.laws[k].fine;
    if (standing_of(context_, trial) != LawStanding::sound || beats(context_, now.laws[lowest].fine, trial)) continue;
    if (moved(k) < moved(simplest)) simplest = k;
  }
  return simplest;
}

/// Fits every law with the effects of a model: that of the model too, whose search may have ended in a lower minimum.
void Stepwise::fit_laws(Fitted known) {
  run_tasks(now.laws.size(), context_.threads, [&](std::size_t k) {
    const Law law = now.laws[k].fine.model.law();
    const bool is_known = law == known.fine.model.law();
    Trial coarse = try_law(context_, law, known.coarse);
    if (is_known && !(coarse.usable && beats(context_, coarse, known.coarse))) {
      now.laws[k] = known;
      return;
    }
    Trial fine = coarse.usable ? try_model(context_, context_.fine, coarse.model, coarse.p) : Trial();
    if (!fine.usable) fine.model = FrictionModel(law);
    now.laws[k] = {std::move(fine), std::move(coarse)};
  });
  now.best = best_law();
}

void Stepwise::start(const std::vector<Law>& laws, const std::vector<Candidate>& from_the_start) {
  now.laws.resize(laws.size());
  run_tasks(laws.size(), context_.threads, [&](std::size_t k) {
    const int threads = context_.threads_each(laws.size());
    Trial base = try_base(context_, context_.fine, FrictionModel(laws[k], {}, context_.records.size()), threads);
    for (const Candidate& effect : from_the_start) base = try_with(context_, context_.fine, base, effect);
    now.laws[k] = coarse_too(std::move(base));
  });
  now.best = best_law();
}

Named Stepwise::leader_beside(std::size_t law, const Trial* to_beat) const {
  Named out;
  out.law = law;
  out.judged = judge_beside(law, to_beat);
  const Choice choice = choose(context_, out.judged, candidates_);
  if (choice.leader) {
    out.result = out.judged[*choice.leader];
    out.equivalent = choice.group;
  }
  return out;
}

/// The candidate that predicts best of those that are named beside a law and that no law does without. Where the best
/// law leaves noise only simpler ones are judged beside it.
std::optional<Named> Stepwise::leader_of_all(bool is_noise) {
  Named first = leader_beside(now.best);
  now.last = first.judged;
  std::optional<Named> leader;
  if (first.result.passes) leader = std::move(first);
  const bool simpler_only = !leader && is_noise;
  for (std::size_t law = 0; law < now.laws.size(); ++law) {
    if (law == now.best || !now.laws[law].fine.usable) continue;
    if (simpler_only && now.laws[law].fine.p.size() >= best().fine.p.size()) continue;
    const Trial& to_beat = leader && leader->result.coarse.usable ? leader->result.coarse : best().coarse;
    Named other = leader_beside(law, &to_beat);
    const Trial& trial = other.result.trial;
    if (!other.result.passes || standing_of(context_, trial) == LawStanding::another) continue;
    // Beside a worse law an effect may do no more than make the best law of it.
    const Candidate& candidate = candidates_[other.result.candidate];
    if (!compare(context_, context_.fine, best().fine, trial, candidate, 1, least_).passes) continue;
    if (!leader || beats(context_, trial, leader->result.trial)) leader = std::move(other);
  }
  return leader;
}

/// What a term explains may be that its search ended in a lower minimum: the model without it, fitted anew from there,
/// then takes the place of the one it was compared with.
bool Stepwise::improve(const Named& leader) {
  Fitted& below = now.laws[leader.law];
  Trial without = try_without(context_, context_.fine, leader.result.trial, key(leader.result.candidate));
  const double least = limits::kLowerMinimum * (below.fine.held_out_squares - leader.result.trial.held_out_squares);
  const bool lower = without.usable && without.squares < below.fine.squares &&
                     without.held_out_squares < below.fine.held_out_squares - std::max(0.0, least);
  if (!lower) return false;
  below = coarse_too(std::move(without));
  now.best = best_law();
  return true;
}

void Stepwise::add_term(const CandidateResult& result, std::vector<std::size_t> equivalent,
                        std::vector<CandidateResult> judged) {
  LadderStep term;
  term.added = result.candidate;
  term.by_level = result.by_level;
  term.equivalent = std::move(equivalent);
  term.judged = std::move(judged);
  now.terms.push_back(std::move(term));
}

/// Adds two effects that hide each other, if there are two such that explain more than the one that leads (if any).
bool Stepwise::extend_by_pair(const Named* leader, double worth, int most_effects) {
  if (static_cast<int>(now.terms.size()) + 1 >= most_effects) return false;
  const Fitted& top = now.laws[leader != nullptr ? leader->law : now.best];
  const std::vector<CandidateResult>& judged = leader != nullptr ? leader->judged : now.last;
  LeastOfPair least_of_pair;
  least_of_pair.fall = worth;
  if (leader != nullptr) {
    const CandidateResult& alone = leader->result;
    least_of_pair.size = limits::kRivalPart * alone.size;
    least_of_pair.fall = std::max(worth, alone.fall + limits::kDistinguishableSize * context_.noise_squares());
    least_of_pair.beside = alone.candidate;
  }
  const std::optional<HiddenPair> pair =
      find_hidden_pair(context_, top.fine, top.coarse, judged, least_of_pair, candidates_, least_);
  if (!pair || top.fine.held_out_squares - pair->first.trial.held_out_squares < worth) return false;
  if (leader != nullptr && !are_distinguishable(context_, pair->first, leader->result)) return false;
  // What was judged beside the other one is what decided: it stands for the candidate from here on.
  std::vector<CandidateResult> decided = judged;
  for (CandidateResult& one : decided) {
    if (one.candidate == pair->first.candidate) one.p_value = pair->first.p_value;
    if (one.candidate == pair->second.candidate) one.p_value = pair->second.p_value;
  }
  add_term(pair->first, {}, decided);
  add_term(pair->second, {}, std::move(decided));
  fit_laws(coarse_too(pair->second.trial));
  return true;
}

void Stepwise::extend(int most_effects) {
  now.finished = true;
  const std::vector<Probe> probes = probe_all(context_, best().coarse, best().fine, residual_of(context_, best().fine));
  const bool is_noise = remaining_structure(probes).empty() &&
                        limits::kMostOfTheError * best().fine.held_out_squares < context_.noise_squares();
  const std::optional<Named> leader = leader_of_all(is_noise);
  if (static_cast<int>(now.terms.size()) >= most_effects) return;
  const double here = best().fine.held_out_squares;
  const double worth = limits::kHopelessPart * largest_fall(probes);
  const bool little = leader && !leader->result.by_level && here - leader->result.trial.held_out_squares < worth;
  if (little) now.withdrawn.push_back(leader->result.candidate);
  const Named* worthy = leader && !little ? &*leader : nullptr;
  if (worthy != nullptr && improve(*worthy)) {
    now.finished = false;
  } else if (extend_by_pair(worthy, worth, most_effects)) {
    now.finished = false;
  } else if (worthy != nullptr) {
    add_term(worthy->result, worthy->equivalent, worthy->judged);
    fit_laws(coarse_too(worthy->result.trial));
    now.finished = false;
  }
}

/// Drops an effect without which the law, or another one, does as well. True where one was dropped.
bool Stepwise::drop_one() {
  const Fitted top = best();
  for (std::size_t t = 0; t < now.terms.size(); ++t) {
    const std::size_t added = *now.terms[t].added;
    Fitted without;
    without.fine = try_without(context_, context_.fine, top.fine, key(added), context_.threads);
    if (!without.fine.usable) continue;
    bool needed = compare(context_, context_.fine, without.fine, top.fine, candidates_[added], 1, least_).passes;
    without = coarse_too(std::move(without.fine));
    std::vector<Fitted> others(needed && !now.terms[t].by_level ? now.laws.size() : 0);
    run_tasks(others.size(), context_.threads, [&](std::size_t k) {
      const Law& law = now.laws[k].fine.model.law();
      if (law == top.fine.model.law()) return;
      others[k].coarse = try_law(context_, law, without.coarse);
      if (!others[k].coarse.usable || beats(context_, top.coarse, others[k].coarse)) return;
      others[k].fine = try_model(context_, context_.fine, others[k].coarse.model, others[k].coarse.p);
    });
    for (Fitted& other : others) {
      if (standing_of(context_, other.fine) != LawStanding::sound || beats(context_, top.fine, other.fine)) continue;
      without = std::move(other);
      needed = false;
      break;
    }
    if (needed) continue;
    now.terms.erase(now.terms.begin() + static_cast<std::ptrdiff_t>(t));
    fit_laws(std::move(without));
    return true;
  }
  return false;
}

/// Each effect was chosen beside what was known then. Once the others are there too, it is compared once more with
/// those that explained nearly as much: the better one takes its place, and its group is drawn anew. True where one was
/// replaced.
bool Stepwise::exchange_one() {
  for (LadderStep& term : now.terms) {
    const Trial without = try_without(context_, context_.fine, best().fine, key(*term.added), context_.threads);
    if (!without.usable) continue;
    std::vector<CandidateResult> judged =
        judge_near(context_, term, best().fine, best().coarse, without, candidates_, least_);
    const Choice choice = choose(context_, judged, candidates_);
    if (!choice.leader) continue;
    term.equivalent = choice.group;
    if (*choice.leader == 0) continue;
    term.added = judged[*choice.leader].candidate;
    term.by_level = judged[*choice.leader].by_level;
    fit_laws(coarse_too(judged[*choice.leader].trial));
    return true;
  }
  return false;
}

void Stepwise::finish() {
  const std::size_t law = now.best;
  bool changed = false;
  while (drop_one()) changed = true;
  for (std::size_t k = 0; k < now.terms.size() && now.terms.size() > 1; ++k) {  // as often as there are effects
    if (!exchange_one()) break;
    changed = true;
  }
  while (changed && drop_one()) {
  }
  if (changed || law != now.best) now.last = judge_beside(now.best);
}

/// The terms as rungs with the law that was found, put in order from the top down: the one without which the model
/// predicts best is the last.
std::vector<LadderStep> Stepwise::in_order() const {
  std::vector<LadderStep> terms = now.terms, steps(terms.size() + 1);
  Fitted top = best();
  for (std::size_t last = terms.size(); last > 0; --last) {
    std::vector<Trial> without(last);
    run_tasks(last, context_.threads, [&](std::size_t k) {
      without[k] = try_without(context_, context_.fine, top.fine, key(*terms[k].added));
    });
    std::size_t least = 0;
    for (std::size_t k = 1; k < last; ++k) {
      const bool lower = without[k].plain_held_out < without[least].plain_held_out;
      if (without[k].usable && (!without[least].usable || lower)) least = k;
    }
    steps[last] = std::move(terms[least]);
    steps[last].trial = std::move(top.fine);
    steps[last].coarse = std::move(top.coarse);
    terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(least));
    top = coarse_too(std::move(without[least]));
  }
  steps[0].trial = std::move(top.fine);
  steps[0].coarse = std::move(top.coarse);
  for (LadderStep& step : steps) {
    if (step.trial.usable)
      step.probes = probe_all(context_, step.coarse, step.trial, residual_of(context_, step.trial));
  }
  return steps;
}

Ladder Stepwise::ladder() && {
  Ladder out;
  out.steps = in_order();
  out.withdrawn = std::move(now.withdrawn);
  out.last = std::move(now.last);
  for (const Fitted& other : now.laws) {
    const bool same = other.fine.model.law() == out.top().model.law();
    if (!same && standing_of(context_, other.fine) == LawStanding::sound && !beats(context_, out.top(), other.fine))
      out.rivals.push_back(other.fine);
  }
  // What was added after all is distinguishable: both are there.
  for (LadderStep& step : out.steps) {
    std::erase_if(step.equivalent, [&](std::size_t k) {
      return std::ranges::any_of(out.steps, [&](const LadderStep& s) { return s.added && key(*s.added) == key(k); });
    });
  }
  return out;
}

}  // namespace

Ladder climb(const DiagnosisContext& context, const std::vector<Law>& laws,
             const std::vector<Candidate>& from_the_start, const std::vector<Candidate>& candidates,
             const Limits& least, const ClimbLimits& limits,
             const std::function<void(std::string_view, double)>& progress) {
  Stepwise search(context, candidates, least);
  search.start(laws, from_the_start);
  bool in_time = true;
  double rounds = 0;
  while (in_time && !search.now.finished && search.best().fine.usable) {
    if (progress) progress(search.best().fine.model.name(), rounds / (rounds + 3));
    ++rounds;
    const Progress before = search.now;
    in_time = done_before(limits.until, [&] {
      search.extend(limits.most_effects);
      if (search.now.finished) search.finish();
    });
    if (!in_time) search.now = before;
  }
  if (!search.best().fine.usable) {
    Ladder none;
    none.steps.emplace_back();
    return none;
  }
  Ladder out = std::move(search).ladder();
  out.out_of_time = !in_time;
  return out;
}

}  // namespace tribofit::diagnosis
