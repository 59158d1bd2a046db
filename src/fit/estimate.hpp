#pragma once

#include <optional>
#include <vector>

#include "fit_context.hpp"
#include "published.hpp"

namespace tribofit {

/// The values that a protocol finds.
struct Solution {
  SolverResult result;
  std::vector<double> start;                ///< of the first search
  CycleExtremes extremes;                   ///< by per-cycle extremes only
  bool has_levels = true;                   ///< false: the extremes of too few cycles are known
  std::optional<ModelResiduals> residuals;  ///< of all slips with the whitening of the context, where they are known
  const std::vector<double>& values() const { return result.p; }
};

/// Finds the parameters by the protocol of the context. Sets its whitening, and holds in its bounds what the protocol
/// holds. What a person should know goes to `fit`.
Solution estimate(FitContext& context, Fit& fit);

}  // namespace tribofit
