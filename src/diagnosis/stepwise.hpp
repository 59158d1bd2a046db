#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "ladder.hpp"
#include "tribofit/diagnosis/diagnosis.hpp"

namespace tribofit::diagnosis {

/// How long and how high.
struct ClimbLimits {
  int most_effects = 4;
  std::optional<std::chrono::steady_clock::time_point> until = {};  ///< the ladder then stands where it is
};

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
