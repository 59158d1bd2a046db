#pragma once

#include <cstddef>

// The limits of the simulation, with their reasons and what moves when they change.

namespace tribofit {

/// Rounding of v_r in a stick, in parts of the break-away coefficient, that a smoothed law may turn into friction: at
/// 7e-9 periods are right to 1e-8, at 7e-8 wrong by 1e-4.
inline constexpr double kMostRounding = 2e-8;

/// Steps of the stiff solver after which a simulation is given up: a first allowance and one a natural period, which
/// needs some 400, ten times that at a tolerance of 1e-13.
inline constexpr double kFirstStiffSteps = 1e5, kStiffStepsAPeriod = 2e4;

/// The same of the explicit solver, which needs a few hundred steps a natural period, 1e4 with the stiffest bristles.
inline constexpr double kFirstSteps = 5e5, kStepsAPeriod = 2e4;

/// And in all: some minutes of work. More: nobody waits for the end.
inline constexpr double kMostSteps = 1e9;

/// Iterations in which friction and the acceleration that it makes must agree.
inline constexpr int kMostIterations = 50;

}  // namespace tribofit
