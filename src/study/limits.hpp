#pragma once

#include <cstddef>

// The thresholds by which studies decide, with their reasons and what moves when they change.

namespace tribofit {

// ---- what a motion settles to

/// A slip that lasts longer ends in no stick [natural periods]: a bare law's ends within one and a half, effects with
/// memory prolong it. Shorter: machines near their critical speed count as not sticking.
inline constexpr double kLongestSlip = 2.5;

/// Damping ratio above which motions are not studied: the block creeps for as many natural periods, by steps as many
/// times shorter. No dry contact has a hundredth of it. Larger: a study of 10 s takes minutes.
inline constexpr double kMostDampingRatio = 100;

/// Swings below so many roundings of the displacement are rounding.
inline constexpr double kRoundings = 256;

/// Sliding has become steady after so many times in which deviations fall by e.
inline constexpr double kTimesToRest = 5;

/// Swings die out where they shrink below the first of these parts of the largest; below the second they need not
/// shrink any more, as that may be rounding.
inline constexpr double kSmallSwing = 0.05, kGoneSwing = 1e-3;

/// Swings are those of a steady vibration where they change by less than this part of the tolerance: those that grow
/// from an unstable cycle change slowly at first.
inline constexpr double kSteadySwing = 1e-2;

/// Cycles that shrink by more than this each are dying.
inline constexpr double kShrinks = 1e-4;

/// Longest cycles after which a motion that still sticks keeps sticking, and the change of a swing that is rounding.
inline constexpr double kCyclesThatStick = 4, kSameSwing = 1e-9;

// ---- the smoothed law

/// Rounding of v_r in a stick, in parts of the break-away coefficient, that a smoothed law may turn into friction: at
/// 7e-9 periods are right to 1e-8, at 7e-8 wrong by 1e-4.
inline constexpr double kMostRounding = 2e-8;

/// Share of the longest step with which the solver begins; the error control finds its own from there.
inline constexpr double kFirstStep = 1e-6;

// ---- the critical speed

/// Speeds in equal ratios among which stick and stability are looked for. Fewer: a second change between two of them is
/// missed.
inline constexpr int kSpeedsOfStick = 60, kSpeedsOfStability = 400;

/// The highest speed is raised in these steps, to this multiple of the machine's own, until sliding is stable.
inline constexpr double kSpeedStep = 1.5, kMostSpeed = 1000;

/// Where stability is lost nothing grows nor shrinks: motions begin this part below.
inline constexpr double kBelowTheLoss = 1e-3;

/// Periods that show whether a swing grows.
inline constexpr double kPeriodsOfGrowth = 6;

/// Speeds beyond this factor are far: machines drawn within the uncertainty have critical speeds within it, and a speed
/// of stability is drawn up to this multiple of that at which stick vanishes. Larger: an empty picture.
inline constexpr double kFarSpeed = 3;

// ---- uncertainty

/// Draws for each machine until one can be.
inline constexpr std::size_t kMostTries = 100;

/// Draws without an answer beyond this part leave no interval: 2.5 % at either end could be among them.
inline constexpr double kMostMissing = 0.1;

// ---- portraits

/// Cycles drawn in all, of some 1000 samples each: a gigabyte of memory.
inline constexpr std::size_t kMostDrawnCycles = 20000;

// ---- the twin

/// Fewest simulations that show a spread, and the samples over all of them: a minute of work.
inline constexpr std::size_t kFewestSimulations = 8;
inline constexpr double kMostSimulatedSamples = 4e7;

/// Greatest correlation taken for that of break-away from cycle to cycle, and of noise from sample to sample: closer to
/// one a simulation would have to be far longer than the record to show its spread.
inline constexpr double kMostScatterCorrelation = 0.9, kMostNoiseCorrelation = 0.97;

/// Points a natural period on which recorded load, temperature and disc speed are followed: what is faster is noise.
inline constexpr double kConditionsAPeriod = 50;

/// Cycles that show a correlation of break-away.
inline constexpr std::size_t kFewestLevels = 10;

// ---- the plan

/// Samples of a slip that are simulated for a plan: the diagnosis takes means over as many, or fewer, and compares
/// effects that come near each other over as many. Of runs that take more samples than this a part of them.
inline constexpr std::size_t kSamplesOfSlip = 400;
inline constexpr double kSimulatedSamples = 2e5, kLeastPartOfRate = 0.4;

/// Relative local error of these simulations: far below what any sensor adds. Smaller ones cost steps: by the order of
/// the method four times as many at the usual 1e-10.
inline constexpr double kPlannedTolerance = 1e-7;

/// By which the evidence between two models is weakened before it counts as odds, since none is exact: of 189 simulated
/// records that leave a group open the mean logarithm of the probability of the truth is -0.66 with 2 (-0.72 with 1.4,
/// -0.82 with 1, -0.66 with 4), of 113 others -0.71 (-0.70, -0.71, -0.78). And the difference from which a model is out
/// of the question.
inline constexpr double kTemper = 2, kMostBehind = 60;

/// Values by which drawn machines are judged, over all slips and, at the least, of one: means over fewer move a contact
/// that creeps. Rounds of the walkers until they have forgotten where they began (a flat valley takes some dozens), and
/// of which they are kept.
inline constexpr std::size_t kValuesOfPlausible = 16000, kFewestOfSlip = 60;
inline constexpr std::size_t kRoundsToForget = 60, kRoundsOfDraws = 30;

/// Logarithm of the likelihood below its maximum within which a walker begins, and the curvature, over that of the
/// steepest direction, below which a valley counts as flat: the walkers find its length.
inline constexpr double kFarthestStart = 8, kFlattestStart = 1e-3;

/// Odds, before the p-value, that an effect is there rather than nothing: a choice. Of the eight records of other rigs
/// in data/validation/real-rigs.md seven are described by no law alone, so that even odds are not even; what the record
/// lacks may still be a look-alike, which a full diagnosis of simulated runs counts. Larger: plans for an effect that
/// is not there promise too much.
inline constexpr double kOddsOfSomething = 4;

/// Cycles of a run: fewer show their scatter badly, more take time to diagnose and show little that is new.
inline constexpr double kFewestPlannedCycles = 40, kMostPlannedCycles = 120;

/// Revolutions of the disc where a question is about what comes back with its angle, or goes on over time.
inline constexpr double kPlannedRevolutions = 4;

/// Speeds of the disc beside the record's own, where nothing is stated.
inline constexpr double kUsualSpeeds[] = {0.25, 0.5, 2, 4};

/// Of the gain that an accelerometer shows: standard uncertainty of its calibration.
inline constexpr double kErrorOfAccelerometer = 0.01;

/// Conditions closer than this to those of the record are the same.
inline constexpr double kSameAsRecord = 0.05;

/// What a minute of measuring must add to the probability: a preference of people and no statistic, ten points for ten
/// minutes.
inline constexpr double kCostOfMinute = 0.01;

/// Below this probability so far a model is not simulated as the true one: it would hardly change the mean.
inline constexpr double kLeastLikely = 0.02;

/// Draws of each model for the expected difference of those that may be the best (the theory of its spread counts for
/// as many) and for full diagnoses. In groups of lag, filter and delay draws spread as the theory says; the chance of
/// one draw alone is then wrong by 10 to 30 points where it is a few percent.
inline constexpr std::size_t kDrawsOfModel = 4;

/// Experiments that are drawn again, or diagnosed in full until the best of all is one of them, and of which it is said
/// what is to be seen.
inline constexpr std::size_t kBestExperiments = 4;

/// By which runs are made longer than those that were simulated first, up to so many cycles of all records (and of the
/// runs that are simulated first): more take seconds to judge.
inline constexpr double kLongerRuns[] = {1.5, 2, 3, 4, 6, 8, 12};
inline constexpr double kMostSimulatedCycles = 400;

/// Experiments that are diagnosed in full in any case, and the weight of the expected chance beside them, in diagnoses.
/// Small: the expected chance knows the models in question alone, a diagnosis the whole catalogue. Of a run at 8 rpm
/// that should distinguish a lag from a filter with 1.0, none of four diagnoses named the lag alone.
inline constexpr std::size_t kExperimentsInFull = 2;
inline constexpr double kWeightOfExpected = 1;

/// How often a run names the true effect alone that was expected not to, and does not that was expected to, whatever
/// its chance: the draws know neither the whole catalogue nor how wrong they are themselves. So are the guesses and
/// lapses of an observer counted in psychometrics (F. A. Wichmann, N. J. Hill, Percept. Psychophys. 63 (2001) 1293,
/// doi:10.3758/bf03194544). Of 832 and 871 runs of two lots of simulated investigations they were 0.03 and 0.03, 0.10
/// and 0.05; between them expected chances came true as they were, which the slope of a logistic calibration (0.57),
/// drawn flat by the surest, had made too low from 30 to 80 %.
inline constexpr double kGuesses = 0.03, kLapses = 0.07;

/// Cycles, old and new, that are diagnosed in full for an experiment; a core diagnoses some hundred a second.
inline constexpr double kMostDiagnosedCycles = 750;

/// A draw with so many times the cycles that are expected is not diagnosed: one of 1,621 cycles, where 390 were
/// expected, took 38 s, the others 2 s each.
inline constexpr double kTimesTheCycles = 2;

/// Uncertainties of what a hand reads off a tap: where edges of two channels lie [s], beside a part of a sample, and
/// how slow an edge is, in parts of its time. Smaller: a tap is thought to distinguish what nobody reads off it.
inline constexpr double kReadingOfEdge = 0.02e-3, kPartOfSample = 0.3, kReadingOfSlope = 0.25;

/// Of the zero of a force sensor, in parts of the median friction: as zeros wander while the block is lifted; and in
/// parts of the noise of a sample, as of the mean of a hundred.
inline constexpr double kReadingOfZero = 2e-3, kNoiseOfZero = 0.1;

/// Draws of each model for the ranges of what is seen.
inline constexpr std::size_t kDrawsToSee = 6;

}  // namespace tribofit
