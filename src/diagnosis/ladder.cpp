#include "ladder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lines.hpp"
#include "probes.hpp"
#include "tribofit/fit/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

/// Two models are told apart when their squares differ by more than chance would make them: with the right one known
/// the difference is d^2 -+ 2 d sqrt(noise) in units in which the noise of the difference is one; 40 is beyond three
/// standard deviations, with some room for the models themselves being approximations.
constexpr double kToldApart = 40;
constexpr double kToldApartSize = 0.003;  ///< and by this part of the squares of the noise

/// The data draw a parameter that is on its bound beyond it: a tenth of its range inside, the others following, the
/// squares are larger than chance would make them.
bool is_drawn_beyond(const Trial& trial, std::size_t k, double least_squares) {
  constexpr double kInside = 0.1, kSigmas = 3;
  const Parameter& q = trial.model.parameters()[k].parameter;
  const double range = (q.upper - q.lower) * q.si, middle = 0.5 * (q.upper + q.lower) * q.si;
  Linearised inside = trial.linear;
  const double before = sum(squares_after(inside, gauss_newton_step(inside)));
  const double step = kInside * range * (trial.p[k] > middle ? -1 : 1);
  for (Eigen::MatrixXd& rows : inside.rows) rows.col(rows.cols() - 1) += rows.col(static_cast<Eigen::Index>(k)) * step;
  return sum(squares_after(inside, gauss_newton_step(inside))) - before > kSigmas * kSigmas * least_squares;
}

/// On its bound the size of an effect, or a time, length or frequency without which it is another effect, is not what
/// the effect says, where the data draw it there. noise: variance of a residual, correlation counted.
bool is_plausible(const Bench& bench, const Trial& trial, const Candidate& candidate, double noise) {
  const EffectInfo& info = candidate.info;
  const std::size_t offset = trial.model.offset_of(info.key);
  if (candidate.possible && !candidate.possible->holds(trial.p[offset])) return false;
  for (std::size_t k = 0; k < info.parameters.size(); ++k) {
    const Parameter& q = info.parameters[k];
    const bool telling = k == 0 || (std::isnan(q.neutral) && (q.unit == "s" || q.unit == "mm" || q.unit == "Hz"));
    const bool away = k == 0 && std::abs(trial.p[offset] - q.neutral * q.si) > 0.5 * (q.upper - q.lower) * q.si;
    const bool flat = away && trial.at_bound[offset] && !is_drawn_beyond(trial, offset, noise);
    if (telling && trial.at_bound[offset + k] && !flat) return false;
    if (info.key == "ringing" && q.unit == "Hz" && trial.p[offset + k] < lowest_ringing(bench.fine.observations))
      return false;
  }
  return true;
}

/// A line is seen only at full resolution.
bool is_narrow(const EffectInfo& info) {
  return std::any_of(info.parameters.begin(), info.parameters.end(), [](const Parameter& q) { return q.name == "f"; });
}

/// The larger of the design effects of the free parameters of an effect, and how many of them there are.
struct Added {
  double design_effect = 1;
  std::size_t free = 0;
};

Added added_by(const Linearised& linear, std::size_t offset, std::size_t count, double noise) {
  Added out;
  for (std::size_t k = offset; k < offset + count; ++k) {
    if (!linear.free[k]) continue;
    ++out.free;
    out.design_effect = std::max(out.design_effect, design_effect(linear, k, noise));
  }
  out.free = std::max<std::size_t>(1, out.free);
  return out;
}

/// Degrees of freedom of what correlates between n cycles: see mean_error().
double few_frequencies(double n) {
  return std::max(3.0, 0.4 * std::pow(n, 2.0 / 3));
}

/// Whether an effect of the stick time explains what otherwise is scatter of break-away from cycle to cycle.
///
/// The whitened squares take that scatter for what it is from one cycle to the next; where it wanders, an effect that
/// acts on the level of single cycles (a longer stick after a pause) may explain much of it and lower them little.
/// Here the squares themselves are compared, with the correlation between cycles as it is.
bool passes_by_level(const Level& level, const Trial& poorer, const Trial& trial, const EffectInfo& info, double tests,
                     const Limits& limits, double floor) {
  // A break-away that is high by chance makes its own stick longer, and explains some of itself like that.
  constexpr double kLeastSize = 0.15;
  const double fall = poorer.plain_minimum - trial.plain_minimum;
  if (poorer.plain_held_out - trial.plain_held_out <= kLeastSize * floor) return false;
  const double noise = (trial.plain_minimum + trial.stick.rigid - trial.stick.left) / level.values;
  const Added added = added_by(trial.plain, trial.model.offset_of(info.key), info.parameters.size(), noise);
  const double freedom = few_frequencies(static_cast<double>(trial.plain.rows.size()));
  return 2 * tests * fall_p_value(fall, added.free, noise, added.design_effect, freedom) < limits.p_value;
}

