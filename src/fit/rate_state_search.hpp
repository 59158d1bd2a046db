#pragma once

#include <string>
#include <vector>

#include "rate_state_problem.hpp"

namespace tribofit::fit {

/// The unknowns of a search: names, units, bounds and where they begin, as a person sees them and as they are searched.
struct RateStateUnknowns {
  std::vector<Parameter> parameters;  ///< a, b, D_c (, b_2, D_c2), k
  std::vector<bool> logarithmic;      ///< searched by its logarithm
  std::vector<double> lower, upper;   ///< of what is searched
  std::vector<std::vector<double>> starts;
  bool states_alike = true;  ///< two of them differ by name alone: D_c is the shorter distance

  double value(std::size_t k, double searched) const;  ///< SI
  double searched(std::size_t k, double value) const;
};

/// Bounds in the scales of the record, and starts from what friction does at its steps: the size of the peak behind a
/// step, what is left of it, and over which displacement it comes and goes. Values given by the user come first.
RateStateUnknowns unknowns_of(const RateStateData& data, std::size_t states, const std::vector<GivenParameter>& given);

/// The best of several descents on few values, refined on all of them.
struct RateStateSolution {
  std::vector<double> p;
  double cost = 0;  ///< half the sum of weighted squares
  bool found = false;
  std::string message;
};
RateStateSolution search(const RateStateData& data, StateEvolution evolution, std::size_t states, Detrend detrend,
                         const std::vector<std::size_t>& steps, const RateStateUnknowns& unknowns);

/// The same of several steps; where what they leave is far above what the first of them leaves by itself, also from its
/// values on, with one step more at a time.
RateStateSolution search_together(const RateStateData& data, StateEvolution evolution, std::size_t states,
                                  Detrend detrend, const std::vector<std::size_t>& steps,
                                  const RateStateUnknowns& unknowns);

/// Descent from values that are nearly right.
RateStateSolution refine(const RateStateProblem& problem, const std::vector<double>& start,
                         const RateStateUnknowns& unknowns);

}  // namespace tribofit::fit
