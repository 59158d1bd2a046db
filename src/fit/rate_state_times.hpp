#pragma once

#include "rate_state_search.hpp"

namespace tribofit::fit {

/// Moves the steps to the times at which the response fits best, within what is known of them (VelocityStep::slack),
/// and refines the solution: Gauss-Newton steps in the parameters and the times together. Largest move [s].
double refine_step_times(RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                         const RateStateUnknowns& unknowns, RateStateSolution& solution);

}  // namespace tribofit::fit