/// How much better `richer` is than `poorer`, from which it differs by one effect.
Judged compare(const Bench& bench, const Level& level, const Trial& poorer, Trial richer, const Candidate& candidate,
               double tests, const Limits& limits) {
  const EffectInfo& info = candidate.info;
  Judged out;
  out.trial = std::move(richer);
  const Trial& trial = out.trial;
  if (!trial.usable) return out;
  const double noise = noise_of(level, trial);
  const Added added = added_by(trial.linear, trial.model.offset_of(info.key), info.parameters.size(), noise);
  out.design_effect = added.design_effect;
  // The noise is known from all cycles where neighbours are independent, and from few frequencies where they are not. A
  // line stands among as many frequencies as it likes.
  const auto cycles = static_cast<double>(trial.held_out.size());
  const bool few = out.design_effect > 1.2 && !is_narrow(info);
  const double freedom = few ? few_frequencies(cycles) : std::max(3.0, cycles / 3);
  out.p_value = std::min(
      1.0, tests * fall_p_value(poorer.squares - trial.squares, added.free, noise, out.design_effect, freedom));
  out.fall = poorer.held_out_squares - trial.held_out_squares;
  const double floor = bench.floor_squares(trial.whitening);
  out.size = std::max(out.fall / bench.noise_squares(), (poorer.plain_squares - trial.plain_squares) / floor);
  out.plausible = is_plausible(bench, trial, candidate, noise * out.design_effect);
  // A second effect that is missing too makes what is left look correlated; a fall as large as this one, on blocks of
  // cycles that took no part, needs no such test.
  const double above = poorer.held_out_squares - bench.noise_squares();
  // Not in records that never stick: their few steps of speed go with time.
  const auto& slips = level.observations.slips;
  const auto breaks = std::count_if(slips.begin(), slips.end(), [](const auto& slip) { return slip.from_stick; });
  const bool sticks = breaks >= 30;
  const bool obvious = !is_narrow(info) && sticks && out.fall > limits.obvious_size * bench.noise_squares() &&
                       out.fall > limits.obvious_part * above;
  const bool seen = out.fall > 0 && (out.p_value < limits.p_value || obvious);
  out.by_level = out.plausible && !seen && sticks && info.needs.stick_time &&
                 passes_by_level(level, poorer, trial, info, tests, limits, floor);
  out.passes = out.plausible && out.size > limits.least_size && (seen || out.by_level);
  return out;
}

bool told_apart(const Bench& bench, const Judged& better, const Judged& worse) {
  const double difference = worse.trial.held_out_squares - better.trial.held_out_squares;
  return difference > kToldApart * noise_of(bench.fine, better.trial) * better.design_effect &&
         difference > kToldApartSize * bench.noise_squares();
}

/// The leader among those that pass, with those that cannot be told from it.
struct Choice {
  std::optional<std::size_t> leader;  ///< index in `judged`
  std::vector<std::size_t> group;     ///< candidates
};

/// Of the forms of one effect one has the name: the plain one, unless the data tell another from it.
void keep_one_form(const Bench& bench, const std::vector<Candidate>& candidates, std::vector<Judged>& judged) {
  for (Judged& form : judged) {
    const EffectInfo& info = candidates[form.candidate].info;
    if (info.option.empty() || !form.passes) continue;
    const auto plain = std::find_if(judged.begin(), judged.end(), [&](const Judged& other) {
      const EffectInfo& known = candidates[other.candidate].info;
      return known.key == info.key && known.option.empty();
    });
    if (plain == judged.end() || !plain->passes) continue;
    (told_apart(bench, form, *plain) ? *plain : form).passes = false;
  }
}

Choice choose(const Bench& bench, std::vector<Judged>& judged, const std::vector<Candidate>& candidates) {
  keep_one_form(bench, candidates, judged);
  Choice choice;
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (!judged[k].passes) continue;
    if (!best || judged[k].trial.held_out_squares < judged[*best].trial.held_out_squares) best = k;
  }
  if (!best) return choice;
  choice.leader = best;
  // The simplest of those that do as well leads.
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (!judged[k].passes || told_apart(bench, judged[*best], judged[k])) continue;
    const std::size_t now = judged[*choice.leader].trial.p.size(), other = judged[k].trial.p.size();
    const bool lower = judged[k].trial.held_out_squares < judged[*choice.leader].trial.held_out_squares;
    if (other < now || (other == now && lower)) choice.leader = k;
  }
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (k == *choice.leader || !judged[k].passes || told_apart(bench, judged[*best], judged[k])) continue;
    choice.group.push_back(judged[k].candidate);
  }
  // What the declared uncertainty of an instrument leaves room for is no reason to name anything else.
  for (std::size_t k = 0; k < judged.size(); ++k) {
    if (!judged[k].passes || !candidates[judged[k].candidate].possible) continue;
    if (told_apart(bench, judged[*best], judged[k])) continue;
    choice.leader = k;
    choice.group.clear();
  }
  return choice;
}

