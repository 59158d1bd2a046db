#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "evidence.hpp"
#include "probes.hpp"
#include "trial.hpp"

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

}  // namespace tribofit::diagnosis
