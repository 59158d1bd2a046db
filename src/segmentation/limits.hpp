#pragma once

#include <cstddef>

#include "kinematics/limits.hpp"

// The thresholds by which stick and slip are found, with their reasons. What rest is, is said in kinematics/limits.hpp.

namespace tribofit::segmentation {

/// Part of the typical peak below which contacts do not slide throughout: v_r passes through rest there, and friction
/// is not that of a law of speed. Larger: the slow end of a Stribeck curve is lost; smaller: presliding passes for it
/// (a positioning system of published friction then comes out with half of it).
inline constexpr double kReversalPart = 0.01;

// ---- slips

/// Parts of a record whose largest excursions make the typical peak, part of the largest from which one of them has a
/// slip, and the largest that may be outliers, one in so many at most.
inline constexpr std::size_t kPartsOfRecord = 512, kOutlyingPeaks = 2, kPartsPerOutlier = 8;
inline constexpr double kHasSlip = 0.2;
/// Standard deviations of the noise, and of the typical peak at most and at least, from which a slip is one (the first
/// and the last are kinematics' kSlipsOverError and kSlipsOverFastest) and down to which it lasts. Larger: slips lose
/// their ends; smaller: noise divides them.
inline constexpr double kSlipAtMost = 0.15, kStickOverError = 5, kStickAtMost = 0.075, kStickOverPeak = 0.03;
/// Rounding of omega r - v_b, over the fastest of both: no motion. And of a level squared, as a variance.
inline constexpr double kRoundingPart = 1e-12;
/// Of the typical peak, from which a slip shows how long slips last; below which one that lasts less than the next
/// of that time is ringing after a re-stick, or may be where it begins the record. Samples of a spike, where it lasts
/// less than the last of that time.
inline constexpr double kShowsDuration = 0.4, kChatterPeak = 0.2, kChatterTime = 0.35;
inline constexpr double kSpikeSamples = 3, kSpikeTime = 0.1;
/// Samples between two slips in opposite directions that show whether v_r stays or passes: a third at either end.
inline constexpr std::size_t kShortestTurn = 6;
/// Standard deviations of a distance (white noise of v_r, added up) beyond which a motion has turned: coloured noise
/// adds up to several times as much. Larger: short strokes pass for none; smaller: noise begins strokes.
inline constexpr double kTurnOverNoise = 10;

// ---- sticks

/// Samples of a stick: one or two are where the velocity turns near zero. Of so many its shape shows, and it rests
/// where its ends, without these parts, are at the level of its middle.
inline constexpr std::size_t kShortestStick = 3, kShortestShape = 10;
inline constexpr double kEndsOfStick = 0.1, kMiddleOfStick = 0.3;
/// Samples of a slide whose speed a drive keeps, and its quartiles at the most apart, over its median (0.77 for half a
/// sine, 0.07 for a noise of 5 %). Larger: slips of a block on a spring pass for driven; smaller: noisy drives do not.
inline constexpr std::size_t kShortestSlide = 50;
inline constexpr double kKeptSpeed = 0.3;
/// Part of all sliding from which on slides at a kept speed make a record one of sliding, where it has too few
/// break-aways for cycles: less may be a slip that was clipped.
inline constexpr double kDrivenPart = 0.25;
/// Samples of a mean, and such means in a row, that make a rest within sliding.
inline constexpr std::size_t kRestOver = 16, kFewestRests = 2;
/// Cycles that carry an analysis of cycles: a spread needs three, fewer leave no degree of freedom beside a mean and
/// its trend. Samples of a slip that show a curve.
inline constexpr std::size_t kFewestCycles = 3, kShortestSlip = 4;

// ---- break-away

/// Doublings of the velocity before a slip, at the pace of the last, before which a stick shows its own level:
/// break-away is four to five before.
inline constexpr std::size_t kDoublings = 6;
/// Part of the level in the third quarter of a stick that is there in the second: growth doubles several times between
/// them, creep does not.
inline constexpr double kAlreadyThere = 0.5;
/// Samples of a stick that shows its own level, and of a quarter of it; a stick whose growth takes more than such a
/// part of it creeps.
inline constexpr std::size_t kShowsLevel = 32, kShortestQuarter = 4;
/// Standard deviations of the noise from which a velocity is clear of it.
inline constexpr double kClearOfNoise = 25;
/// Of the typical peak, and what clear of the noise reaches at most, up to which growth is fitted: it is exponential
/// there.
inline constexpr double kGrowthOverPeak = 0.01, kGrowthAtMost = 0.03;
/// Levels between which the time constant of growth is taken, over one another; time constants before the level that
/// are fitted, and their fewest and most samples.
inline constexpr double kGrowthRatio = 3, kTimeConstants = 8, kShortestGrowth = 4, kLongestGrowth = 4000;
/// Rises that are fitted together: more do not move the rate.
inline constexpr std::size_t kMostPooled = 96;
/// What one leaves over the median, from which a blow or a step of the disc's speed is in it (noise makes 3), and rises
/// to one such at least: more are no exceptions.
inline constexpr double kForeignRise = 10;
inline constexpr std::size_t kRisesPerForeign = 8;
/// Slowest disc over the others whose pull is taken as it is: where it stands still something else moves the block.
inline constexpr double kSlowestPull = 0.05;
/// Variances of the noise that a jump must explain, part of the squares that it may leave, and where its search begins,
/// over the level.
inline constexpr double kJumpExplains = 40, kJumpLeaves = 0.9, kFirstJump = 0.1;
/// Break-aways with a known friction from which its spread is one; most that friction at one is taken to be above the
/// others, as a part of it; and most by which log lambda differs: beyond them something else happened.
inline constexpr std::size_t kFewestLevels = 8;
inline constexpr double kMostExcess = 0.5, kMostFaster = 2;
/// Growth over the slip, from which a contact creeps: it has no sharp onset.
inline constexpr double kGradual = 0.3;
/// Samples before the level from which a break-away shows, and of the level, where the velocity leaves the stick where
/// none does.
inline constexpr double kShowsGrowth = 0.5, kLeavesStick = 0.25;
/// Variance of one of which a single sample shows the growth [samples, squared]: it is anywhere between two. Of more
/// samples it is within as much smaller a part, of a dozen at the most. Where so many do not, one may be before it or
/// after: within so many standard errors, and one sample.
inline constexpr double kBetweenSamples = 1.0 / 12, kFewShowGrowth = 4, kBeforeOrAfter = 2;

// ---- re-stick

/// Standard deviations of the noise, and of the typical peak at most, down to which v_r comes to rest; what clear of
/// the noise reaches at most, and the least, from which the end of a slip is a straight line; and samples after the
/// slip among which it is.
inline constexpr double kRestickNoise = 4, kRestickAtMost = 0.02;
inline constexpr double kEndAtMost = 0.06, kEndAtLeast = 0.02;
inline constexpr std::size_t kRestickWithin = 64;

// ---- friction at break-away

/// Samples that show a line of their own beside others, or whether it is bent; a stick of twice as many has them in its
/// second half. Fewest of a line; standard errors of its curvature from which it is a parabola. Correlation of
/// neighbours that sticks are long enough to show.
inline constexpr std::size_t kShowsLine = 20, kShortestLine = 3;
inline constexpr double kClearCurvature = 5, kMostCorrelation = 0.98;

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
/// Points without which no law has a value to spare.
inline constexpr std::size_t kFewestPoints = 5;
/// Slips from which the long-run variance of their mean is known; of fewer their scatter says more.
inline constexpr std::size_t kManySlips = 30;

// ---- the pull of the disc

/// Speed of the disc over that at the end of a stick, below which it loaded the spring along another line.
inline constexpr double kSlowerPull = 0.5;
/// Cycles from which the coupling of load and friction is known beside how it scatters.
inline constexpr std::size_t kFewestCoupledCycles = 12;

// ---- levels of friction in slip

/// Bins of the speed in which slips are compared, slips in a bin, and slips in all: three levels need some of each.
inline constexpr std::size_t kLevelBins = 6, kFewestSlipsOfBin = 3, kFewestForLevels = 8;

}  // namespace tribofit::segmentation