/// Every testable candidate beside the top of the ladder: searched and judged at low resolution, and those that may
/// lead or be in the leader's group again at full resolution.
std::vector<Judged> judge_all(const Bench& bench, const LadderStep& step, const std::vector<Candidate>& candidates,
                              const Limits& limits) {
  const Trial &top = step.trial, &coarse_top = step.coarse;
  const std::vector<std::string> present = top.model.effect_keys();
  const std::vector<double> residual = residual_of(bench, top);
  // What is too small to be named, or small beside what is wrong for another reason, need not be fitted.
  constexpr double kLeastPart = 0.02;
  const auto enough = [&](double floor, double squares) {
    return std::max(0.5 * limits.least_size * floor, kLeastPart * (squares - floor));
  };
  const double least = enough(bench.noise_squares(), coarse_top.squares);
  const double least_plain = enough(bench.floor_squares(top.whitening), coarse_top.plain_squares);
  const auto tests = static_cast<double>(candidates.size());
  std::vector<std::size_t> tried;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    if (!candidates[k].untestable.empty()) continue;
    if (std::find(present.begin(), present.end(), candidates[k].info.key) != present.end()) continue;
    if (top.model.acts_with(candidates[k].effect)) tried.push_back(k);
  }
  std::vector<Judged> out(tried.size());
  std::vector<Opening> openings(tried.size());
  const auto judge = [&](std::size_t t, const Level& level, const Trial& beside, const FrictionModel& model,
                         const std::vector<double>& start) {
    out[t] = compare(bench, level, beside, try_model(bench, level, model, start), candidates[tried[t]],
                     openings[t].places * tests, limits);
    out[t].candidate = tried[t];
  };
  const auto search = [&](std::size_t t, const Level& level, const Trial& beside) {
    const FrictionModel model = with_effect(top.model, candidates[tried[t]].effect);
    judge(t, level, beside, model, nearest(level, model, beside.whitening, openings[t].starts));
  };
  run_tasks(tried.size(), bench.threads, [&](std::size_t t) {
    const Candidate& candidate = candidates[tried[t]];
    out[t].candidate = tried[t];
    const bool narrow = is_narrow(candidate.info);
    const Level& level = narrow ? bench.fine : bench.coarse;
    const Trial& beside = narrow ? top : coarse_top;
    openings[t] = opening_of(bench, level, beside, candidate, residual, least, least_plain);
    if (!narrow && !openings[t].starts.empty()) search(t, level, beside);
  });
  double best = coarse_top.held_out_squares;
  for (const Judged& judged : out) {
    if (judged.trial.usable) best = std::min(best, judged.trial.held_out_squares);
  }
  const double fallen = coarse_top.held_out_squares - best;
  double next = 0;  // what may be added before a line
  for (const Judged& judged : out) {
    if (judged.passes) next = std::max(next, judged.fall);
  }
  run_tasks(out.size(), bench.threads, [&](std::size_t t) {
    Judged& judged = out[t];
    if (is_narrow(candidates[judged.candidate].info)) {
      // A line beside something much larger can wait: it is as clear, and sooner found, once that is out of the way.
      constexpr double kPutOff = 0.3;
      judged.hopeless = openings[t].starts.empty() || openings[t].promised < kPutOff * next;
      if (!judged.hopeless) search(t, bench.fine, top);
      return;
    }
    if (!judged.trial.usable) return;
    const double behind = judged.trial.held_out_squares - best;
    const bool small = judged.size < 0.5 * limits.least_size || (judged.p_value > 0.5 && !judged.passes) ||
                       (judged.fall < least && judged.fall < kLeastPart * fallen);
    const bool far = behind > 0.08 * fallen + 0.05 * bench.noise_squares();
    judged.hopeless = !judged.by_level && (far || judged.fall < 0 || small);
    judged.passes = judged.passes && !judged.hopeless;
    if (judged.hopeless) return;
    const Trial coarse = std::move(judged.trial);
    judge(t, bench.fine, top, coarse.model, coarse.p);
  });
  return out;
}

