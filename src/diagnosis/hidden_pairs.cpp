#include "hidden_pairs.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "limits.hpp"
#include "tribofit/execution/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

/// A candidate as it was fitted beside the model so far at low resolution.
const Trial& coarse_of(const CandidateResult& judged) {
  return judged.coarse.usable ? judged.coarse : judged.trial;
}

/// Two candidates, each beside the model so far.
struct Two {
  const CandidateResult *a, *b;
};

struct Pool {
  std::vector<const CandidateResult*> all;  ///< those that explain most first
  std::size_t promising = 0;  ///< the first so many explain more than independent noise would, each by itself
};

/// Candidates to try in pairs: the most promising, and whatever could be fitted, since one may show only beside
/// another.
Pool pool_of(const DiagnosisContext& context, const Trial& top, const std::vector<CandidateResult>& judged,
             double least_size, const std::vector<Candidate>& candidates) {
  Pool pool;
  for (const CandidateResult& one : judged) {
    const bool line = candidates[one.candidate].info.needs_full_resolution;
    if (one.trial.usable && one.plausible && !line) pool.all.push_back(&one);
  }
  const auto promises = [&](const CandidateResult* one) {
    return one->fall > limits::kDistinguishable * noise_of(context.fine, top) && one->size > least_size;
  };
  std::stable_sort(pool.all.begin(), pool.all.end(), [&](const auto* a, const auto* b) {
    return promises(a) != promises(b) ? promises(a) : a->size > b->size;
  });
  const auto clear = std::count_if(pool.all.begin(), pool.all.end(), promises);
  pool.promising = std::min(static_cast<std::size_t>(clear), limits::kMostInPairs);
  return pool;
}

/// The most promising two at a time, and the very best with all; without the one that leads.
std::vector<Two> pairs_of(const Pool& pool, const std::optional<std::size_t>& leader,
                          const std::vector<Candidate>& candidates, const Limits& least) {
  std::vector<Two> pairs;
  for (std::size_t a = 0; a < pool.promising; ++a) {
    const std::size_t last = a == 0 ? pool.all.size() : pool.promising;
    for (std::size_t b = a + 1; b < last; ++b) {
      const CandidateResult &one = *pool.all[a], &other = *pool.all[b];
      if (leader && (one.candidate == *leader || other.candidate == *leader)) continue;
      const Candidate &first = candidates[one.candidate], &second = candidates[other.candidate];
      const bool hides = std::max(one.p_value, other.p_value) >= least.p_value;
      if (hides && first.info.key != second.info.key && one.trial.model.acts_with(second.effect))
        pairs.push_back({&one, &other});
    }
  }
  return pairs;
}

/// What linear steps promise of two candidates together, before both are fitted.
struct PairScreening {
  std::vector<std::vector<double>> starts;  ///< of the model with both
  double places = 1;
  double squares = std::numeric_limits<double>::infinity();  ///< that linear steps leave, as Trial::squares has them
  double least_squares = squares;                            ///< the same were such steps to promise too little
  bool is_worth_fitting = false;
};

/// What every pair of one search shares.
struct PairInputs {
  const DiagnosisContext& context;
  const Trial& coarse_top;
  const LeastOfPair& least_of_pair;
  const std::vector<Candidate>& candidates;
  const Limits& least;
  double pairs = 1;  ///< that are looked at

  const Candidate& candidate(const CandidateResult& judged) const { return candidates[judged.candidate]; }
  /// For how many tests a p-value is corrected.
  double tests(double places) const { return pairs * places * static_cast<double>(candidates.size()); }
};

/// Adds what one of two candidates promises beside the other, as that was found.
void add_promise(const PairInputs& in, const CandidateResult& beside, const CandidateResult& added,
                 std::size_t most_starts, PairScreening& promise) {
  const Trial& base = coarse_of(beside);
  const LeastFalls enough = worth_fitting(in.context, base, base.whitening, in.least);
  SearchStart found =
      search_start_of(in.context, in.context.coarse, base, in.candidate(added), residual_of(in.context, base), enough);
  promise.places = std::max(promise.places, found.places);
  if (found.starts.empty()) return;
  if (found.starts.size() > most_starts) found.starts.resize(most_starts);
  std::move(found.starts.begin(), found.starts.end(), std::back_inserter(promise.starts));
  promise.squares = std::min(promise.squares, base.squares - found.promised);
  promise.least_squares = std::min(promise.least_squares, base.squares - found.promised / limits::kWorthFitting);
}

/// Even if both together leave so little, what `added` explains beside `beside` may be chance: the p-value without any
/// correlation. What acts through the level of break-away is judged in another way as well.
bool may_be_chance(const PairInputs& in, const CandidateResult& beside, const CandidateResult& added,
                   const PairScreening& promise) {
  if (in.candidate(added).info.needs.stick_time) return false;
  const DiagnosisContext& context = in.context;
  const Trial& base = coarse_of(beside);
  const double fall = base.squares - promise.least_squares;
  const double noise =
      std::max(noise_of(context.coarse, base) - fall / context.coarse.values, context.noise * context.noise);
  const double known = std::max(3.0, static_cast<double>(base.held_out.size()) / 3);
  return in.tests(promise.places) * fall_p_value(fall, 1, noise, 1, known) >= in.least.p_value;
}

PairScreening promise_of(const PairInputs& in, const Two& two) {
  PairScreening promise;
  add_promise(in, *two.a, *two.b, limits::kMostStarts, promise);
  add_promise(in, *two.b, *two.a, 1, promise);
  promise.is_worth_fitting = !promise.starts.empty() &&
                             in.coarse_top.squares - promise.least_squares >= in.least_of_pair.fall &&
                             !may_be_chance(in, *two.a, *two.b, promise) && !may_be_chance(in, *two.b, *two.a, promise);
  return promise;
}

