#pragma once

#include <string>
#include <vector>

#include "rate_state_search.hpp"

namespace tribofit::fit {

/// Everything that one law leaves of the steps together.
struct LawFit {
  StateEvolution evolution = StateEvolution::ageing;
  RateStateSolution solution;
  RateStateFit fit;
};

/// All steps of a record described together with a number of states, by each law.
struct StepsTogether {
  std::size_t states = 1;
  RateStateData data;  ///< with its steps where they were found to be
  RateStateUnknowns unknowns;
  Detrend detrend = Detrend::none;
  std::vector<LawFit> laws;
  std::size_t best = 0;               ///< in `laws`
  std::vector<std::size_t> at_limit;  ///< steps whose times end at the limit of what is known of them
  std::vector<std::string> messages;

  const LawFit& best_law() const { return laws[best]; }
  bool fitted() const { return best_law().fit.converged; }
  std::vector<std::size_t> all() const;
  RateStateProblem problem(std::size_t law) const { return {data, laws[law].evolution, states, detrend, all()}; }
};

/// The line that is taken off each step is the one that leaves less, steps are moved to where friction answers them
/// where their times are not known, or where a recorded displacement turns elsewhere beyond chance, and both laws are
/// fitted.
StepsTogether fit_together(const RateStateData& data, LoadPointSource source, const RateStateOptions& options,
                           std::size_t states);

/// Nominal chance that what `fewer` leaves more than `more` is noise, by the likelihood with the noise of `more` and as
/// many values as `more` has fitted beyond it; NaN where it cannot be computed.
double p_value_of_more(const RateStateProblem& fewer, const RateStateSolution& fewer_solution,
                       const RateStateProblem& more, const RateStateSolution& more_solution, const RateStateFit& fit,
                       std::size_t values);

}  // namespace tribofit::fit
