#pragma once

#include <vector>

#include "rate_state_search.hpp"

namespace tribofit::fit {

/// Makes a fit of a solution: errors, intervals, mu_0 and trend of each step, stability.
RateStateFit fit_from(const RateStateProblem& problem, const RateStateUnknowns& unknowns,
                      const RateStateSolution& solution);

/// Nominal chance that noise alone, as the fit has it, does what the fitted answer to the steps does; NaN where it
/// cannot be computed, or where what is left is no noise: a law that fails is no answer that is missing.
double p_value_of_no_answer(const RateStateProblem& problem, const RateStateSolution& solution,
                            const RateStateFit& fit);

/// By how much the logarithm of the likelihood of what the other solution leaves is below that of the best, with the
/// noise of the fit made of the best; NaN where it cannot be computed.
double log_likelihood_below(const RateStateProblem& best, const RateStateSolution& best_solution,
                            const RateStateProblem& other, const RateStateSolution& other_solution,
                            const RateStateFit& fit);

/// a - b, and whether sliding is stable on this machine, from the values and their covariance.
void set_stability(const std::vector<double>& p, double freedom, RateStateFit& fit);
void set_correlations(RateStateFit& fit);

/// What a person is told of it.
void add_messages(RateStateFit& fit);

}  // namespace tribofit::fit