/// Fills in what is asked of every step.
void look_beside(const Bench& bench, LadderStep& step) {
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
void put_in_order(const Bench& bench, Ladder& ladder, const std::vector<Candidate>& candidates, Trial top) {
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
void prune(const Bench& bench, Ladder& ladder, const std::vector<Candidate>& candidates, const Limits& limits) {
  for (std::size_t s = 1; s + 1 < ladder.steps.size();) {
    const Candidate& candidate = candidates[*ladder.steps[s].added];
    const Trial& full = ladder.top();
    Trial without = try_without(bench, bench.fine, full, index_of(full.model, candidate.info.key));
    const Judged needed = compare(bench, bench.fine, without, full, candidate, 1, limits);
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
Trial try_instead(const Bench& bench, const Trial& without, const Candidate& candidate, const Trial& judged) {
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
bool reconsider(const Bench& bench, Ladder& ladder, const std::vector<Candidate>& candidates, const Limits& limits) {
  constexpr double kNearly = 0.5;
  for (std::size_t s = 1; s < ladder.steps.size() && ladder.steps.size() > 2; ++s) {
    LadderStep& step = ladder.steps[s];
    const Trial& full = ladder.top();
    const std::vector<std::string> present = full.model.effect_keys();
    const auto chosen = std::find_if(step.judged.begin(), step.judged.end(),
                                     [&](const Judged& j) { return j.candidate == *step.added; });
    std::vector<const Judged*> rivals;
    for (const Judged& judged : step.judged) {
      const std::string& key = candidates[judged.candidate].info.key;
      const bool is_present = std::find(present.begin(), present.end(), key) != present.end();
      const bool near = chosen == step.judged.end() || judged.fall > kNearly * chosen->fall;
      if (judged.trial.usable && judged.plausible && !is_present && near) rivals.push_back(&judged);
    }
    if (rivals.empty()) continue;
    const Candidate& now = candidates[*step.added];
    const Trial without = try_without(bench, bench.fine, full, index_of(full.model, now.info.key));
    if (!without.usable) continue;
    std::erase_if(rivals, [&](const Judged* r) { return !without.model.acts_with(candidates[r->candidate].effect); });
    if (rivals.empty()) continue;
    std::vector<Judged> judged(rivals.size() + 1);
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
void extend(const Bench& bench, Ladder& ladder, const std::vector<Candidate>& candidates, const Limits& limits,
            int most_effects) {
  ladder.finished = true;
  ladder.last = judge_all(bench, ladder.steps.back(), candidates, limits);
  if (static_cast<int>(ladder.steps.size()) > most_effects) return;
  const Choice choice = choose(bench, ladder.last, candidates);
  if (!choice.leader) return;
  // Two effects of the same variable may each explain half of what a free function finds there, but not much less.
  constexpr double kHopeless = 0.35;
  const Judged& leader = ladder.last[*choice.leader];
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
void finish(const Bench& bench, Ladder& ladder, const std::vector<Candidate>& candidates, const Limits& limits) {
  const std::size_t before = ladder.steps.size();
  prune(bench, ladder, candidates, limits);
  bool replaced = false;
  for (std::size_t s = 1; s < ladder.steps.size(); ++s) {  // as often as there are effects, at the most
    if (!reconsider(bench, ladder, candidates, limits)) break;
    replaced = true;
  }
  if (replaced) prune(bench, ladder, candidates, limits);
  if (replaced || ladder.steps.size() < before) ladder.last = judge_all(bench, ladder.steps.back(), candidates, limits);
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

Ladder start_ladder(const Bench& bench, BaseLaw law, const std::vector<Candidate>& from_the_start) {
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
bool is_better(const Bench& bench, const Trial& first, const Trial& second) {
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
bool is_beaten(const Bench& bench, const Ladder& ladder, const std::vector<Ladder>& all) {
  return std::any_of(all.begin(), all.end(), [&](const Ladder& other) {
    return other.finished && other.top().usable && largest_fall(other.steps.back()) == 0 &&
           ladder.steps.size() >= other.steps.size() && !is_better(bench, other.top(), ladder.top());
  });
}

}  // namespace

std::vector<Ladder> climb(const Bench& bench, const std::vector<BaseLaw>& laws,
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

std::size_t better_ladder(const Bench& bench, const std::vector<Ladder>& ladders) {
  std::size_t best = 0;
  for (std::size_t k = 1; k < ladders.size(); ++k) {
    if (is_better(bench, ladders[best].top(), ladders[k].top())) best = k;
  }
  return best;
}

}  // namespace tribofit::diagnosis
