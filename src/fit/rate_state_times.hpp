#pragma once

#include "rate_state_search.hpp"

namespace tribofit::fit {

/// Whether the time of a step is fitted: known within VelocityStep::slack alone.
bool has_free_time(const VelocityStep& step);

/// Change of the simulated friction at the values of a problem with the time of one of its steps [1/s], by a
/// difference; the rows of the other steps are zero. Empty where sliding runs away.
Eigen::VectorXd response_by_time(const RateStateProblem& problem, const std::vector<double>& p, std::size_t step);

/// Moves the steps to the times at which the response fits best, within what is known of them (VelocityStep::slack),
/// and refines the solution: Gauss-Newton steps in the parameters and the times together. Largest move [s].
double refine_step_times(RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                         const RateStateUnknowns& unknowns, RateStateSolution& solution);

}  // namespace tribofit::fit
