#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "judging.hpp"
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

}  // namespace tribofit::diagnosis
