#pragma once

#include <optional>
#include <vector>

#include "judging.hpp"
#include "trial.hpp"

namespace tribofit::diagnosis {

/// Two effects neither of which shows beside the model so far, since each leaves the other as what looks like slow
/// noise. Each is judged beside the other, with the correction for every pair that was tried.
struct HiddenPair {
  CandidateResult first, second;  ///< each beside the other; the one that explains more alone is first
  CandidateResult alone;          ///< the first beside the model so far
};

/// top, coarse_top: the model so far at both resolutions; judged: every candidate beside it; least_size: of those that
/// are tried.
std::optional<HiddenPair> find_hidden_pair(const DiagnosisContext& context, const Trial& top, const Trial& coarse_top,
                                           const std::vector<CandidateResult>& judged, double least_size,
                                           const std::vector<Candidate>& candidates, const Limits& least);

}  // namespace tribofit::diagnosis
