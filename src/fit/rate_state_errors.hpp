#pragma once

#include <vector>

#include "rate_state_search.hpp"

namespace tribofit::fit {

/// Makes a fit of a solution: errors, intervals, mu_0 and trend of each step, stability.
RateStateFit fit_from(const RateStateProblem& problem, const RateStateData& data, const RateStateUnknowns& unknowns,
                      const RateStateSolution& solution, StateEvolution evolution, std::size_t states);

/// By how much the logarithm of the likelihood of what solution `p` leaves is below that of the fit, with the noise of
/// the fit; NaN where it cannot be computed.
double log_likelihood_below(const RateStateProblem& best, const RateStateSolution& best_solution,
                            const RateStateProblem& other, const RateStateSolution& other_solution,
                            const RateStateData& data, const RateStateFit& fit);

/// What a person is told of it.
void add_messages(RateStateFit& fit);

}  // namespace tribofit::fit
