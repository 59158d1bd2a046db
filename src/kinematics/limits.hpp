#pragma once

#include <cstddef>

// The thresholds by which the motion decides, with their reasons and what moves when they change.

namespace tribofit::kinematics {

// ---- plateaus of stick

/// How far a stretch may be from the level, over the largest excursion. Wider: slow slips count as stick; narrower:
/// sticks of a ringing or sagging channel are lost.
inline constexpr double kPlateauBand = 0.12;
/// How far the middle of a plateau may stand out from its shoulders, over the band: a turning point of a smooth
/// oscillation is a parabola that stands out by more.
inline constexpr double kFlatness = 0.10;
/// Blocks of a plateau: a middle and its two shoulders need as many.
inline constexpr std::size_t kFewestBlocks = 4;
/// A plateau has settled, and agrees with what is stated, within this part of its level: what radius and speed are
/// known to.
inline constexpr double kSettled = 0.02;

/// Standard deviations of v_r within which its plateau is at zero, and the least where there is no noise, over the
/// largest excursion: what creep before break-away makes of a rest. Wider: the lowest speed of a programme is a stick.
inline constexpr double kRestNoise = 3, kRestDepth = 1e-3;
/// A plateau off zero is rest with a wrong zero, or with creep, where a spring loads it: plateaus that must show it,
/// and the rise of friction over them, over its range. In slow sliding friction stays or wanders.
inline constexpr std::size_t kFewestLoadings = 3;
inline constexpr double kLeastLoading = 0.3;

// ---- high-pass of the vibrometer

/// Fall of a plateau over its duration, 2 pi f_c t, over the level: below the first a high-pass does not matter and is
/// lost in what creep does; above the second no plateau is left.
inline constexpr double kLeastSag = 0.01, kLargestSag = 3;

/// Standard errors by which a high-pass or a ripple must be there. What is undone changes every sample, and levels of
/// plateaus wander more than their scatter shows.
inline constexpr double kSignificance = 6;

// ---- ripple of the disc

inline constexpr int kHighestOrder = 6;
/// Revolutions between the middles of the first and the last plateau, of two recorded ones: with fewer a drift looks
/// like a ripple.
inline constexpr double kFewestRevolutions = 1.95;
/// Plateaus in all, for at most six coefficients, and in a period of the ripple, so that it is not an alias.
inline constexpr std::size_t kFewestPlateaus = 12;
inline constexpr double kFewestPlateausAPeriod = 4;
/// Ripples over the mean speed: a smaller one does not matter to the friction, a larger one is no ripple.
inline constexpr double kLeastRipple = 0.005, kLargestRipple = 0.25;
/// Part of the variance of the levels that it explains: else something else moves them more.
inline constexpr double kLeastExplained = 0.5;

// ---- plateau over omega r

/// What sampling and the corner leave in the level of a restored plateau, over the level.
inline constexpr double kErrorAfterHighPass = 1e-3;
/// Standard error of the creep taken off, over the creep: a real contact rings, and mu_s is not known that well.
inline constexpr double kErrorOfCreep = 0.5;

}  // namespace tribofit::kinematics
