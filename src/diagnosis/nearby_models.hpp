#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "candidates.hpp"
#include "ladder.hpp"
#include "trial.hpp"

namespace tribofit::diagnosis {

/// The trial's model without one of its effects, fitted.
Trial try_without(const DiagnosisContext& context, const Level& level, const Trial& full, std::string_view key,
                  int threads = 1);

/// Another law with the effects of a trial, at low resolution; not usable where an effect cannot act on it. It is
/// searched for from the data, and from the levels of the other law.
Trial try_law(const DiagnosisContext& context, const Law& law, const Trial& known);

/// Whether a fitted law is what its name says.
enum class LawStanding {
  sound,
  doubtful,  ///< it rises with speed, or is on a bound, where laws become others
  another    ///< it rises from one of its two levels to the other, which is what constant and viscous friction say; or
             ///< it could not be fitted
};
LawStanding standing_of(const DiagnosisContext& context, const Trial& trial);

/// The effect of a term and those that explained nearly as much when it was added, each beside the model without it.
/// full: the model with it, at both resolutions.
std::vector<CandidateResult> judge_near(const DiagnosisContext& context, const LadderStep& term, const Trial& full,
                                        const Trial& coarse_full, const Trial& without,
                                        const std::vector<Candidate>& candidates, const Limits& least);

/// Laws that compete: the one that was chosen, or every law of the list on which the effects can act.
std::vector<Law> competing_laws(const std::vector<Law>& given, std::span<const Effect> effects);

}  // namespace tribofit::diagnosis
