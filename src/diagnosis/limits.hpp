#pragma once

#include <cstddef>

namespace tribofit::diagnosis {

/// What must be passed for a name.
struct Limits {
  double p_value = 0.01;     ///< goal: at most 1 % of false alarms, corrected for the number of candidates
  double least_size = 0.02;  ///< of the squares that sensor noise leaves: less does not show on any plot
};

/// Every threshold of the diagnosis, each with its reason. A larger value finds less and errs less, unless it says
/// otherwise. The benchmark of hidden effects (tests/recovery) measures what a change does.
namespace limits {

// Records.
inline constexpr std::size_t kFewestCycles = 12;  ///< two blocks of five and some to spare: fewer leave nothing to test
inline constexpr std::size_t kFineValues = 20000;  ///< in all slips: more do not move a verdict, and cost time
inline constexpr std::size_t kFewestFine = 80,
                             kMostFine = 400;  ///< a slip; a ring needs 80, the noise no more than 400
/// Values in all slips for those effects that come near each other, and the part of the fall of the best from which
/// they do: over means of half a millisecond a filter does better than the lag of 0.15 ms that made the record (80 s),
/// over single samples the lag is clearly ahead.
inline constexpr std::size_t kFinestValues = 400000;
inline constexpr double kContenderPart = 0.9;
/// Part of a stick at either end of which the noise of v_r is not taken: the block rings there, or breaks away.
inline constexpr double kEndOfStick = 1.0 / 6;
inline constexpr std::size_t kCoarseValues = 5000;                  ///< enough to see which candidate is hopeless
inline constexpr std::size_t kFewestCoarse = 16, kMostCoarse = 40;  ///< a slip; 16 still show both of its branches

// Blocks of cycles.
inline constexpr std::size_t kCyclesOfBlock = 5;                   ///< neighbours share slow scatter over about as many
inline constexpr std::size_t kFewestBlocks = 2, kMostBlocks = 10;  ///< ten: the usual compromise of cross-validation

// What excites an effect.
inline constexpr double kLeastLoadSpread = 0.03;      ///< of the load: a load that was meant to be constant varies less
inline constexpr double kLeastTemperatureSpread = 2;  ///< [K]: k_T within its bounds then moves mu by the noise
/// Within a record, over its noise and over its median: what changes less excites no memory. Noise alone spreads
/// by 3.3.
inline constexpr double kSpeedSigmas = 10, kLeastSpeedSpread = 0.02;
inline constexpr double kLeastStickRatio = 2.5;  ///< of stick times: its logarithm then spans what scatter does not
/// Distances since a reversal that are independent of one another, where a change is looked for: twenty a decade.
inline constexpr double kPlacesInStroke = 50;
inline constexpr std::size_t kFewestSticks = 6;  ///< for a spread over cycles

// Instruments and the plateau.
/// Standard uncertainties that are still possible, and the cost from which the data draw a parameter beyond its bound.
inline constexpr double kDeclaredSigmas = 3;
inline constexpr double kLeastGap = 0.004;  ///< of omega r: a pad is seldom set more closely, 0.06 mm at 15 mm
inline constexpr double kSameSetting =
    1e-3;                                ///< part by which radii or speeds differ that are one: a quarter of that gap
inline constexpr double kGapSigmas = 5;  ///< standard errors: plateaus of one record are not independent
inline constexpr double kLargestRatio = 2.5;  ///< or its inverse: a diameter for a radius is two; beyond, another fault
inline constexpr double kFallOfSag = 15;      ///< of chi-squared, by which a spin explains a sag: by chance once in 1e4
inline constexpr double kLeastCoupling = 0.01;  ///< kappa: a load that follows friction by less is left as it is

// Whether a candidate is plausible.
inline constexpr double kInside = 0.1;  ///< of its range a parameter is moved off its bound, to see what that costs
inline constexpr double kAwayFromNone = 0.5;  ///< of its range the size of an effect is from nothing when it fills it

// Whether a candidate passes.
inline constexpr double kLeastSizeOfLevel =
    0.15;  ///< a high break-away makes its own stick longer, and explains as much
inline constexpr std::ptrdiff_t kBreakAwaysOfStickSlip = 30;  ///< fewer: what goes with the stick time goes with time
inline constexpr double kCorrelated = 1.2;  ///< design effect from which cycles do not count as independent

/// Two models are distinguishable when their squares differ by more than chance would make them: with the right one
/// known the difference is d^2 -+ 2 d sqrt(noise) in units in which the noise of the difference is one; 40 is beyond
/// three standard deviations, with some room for the models themselves being approximations.
inline constexpr double kDistinguishable = 40;
inline constexpr double kDistinguishableSize = 0.003;  ///< and by this part of the squares of the noise
inline constexpr double kSizeOfParameter = 0.02;       ///< a longer ladder must earn as much for each parameter more

// What need not be fitted (a larger value saves time and may miss something).
inline constexpr double kWorthFitting = 0.5;    ///< of the least size: a linear step promises that much too little
inline constexpr double kWorthPart = 0.02;      ///< of what is wrong: small beside what is wrong for another reason
inline constexpr double kPutOffLine = 0.3;      ///< of the best fall: a line is as clear once that is out of the way
inline constexpr double kHopelessChance = 0.5;  ///< p-value at low resolution: full resolution does not mend it
inline constexpr double kFarPart = 0.08;        ///< of the best fall behind the best: resolution changes less
inline constexpr double kFarNoise = 0.05;       ///< and of the squares of the noise
/// Of the fastest slip: where a law that nothing holds at rest may fall; a factor of three is what a search bridges.
inline constexpr double kFallsWithin[] = {0.01, 0.03, 0.1, 0.3};
/// Candidates tried two at a time, ten pairs; the first is tried with all others: slow effects of which one shows only
/// beside another (drift beside a runout of few turns).
inline constexpr std::size_t kMostInPairs = 5;
inline constexpr std::size_t kMostPairsFitted = 4;  ///< linear steps rank pairs well, but not always the first ones
inline constexpr std::size_t kMostStarts = 2;       ///< the linear step ranks starts well, but not always the first two

// The ladder.
/// Of the fall of a rung: what the model below it gains as much from being fitted anew, was in a false minimum. Less
/// than half, so that the rest is judged beside the right one. Strictly lower each time, so that it ends.
inline constexpr double kLowerMinimum = 0.3;
inline constexpr double kRivalPart = 0.5;  ///< of the fall of the one chosen: less does not catch up
/// Two effects of the same variable may each explain half of what a free function finds there, but not much less.
inline constexpr double kHopelessPart = 0.35;
inline constexpr double kStraight = 0.5;  ///< of a rise still to come at the fastest slip: a straight line, not a law

// What is possible, though not proven.
/// p-value: one record in twenty would else be called unfinished, or unconfirmed, or show a share of its error.
inline constexpr double kChanceOfPossible = 0.05;
inline constexpr double kPossiblePart = 0.3;   ///< of what is above the noise: less does not change the picture
inline constexpr double kLeastPossible = 0.1;  ///< of the squares of the noise: less shows on no plot

/// p-value: what is not plausible takes more evidence than a name, and no slow noise passes for it.
inline constexpr double kChanceBeyondBounds = 0.001;

// What remains.
inline constexpr double kChance = 0.01;            ///< p-value below which structure is not chance
inline constexpr double kShareWorthNaming = 0.05;  ///< of the error above the noise floor; less helps nobody
/// A share that is "most of the error": what is found of it, a law of creep of what v_r shows in stick beyond its
/// noise. And part of the cycles from which on a filter that they show is one of all runs: one short run shows one
/// wrongly, and a few are too noisy to show it.
inline constexpr double kMostOfTheError = 0.5;
/// Of the squares of the noise: smaller structure does not matter. What sampling leaves (DiagnosisContext::shared) has
/// structure itself.
inline constexpr double kLeastStructure = 0.05;
inline constexpr std::size_t kPartsOfSlip =
    32;                                        ///< over which the slope of friction is taken: it turns twice in a slip
inline constexpr double kUnused = 1e-6;        ///< samples behind a value: one that takes no part has next to none
inline constexpr double kFarAboveFloor = 1.5;  ///< times the noise floor, from which an error is unexplained
/// The same once effects were added, whose scatter is in it, or where most of it wanders as slow noise does.
inline constexpr double kFarAboveAfterEffects = 2;
/// Runs that are diagnosed by themselves where all together are not described: more cost time and say little more.
inline constexpr std::size_t kMostSingleRuns = 8;
inline constexpr double kClearOfFloor = 2;     ///< standard errors of the held-out error, from which it is not chance
inline constexpr double kSwingsOfSlip = 0.35;  ///< a slip, seen in levels of slips: half is where they alias
inline constexpr double kSlowestLine = 15;     ///< slip times of a period: a line as slow is structure over time
inline constexpr int kHarmonicsOfAngle = 6;    ///< of a turn: a disc's faults are low ones, and more cost evidence
inline constexpr double kFormPart = 0.6;  ///< of what a free function explains, for a closed form to be worth offering

// ---- a load that was not recorded

/// Scatter of levels from which the load may move: less shows on few plots.
inline constexpr double kLeastSwing = 0.01;

}  // namespace limits

}  // namespace tribofit::diagnosis
