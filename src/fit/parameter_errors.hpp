#pragma once

#include <optional>
#include <vector>

#include "change_point.hpp"
#include "estimate.hpp"
#include "influence.hpp"

namespace tribofit {

/// Which parameters the data determine where a fit ended.
struct Freedom {
  std::vector<bool> unconstrained;               ///< no residual depends on it
  std::vector<bool> free;                        ///< determined, and not held
  std::vector<bool> inside;                      ///< free, and not on a bound
  std::vector<std::vector<std::size_t>> groups;  ///< of which only combinations are determined, see undetermined()
  /// A change point is known far better than what depends on it smoothly, or not by a derivative: held for the others.
  std::optional<ChangePoint> change;
};
Freedom freedom_of(const FitContext& context, const std::vector<double>& p, const NormalEquations& equations);

/// Sets the parameters of a fit with their statistical errors, from the influence of each cycle.
void fill_parameters(const FitContext& context, const Solution& solution, const NormalEquations& equations,
                     const Freedom& freedom, Fit& fit);

}  // namespace tribofit
