#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "evidence.hpp"
#include "probes.hpp"
#include "trial.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

struct LadderStep {
  std::optional<std::size_t> added;     ///< candidate; none for the base law
  bool by_level = false;                ///< it was added for the levels of break-away alone
  Trial trial;                          ///< at full resolution
  Trial coarse;                         ///< the same at low resolution
  Trial without;                        ///< fitted from `trial` without the effect added, where that is known
  std::vector<Probe> probes;            ///< what free functions find beside it
  std::vector<std::size_t> equivalent;  ///< candidates that do as well
  std::vector<CandidateResult> judged;  ///< every candidate tried beside the step before
};

/// The rungs from one base law up.
struct Ladder {
  Law law = ExponentialLaw{};
  std::vector<LadderStep> steps;       ///< the base law first
  std::vector<std::size_t> withdrawn;  ///< candidates that were added at first, and explain too little of what is wrong
  std::vector<CandidateResult> last;   ///< candidates judged beside the last rung: none of them passes
  bool finished = false;               ///< nothing more passes
  bool out_of_time = false;            ///< the time was over before that could be said of all ladders
  const Trial& top() const { return steps.back().trial; }
};

/// Laws to climb from.
struct CompetingLaws {
  std::vector<Law> first;
  std::vector<Law> others = {};  ///< climbed from where, with an effect less, they do as well as the best of the first

  std::vector<Law> all() const {
    std::vector<Law> laws = first;
    laws.insert(laws.end(), others.begin(), others.end());
    return laws;
  }
};

/// The ladders from every base law.
struct Climb {
  std::vector<Ladder> ladders;
  bool out_of_time = false;  ///< not every one is finished that might be the one to report
};

/// How long and how high.
struct ClimbLimits {
  int most_effects = 4;
  std::optional<std::chrono::steady_clock::time_point> until = {};  ///< the ladders then stand where they are
};

/// Adds effects to each base law, the best one at a time, until nothing passes; then drops what became redundant.
///
/// The ladder that predicts best so far is climbed first, until it is two rungs ahead of another: a law that fits badly
/// earns rung after rung, and would take most of a diagnosis. Once one is finished that leaves nothing unexplained,
/// another that is as long and no better is given up where it stands: only with more rungs could it do as well.
/// When time is over, none need be finished.
/// from_the_start: effects that stand beside each law on every rung. progress: may be empty.
Climb climb(const DiagnosisContext& context, const CompetingLaws& laws, const std::vector<Candidate>& from_the_start,
            const std::vector<Candidate>& candidates, const Limits& least, const ClimbLimits& limits,
            const std::function<void(std::string_view, double)>& progress = {});

/// The ladder that predicts held-out cycles better, or the shorter one where that cannot be said.
std::size_t better_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders);

// ---- the laws to climb from

/// Base laws to climb from. Where a choice is given and no record ever sticks, Coulomb friction is one more: nothing in
/// such records shows a level of break-away, and a drop from it must be found in sliding alone.
/// Where a choice is given the other laws of the list compete too, Coulomb friction among them where the block sticks.
/// effects: part of the model from the start; the law must be one that they can act on.
CompetingLaws base_laws(std::span<const Record> records, std::vector<Law> given, std::span<const Effect> effects = {});

/// The ladder to tell: see better_ladder. Where Coulomb friction is among them, a law that only rises in a straight
/// line does not compete: it is Coulomb friction with something more, and the ladder from there says what.
std::size_t reported_ladder(const DiagnosisContext& context, const std::vector<Ladder>& ladders);

inline constexpr std::size_t kAllEffects = std::numeric_limits<std::size_t>::max();

/// Another law with the effects of a trial but one, at low resolution; not usable where an effect cannot act on it.
Trial try_other_law(const DiagnosisContext& context, const Law& law, const Trial& known,
                    std::size_t without = kAllEffects);

/// Of `laws` those that these data do not distinguish from the law of a fitted model: with the same effects they
/// predict held-out cycles as well, by the comparison that `identify` makes of two laws. top: the model at low
/// resolution, fitted: as it is reported.
std::vector<Law> rival_laws(const DiagnosisContext& context, const std::vector<Law>& laws, const Trial& top,
                            const Fit& fitted, const Instruments& instruments, const FitOptions& options);

// ---- the steps of a ladder

/// The trial's model without one of its effects, fitted.
Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads = 1);

/// Fills in what is asked of every step.
void look_beside(const DiagnosisContext& context, LadderStep& step);

/// What the largest structure beside a step would take away of the held-out squares; 0 where none is left.
double largest_fall(const LadderStep& step);

/// Drops effects that the ones added after them made redundant. Returns the top without each of those left.
std::vector<Trial> prune(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                         const Limits& least);

/// Each effect was chosen beside what was known then. Once the others are there too, it is compared once more with
/// those that explained nearly as much: the better one takes its place, and its group is drawn anew. True where one was
/// replaced. without: the top without each of its effects; empty where that is not known.
bool reconsider(const DiagnosisContext& context, Ladder& ladder, const std::vector<Candidate>& candidates,
                const Limits& least, std::vector<Trial> without = {});

/// Where structure is left that no effect explains, a name that was given to a smaller part of the error while a free
/// function of one variable explained far more is probably wrong: it is withdrawn, with those that stand on it. Not
/// where the effects above it have explained nearly all of that after all. Nor does a name stand for less than what is
/// left where friction swings as a whole: a load that moves makes another law of any. swinging: squares that are left
/// there, with the scatter of break-away; 0: it does not swing.
void withdraw(Ladder& ladder, double swinging);

/// Two effects neither of which shows beside the model so far, since each leaves the other as what looks like slow
/// noise. Each is judged beside the other, with the correction for every pair that was tried.
struct HiddenPair {
  CandidateResult first, second;  ///< each beside the other; the one that explains more alone is first
  CandidateResult alone;          ///< the first beside the model so far
};

/// What a pair must explain.
struct LeastOfPair {
  double size = 0;  ///< of those that are tried, each alone (see CandidateResult::size)
  double fall = 0;  ///< of the whitened squares, both together
  /// The candidate that is added if no pair does better. What hides beside it shows on the next rung, so it is tried in
  /// no pair.
  std::optional<std::size_t> beside = {};
};

/// top, coarse_top: the model so far at both resolutions; judged: every candidate beside it. A pair is fitted where
/// linear steps promise what it must explain; of many that promise it, those that promise most.
std::optional<HiddenPair> find_hidden_pair(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                           const std::vector<CandidateResult>& judged, const LeastOfPair& least_of_pair,
                                           const std::vector<Candidate>& candidates, const Limits& least);

}  // namespace tribofit::diagnosis
