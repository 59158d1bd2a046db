#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "evidence.hpp"
#include "probes.hpp"
#include "trial.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// One rung: the model with one effect more than the rung below.
struct LadderStep {
  std::optional<std::size_t> added;     ///< candidate; none for the base law
  bool by_level = false;                ///< it was added for the levels of break-away alone
  Trial trial;                          ///< at full resolution
  Trial coarse;                         ///< the same at low resolution
  std::vector<Probe> probes;            ///< what free functions find beside it
  std::vector<std::size_t> equivalent;  ///< candidates that do as well
  std::vector<CandidateResult> judged;  ///< every candidate tried beside the model to which it was added
};

/// The model that was found, one effect after the other, all with its law.
struct Ladder {
  std::vector<LadderStep> steps;       ///< the base law first
  std::vector<Trial> rivals;           ///< of other laws with the same effects, which these data do not rule out
  std::vector<std::size_t> withdrawn;  ///< candidates that explain too little of what is wrong
  std::vector<CandidateResult> last;   ///< candidates judged beside the last rung: none of them passes
  bool out_of_time = false;            ///< the time was over before that could be said
  const Trial& top() const { return steps.back().trial; }
};

/// Where structure is left that no effect explains, a name that was given to a smaller part of the error while a free
/// function of one variable explained far more is probably wrong: it is withdrawn, with those that stand on it. Not
/// where the effects above it have explained nearly all of that after all. Nor does a name stand for less than what is
/// left where friction swings as a whole: a load that moves makes another law of any. swinging: squares that are left
/// there, with the scatter of break-away; 0: it does not swing.
void withdraw(Ladder& ladder, double swinging);

/// How long and how high.
struct ClimbLimits {
  int most_effects = 4;
  std::optional<std::chrono::steady_clock::time_point> until = {};  ///< the ladder then stands where it is
};

/// Laws that compete: the one that was chosen, or every law of the list on which the effects can act.
std::vector<Law> competing_laws(const std::vector<Law>& given, std::span<const Effect> effects);

/// Finds the law and the effects by steps. At each of them every law is fitted with the effects that were found so far,
/// and the candidates of the step are every effect beside every law, and pairs of effects that hide each other: what
/// predicts held-out cycles best is taken, if it is named by the rule of evidence (see compare()) beside its own law
/// and no law without it does as well. So the law is chosen anew with every effect. At the end an effect is dropped
/// without which some law does as well, and each is compared once more with those that came near it.
/// from_the_start: effects that stand beside each law in every model. progress: may be empty.
Ladder climb(const DiagnosisContext& context, const std::vector<Law>& laws,
             const std::vector<Candidate>& from_the_start, const std::vector<Candidate>& candidates,
             const Limits& least, const ClimbLimits& limits,
             const std::function<void(std::string_view, double)>& progress = {});

}  // namespace tribofit::diagnosis
