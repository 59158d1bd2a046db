#pragma once

// The thresholds by which stick and slip are found, with their reasons. What rest is, is said in kinematics/limits.hpp.

namespace tribofit::segmentation {

/// Part of the typical peak below which contacts do not slide throughout: v_r passes through rest there, and friction
/// is not that of a law of speed. Larger: the slow end of a Stribeck curve is lost; smaller: presliding passes for it
/// (a positioning system of published friction then comes out with half of it).
inline constexpr double kReversalPart = 0.01;

// ---- break-away

/// Doublings of the velocity before a slip, at the pace of the last, before which a stick shows its own level:
/// break-away is four to five before.
inline constexpr std::size_t kDoublings = 6;
/// Part of the level in the third quarter of a stick that is there in the second: growth doubles several times between
/// them, creep does not.
inline constexpr double kAlreadyThere = 0.5;

// ---- a block at one speed

/// Width of the velocity, over its noise (both ends of noise that is a little coloured) and over the speed, up to which
/// a block slides at one speed: beyond, friction may follow it.
inline constexpr double kWidthOfNoise = 8, kOneSpeed = 0.05;

// ---- friction alone

/// Standard deviations of the noise, and part of the range of friction, from which a fall is one: noise that wanders
/// makes falls of a few standard deviations, and the steps of one slip are a tenth of it. Larger: small slips between
/// large ones are lost.
inline constexpr double kFallOverNoise = 10, kFallOverRange = 0.1;
/// Time of a slip over that of the rise before it, at the most: of what only wanders or swings both are alike.
inline constexpr double kQuickFall = 0.5;
/// Part of the samples with the rarer sign, from which friction goes in both directions.
inline constexpr double kOtherDirection = 0.05;

// ---- friction from the motion

/// Of the peak, from which a slip shows the level of friction: below, smoothing rounds its turning points.
inline constexpr double kFasterPart = 0.3;
/// Part of the level by which those of small and of large swings may differ: smoothing, the stated mass and the stated
/// stiffness are no better. Smaller: they disagree where only these do.
inline constexpr double kAlikeLevels = 0.02;
/// Of the drive, RMS of the swing about it from which friction follows the swing and not the drive.
inline constexpr double kSwings = 0.1;

// ---- counts

/// Longest stick over the mean one, from which sticks are uneven: runout and ripple make them differ by less.
inline constexpr double kUnevenSticks = 3;
/// Samples without which there is nothing to segment, and points without which no law has a value to spare.
inline constexpr std::size_t kFewestSamples = 16, kFewestPoints = 5;
/// Slips from which the long-run variance of their mean is known; of fewer their scatter says more.
inline constexpr std::size_t kManySlips = 30;

// ---- the pull of the disc

/// Speed of the disc over that at the end of a stick, below which it loaded the spring along another line, and the
/// fewest samples that show a line.
inline constexpr double kSlowerPull = 0.5;
inline constexpr std::size_t kShortestPull = 20;
/// Cycles from which the coupling of load and friction is known beside how it scatters.
inline constexpr std::size_t kFewestCoupledCycles = 12;

// ---- levels of friction in slip

/// Bins of the speed in which slips are compared, slips in a bin, and slips in all: three levels need some of each.
inline constexpr std::size_t kLevelBins = 6, kFewestSlipsOfBin = 3, kFewestForLevels = 8;

}  // namespace tribofit::segmentation
