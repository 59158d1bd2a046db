#pragma once

#include <optional>
#include <vector>

#include "rate_state_problem.hpp"

namespace tribofit::fit {

/// Holds and how the peak behind them grows with the time at rest; nothing where there are none.
std::optional<Healing> healing_of(const RateStateData& data, const RateStateProblem& problem,
                                  const std::vector<double>& p, const RateStateFit& fit);

}  // namespace tribofit::fit
