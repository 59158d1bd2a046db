#pragma once

#include "rate_state_search.hpp"

namespace tribofit::fit {

/// A change of the load point's speed at a step: at its time or, of a hold, where it goes on. A drive that passes from
/// one speed to the other passes as it does, whenever that is: its phases move together.
struct Turn {
  std::size_t step = 0, first = 0, last = 0;  ///< phases that begin there
  bool ends_hold = false;
};

/// Those whose times are fitted: known within VelocityStep::slack alone.
std::vector<Turn> free_turns(const RateStateData& data);

/// Change of the simulated friction at the values of a problem with the time of a turn [1/s], by a difference; the rows
/// of other steps are zero. Empty where sliding runs away.
Eigen::VectorXd response_by_time(const RateStateProblem& problem, const std::vector<double>& p, const Turn& turn);

struct MovedSteps {
  double largest = 0;                 ///< [s]
  std::vector<std::size_t> at_limit;  ///< steps that what is known of their times held
};

/// Moves the steps to the times at which the response fits best, within what is known of them (VelocityStep::slack) and
/// between their neighbours, and refines the solution: Gauss-Newton steps in the parameters and the times together.
MovedSteps refine_step_times(RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                             const RateStateUnknowns& unknowns, RateStateSolution& solution);

}  // namespace tribofit::fit
