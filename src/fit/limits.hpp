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

/// Degrees of freedom below which a variance of its own for each point says too little of a parameter: its interval
/// would be a quarter wider than with one variance for all, which a standard error of each point serves better.
inline constexpr double kFewestFreeVariances = 5;

/// Whether noise is 1/f noise shows over stretches so much shorter: a quarter of 200 samples is beyond the memory of an
/// amplifier that follows within ten, and leaves two octaves.
inline constexpr std::size_t kShorterNoiseStretch = 4;
/// An octave between the two; with less, as in short sticks, a growth is what few stretches make of white noise.
inline constexpr double kLeastStretchRatio = 2;

/// A parabola over a stretch takes away what is slower than a third of it.
inline constexpr double kPartBesideParabola = 1.0 / 3;

/// Levels by which 1/f noise is distinguished from what a wrong model leaves: with 600 it is in four of five records,
/// with 60 in hardly any; more only cost time.
inline constexpr std::size_t kEnoughLevels = 2000;

/// Periods in a slip from which a steady line and a ring are looked for. A line with less than half of one moves slips
/// as a whole, as 1/f noise does: with fewer one is named in empty records with such noise. A ring with fewer than six
/// is not distinguished from the shape of the law.
inline constexpr double kFewestPeriodsOfLine = 0.5, kFewestPeriodsOfRing = 6;

// ---- how good a fit is

/// Held-out error over the noise floor up to which what remains is called noise: noise floors are known to some per
/// cent, and every parameter costs a little on held-out cycles. Lower: true laws of short records count as lacking
/// something.
inline constexpr double kAtFloor = 1.15;
/// The same ratio from which a fit is well above the noise floor, so that means that agree may hide what it misses, and
/// from which it says no more than "far above".
inline constexpr double kWellAbove = 1.25, kFarAboveFloor = 100;

/// Held-out error over that of the fitted cycles from which a model has learnt its cycles by heart.
inline constexpr double kLearntByHeart = 1.5;

/// Mean relative errors that count as close, and as an outline only ([D] calls 8 % good).
inline constexpr double kClose = 0.02, kOutline = 0.08;

/// p value from which one law is clearly better than another.
inline constexpr double kClearlyBetter = 0.05;

/// Of the standard deviation of the weights by which a slider's velocity is smoothed, as standard uncertainty of its
/// break-away: in simulated sliders (three springs, three speeds, 12 and 19 bits) it is 0.3 early to 0.8 late.
inline constexpr double kPartOfSmoothing = 0.5;

}  // namespace tribofit
