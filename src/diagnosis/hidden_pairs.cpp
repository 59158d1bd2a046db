#include "hidden_pairs.hpp"

#include <algorithm>
#include <utility>

#include "limits.hpp"
#include "tribofit/statistics/parallel.hpp"

namespace tribofit::diagnosis {

namespace {

/// Two candidates, each fitted beside the model so far.
struct Two {
  CandidateResult a, b;
};

/// A candidate beside the model so far at another resolution than it was judged at.
CandidateResult fitted_at(const DiagnosisContext& context, const Level& level, const Trial& top,
                          const CandidateResult& judged, const std::vector<Candidate>& candidates,
                          const Limits& least) {
  Trial trial = try_model(context, level, judged.trial.model, judged.trial.p);
  CandidateResult out = compare(context, level, top, std::move(trial), candidates[judged.candidate], 1, least);
  out.candidate = judged.candidate;
  return out;
}

struct Pool {
  std::vector<CandidateResult> all;  ///< at low resolution, those that explain most first
  std::size_t promising = 0;         ///< the first so many explain more than independent noise would, each by itself
};

/// Candidates to try in pairs: the most promising, and whatever could be fitted, since one may show only beside
/// another.
Pool pool_of(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
             const std::vector<CandidateResult>& judged, double least_size, const std::vector<Candidate>& candidates,
             const Limits& least) {
  std::vector<const CandidateResult*> all;
  for (const CandidateResult& one : judged) {
    const bool line = candidates[one.candidate].info.needs_full_resolution;
    if (one.trial.usable && one.plausible && !line) all.push_back(&one);
  }
  const auto promises = [&](const CandidateResult* one) {
    return one->fall > limits::kDistinguishable * noise_of(context.fine, top) && one->size > least_size;
  };
  std::stable_sort(all.begin(), all.end(), [&](const auto* a, const auto* b) {
    return promises(a) != promises(b) ? promises(a) : a->size > b->size;
  });
  Pool pool;
  const auto clear = std::count_if(all.begin(), all.end(), promises);
  pool.promising = std::min(static_cast<std::size_t>(clear), limits::kMostInPairs);
  if (clear == 0) return pool;
  pool.all.resize(all.size());
  run_tasks(all.size(), context.threads, [&](std::size_t k) {
    pool.all[k] = fitted_at(context, context.coarse, coarse_top, *all[k], candidates, least);
    pool.all[k].p_value = all[k]->p_value;
  });
  return pool;
}

/// The most promising two at a time, and the very best with all.
std::vector<Two> pairs_of(const Pool& pool, const std::vector<Candidate>& candidates, const Limits& least) {
  std::vector<Two> pairs;
  for (std::size_t a = 0; a < pool.promising; ++a) {
    const std::size_t last = a < limits::kMostWithAll ? pool.all.size() : pool.promising;
    for (std::size_t b = a + 1; b < last; ++b) {
      const CandidateResult &one = pool.all[a], &other = pool.all[b];
      const Candidate &first = candidates[one.candidate], &second = candidates[other.candidate];
      const bool hides = std::max(one.p_value, other.p_value) >= least.p_value;
      if (hides && first.info.key != second.info.key && one.trial.model.acts_with(second.effect))
        pairs.push_back({one, other});
    }
  }
  return pairs;
}

/// Looks for an effect of a trial anew beside all the others as they were found beside it; the better of the two.
Trial search_again(const DiagnosisContext& context, const Level& level, Trial full, const Candidate& candidate) {
  if (!full.usable) return full;
  Trial again = try_with(context, level, without_effect(full, candidate.info.key), candidate).trial;
  const bool better = again.usable && again.held_out_squares < full.held_out_squares;
  return better ? std::move(again) : std::move(full);
}

/// Both of a pair, each judged beside the other. What is found of either without the other may be far off (the moment
/// of a step), so each is looked for anew beside the other, and the better of the two is taken.
HiddenPair judge_pair(const DiagnosisContext& context, const Level& level, const Two& alone,
                      const std::vector<Candidate>& candidates, double pairs, const Limits& least) {
  const Candidate &first = candidates[alone.a.candidate], &second = candidates[alone.b.candidate];
  auto [both, places] = try_with(context, level, alone.a.trial, second);
  auto [turned, other_places] = try_with(context, level, alone.b.trial, first);
  if (turned.usable && (!both.usable || turned.held_out_squares < both.held_out_squares)) both = std::move(turned);
  both = search_again(context, level, search_again(context, level, std::move(both), first), second);
  HiddenPair out;
  if (!both.usable) return out;
  const double tests = pairs * std::max(places, other_places) * static_cast<double>(candidates.size());
  out.first = compare(context, level, alone.b.trial, both, first, tests, least);
  out.second = compare(context, level, alone.a.trial, both, second, tests, least);
  out.alone = alone.a;
  out.first.candidate = alone.a.candidate;
  out.second.candidate = alone.b.candidate;
  return out;
}

}  // namespace

std::optional<HiddenPair> find_hidden_pair(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                           const std::vector<CandidateResult>& judged, double least_size,
                                           const std::vector<Candidate>& candidates, const Limits& least) {
  const Pool pool =
      pool_of(context, top, coarse_top, judged, std::max(least_size, least.least_size), candidates, least);
  const std::vector<Two> pairs = pairs_of(pool, candidates, least);
  const auto tried = static_cast<double>(pairs.size());
  std::vector<HiddenPair> found(pairs.size());
  run_tasks(pairs.size(), context.threads,
            [&](std::size_t k) { found[k] = judge_pair(context, context.coarse, pairs[k], candidates, tried, least); });
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!found[k].first.passes || !found[k].second.passes) continue;
    const double squares = found[k].first.trial.held_out_squares;
    if (!best || squares < found[*best].first.trial.held_out_squares) best = k;
  }
  if (!best) return {};
  const Two fine = {fitted_at(context, context.fine, top, pairs[*best].a, candidates, least),
                    fitted_at(context, context.fine, top, pairs[*best].b, candidates, least)};
  HiddenPair pair = judge_pair(context, context.fine, fine, candidates, tried, least);
  if (!pair.first.passes || !pair.second.passes) return {};
  return pair;
}

}  // namespace tribofit::diagnosis
