#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evidence.hpp"
#include "trial.hpp"

namespace tribofit::diagnosis {

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
