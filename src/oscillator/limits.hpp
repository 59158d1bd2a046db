#pragma once

#include <cstddef>

// The limits of the simulation, with their reasons and what moves when they change.

namespace tribofit {

/// Steps of the solver after which a simulation is given up: a first allowance and one a natural period, which needs a
/// few hundred, 1e4 with the stiffest bristles.
inline constexpr double kFirstSteps = 5e5, kStepsAPeriod = 2e4;

/// And in all: some minutes of work. More: nobody waits for the end.
inline constexpr double kMostSteps = 1e9;

/// Iterations in which friction and the acceleration that it makes must agree.
inline constexpr int kMostIterations = 50;

}  // namespace tribofit