/// Indices of the pairs that are to be fitted, the most promising first. None that could not do better than another one
/// is promised to do.
std::vector<std::size_t> to_be_fitted(const std::vector<PairScreening>& promises) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < promises.size(); ++k) {
    if (promises[k].is_worth_fitting) order.push_back(k);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return promises[i].squares < promises[j].squares; });
  if (order.empty()) return order;
  const double best = promises[order[0]].squares;
  std::erase_if(order, [&](std::size_t k) { return promises[k].least_squares > best; });
  if (order.size() > limits::kMostPairsFitted) order.resize(limits::kMostPairsFitted);
  return order;
}

/// Looks for an effect of a trial anew beside the others as they were found beside it; the better of the two. without:
/// squares of the model without the effect.
Trial search_again(const DiagnosisContext& context, Trial full, const Candidate& candidate, double without) {
  if (!full.usable) return full;
  const Level& level = context.coarse;
  const Trial base = without_effect(full, candidate.info.key);
  const SearchStart search = search_start_of(context, level, base, candidate, residual_of(context, base), LeastFalls());
  const double explained = std::max(0.0, without - full.squares);
  if (search.starts.empty() || search.squares > full.row_squares + limits::kWorthFitting * explained) return full;
  const Solution found = nearest(level, full.model, full.whitening, search.starts);
  if (!(2 * found.cost < full.row_squares)) return full;  // it leads back, or to somewhere worse
  Trial again = try_model(context, level, full.model, found.p);
  const bool better = again.usable && again.held_out_squares < full.held_out_squares;
  return better ? std::move(again) : std::move(full);
}

/// Both of a pair, each judged beside the other.
HiddenPair judge_pair(const PairInputs& in, const Level& level, const Two& two, const Trial& a_alone,
                      const Trial& b_alone, Trial both, double places) {
  HiddenPair out;
  if (!both.usable) return out;
  const double tests = in.tests(places);
  out.first = compare(in.context, level, b_alone, both, in.candidate(*two.a), tests, in.least);
  out.second = compare(in.context, level, a_alone, std::move(both), in.candidate(*two.b), tests, in.least);
  out.first.candidate = two.a->candidate;
  out.second.candidate = two.b->candidate;
  return out;
}

/// A pair at low resolution. What is found of either without the other may be far off (the moment of a step), so each
/// is looked for anew beside the other.
HiddenPair fit_coarsely(const PairInputs& in, const Two& two, const PairScreening& promise) {
  const Trial &a = coarse_of(*two.a), &b = coarse_of(*two.b);
  const Candidate &first = in.candidate(*two.a), &second = in.candidate(*two.b);
  const FrictionModel model = with_effect(a.model, second.effect);
  const Level& level = in.context.coarse;
  Trial both = try_model(in.context, level, model, nearest(level, model, a.whitening, promise.starts).p);
  both = search_again(in.context, std::move(both), first, b.squares);
  both = search_again(in.context, std::move(both), second, a.squares);
  return judge_pair(in, level, two, a, b, std::move(both), promise.places);
}

/// The same at full resolution, from there.
HiddenPair fit_finely(const PairInputs& in, const Trial& top, const Two& two, const Trial& coarse, double places) {
  const Level& level = in.context.fine;
  Trial a, b, both;
  const auto alone = [&](const CandidateResult& judged) {
    return judged.hopeless ? try_model(in.context, level, judged.trial.model, judged.trial.p) : judged.trial;
  };
  run_tasks(3, in.context.threads, [&](std::size_t k) {
    if (k == 0) both = try_model(in.context, level, coarse.model, coarse.p);
    if (k == 1) a = alone(*two.a);
    if (k == 2) b = alone(*two.b);
  });
  HiddenPair out = judge_pair(in, level, two, a, b, std::move(both), places);
  out.alone = compare(in.context, level, top, std::move(a), in.candidate(*two.a), 1, in.least);
  out.alone.candidate = two.a->candidate;
  return out;
}

}  // namespace

std::optional<HiddenPair> find_hidden_pair(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                           const std::vector<CandidateResult>& judged, const LeastOfPair& least_of_pair,
                                           const std::vector<Candidate>& candidates, const Limits& least) {
  const Pool pool = pool_of(context, top, judged, std::max(least_of_pair.size, least.least_size), candidates);
  const std::vector<Two> pairs = pairs_of(pool, least_of_pair.beside, candidates, least);
  const PairInputs in = {context, coarse_top, least_of_pair, candidates, least, static_cast<double>(pairs.size())};
  std::vector<PairScreening> promises(pairs.size());
  run_tasks(pairs.size(), context.threads, [&](std::size_t k) { promises[k] = promise_of(in, pairs[k]); });
  const std::vector<std::size_t> fitted = to_be_fitted(promises);
  std::vector<HiddenPair> found(fitted.size());
  run_tasks(fitted.size(), context.threads,
            [&](std::size_t k) { found[k] = fit_coarsely(in, pairs[fitted[k]], promises[fitted[k]]); });
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k].first.passes || !found[k].second.passes) continue;
    const double squares = found[k].first.trial.held_out_squares;
    if (!best || squares < found[*best].first.trial.held_out_squares) best = k;
  }
  if (!best) return {};
  HiddenPair pair = fit_finely(in, top, pairs[fitted[*best]], found[*best].first.trial, promises[fitted[*best]].places);
  if (!pair.first.passes || !pair.second.passes) return {};
  return pair;
}

}  // namespace tribofit::diagnosis
