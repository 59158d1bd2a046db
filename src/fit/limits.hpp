#pragma once

#include <cstddef>

// The thresholds by which fits decide, with their reasons.

namespace tribofit {

/// A spread from cycle to cycle needs three of them: fewer leave no degree of freedom beside a mean and its trend.
inline constexpr std::size_t kFewestCycles = 3;

/// Noise is taken about parabolas: over 200 samples at most, which even a ramp that creeps, or sliding at a speed that
/// is swept, is close to, and over a quarter of a slip. 12 leave three quarters of their degrees of freedom beside the
/// parabola.
inline constexpr std::size_t kShortestNoiseStretch = 12, kLongestNoiseStretch = 200;

/// Levels by which 1/f noise is distinguished from what a wrong model leaves: with 600 it is in four of five records,
/// with 60 in hardly any; more only cost time.
inline constexpr std::size_t kEnoughLevels = 2000;

}  // namespace tribofit
