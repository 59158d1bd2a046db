#pragma once

#include <cstddef>

#include "ingest/limits.hpp"

// The thresholds by which the motion decides, with their reasons and what moves when they change.

namespace tribofit::kinematics {

/// Samples without which nothing shows, and cycles, slips or plateaus whose median leaves a wrong one out.
inline constexpr std::size_t kFewestSamples = 16, kFewestForMedian = 3;
/// Revolutions that an effect of the disc angle needs: what it does in one, a drift does too.
inline constexpr double kRevolutionsOfAngle = 2;

// ---- plateaus of stick
/// How far a stretch may be from the level, over the largest excursion. Wider: slow slips count as stick; narrower:
/// sticks of a ringing or sagging channel are lost.
inline constexpr double kPlateauBand = 0.12;
/// How far the middle of a plateau may stand out from its shoulders, over the band: a turning point of a smooth
/// oscillation is a parabola that stands out by more.
inline constexpr double kFlatness = 0.10;
/// The same of a plateau that is clearly flat: above, sticks are short beside the slips, and a narrower band (by so
/// much each time, down to so much of the first, and to so many standard deviations of the noise) leaves the slips out.
/// A stick keeps so much of its length in it; a turning point, a parabola, keeps half. Sticks of more than kLongSticks
/// of the record are long: what bends them is creep.
inline constexpr double kClearlyFlat = 0.05, kNarrower = 0.25, kNarrowestBand = 1e-3, kBandNoise = 6;
inline constexpr double kKeepsLength = 0.75, kLongSticks = 1.0 / 3;
/// From one shoulder of a stretch to the other, over the band: 0.6 where v_r passes through rest, in a reversal.
inline constexpr double kPasses = 0.25;
/// Deviation in a stretch, over half the band and over the noise of neighbours, that makes it a swing, not rest.
inline constexpr double kSwings = 0.25, kSwingsOverNoise = 5;
/// Blocks of a plateau: a middle and its two shoulders need as many.
inline constexpr std::size_t kFewestBlocks = 4;
inline constexpr double kSettled = kSpeedKnownTo;  // a plateau has settled, and agrees with what is stated, within

/// Standard deviations of v_r within which its plateau is at zero, and the least where there is no noise, over the
/// largest excursion: what creep before break-away makes of a rest. Wider: the lowest speed of a programme is a stick.
inline constexpr double kRestNoise = 3, kRestDepth = 1e-3;
/// A plateau off zero is rest with a wrong zero, or with creep, where a spring loads it: plateaus that must show it,
/// and the rise of friction over them, over its range. In slow sliding friction stays or wanders.
inline constexpr double kLeastLoading = 0.3;
inline constexpr double kTurnsOneWay = 0.5;  ///< mean speed of a disc over its mean size; 1/3 for 1.5 turns of a sine

/// Windows in which noise is looked for before it is known where the record rests, and their samples, a quarter of the
/// record at most: a parabola follows any motion over so few.
inline constexpr std::size_t kNoiseWindows = 64, kShortestWindow = 16, kLongestWindowOfNoise = 64;
/// Part of the windows that are quiet where sticks last a dozen samples, and their noise over the median at most.
inline constexpr double kQuietWindows = 0.1, kQuietNoise = 0.1;
/// Of the disc's speed, from which what moves with it is at rest on it, however wrong its gain; standard deviations of
/// the noise by which a block at one speed is not at zero, and so carried.
inline constexpr double kMovesWithDisc = 0.5, kCarried = 5;
/// Of the speed of the disc, up to which a plateau off it is creep; beyond, radius or speed are wrong. Part of a record
/// that plateaus without regard to the disc must fill, so many times where those beside the disc fill less.
inline constexpr double kFarFromDisc = 0.2, kPlateausOfBlock = 0.1, kLongerRest = 3;

// ---- run-up
/// Pieces of the first plateau, which may be the run-up itself, and of any other; and of its length, what is left out
/// at its end, where it may break away already.
inline constexpr std::size_t kPiecesOfFirst = 64, kPiecesOfPlateau = 16, kEndOfFirst = 32;
/// Standard deviations of the noise within which a piece is at the final level. Time before the first plateau over that
/// between two, and velocity there over the final one, which show a disc that starts from rest.
inline constexpr double kPieceNoise = 4, kLongHead = 3, kSlowHead = 0.5;
/// Of the final level, below which the first piece is of a run-up; part of the pieces after it that stay at the level:
/// a disc that ripples does not settle; of a usual plateau, below which it is ringing after a re-stick.
inline constexpr double kBelowFinal = 0.9, kStaysSettled = 0.9, kShortestRunUp = 0.25;

// ---- bandwidth
/// Bins without which a spectrum has no end to take noise from.
inline constexpr std::size_t kFewestBins = 64;
/// Content over the noise floor: of a bin, and of a third of an octave whose slope is looked at.
inline constexpr double kContentOverNoise = 2, kSlopeOverNoise = 3;
/// Power of frequency with which content falls behind a filter: of stick-slip up to two, of a sensor two more.
inline constexpr double kSteepFall = 4.5;
/// End of the noise floor over its beginning, below which a filter is in it.
inline constexpr double kFilteredEnd = 0.1;
/// Times the frequency, and bins, beyond which a line above the noise is a lone one and no content.
inline constexpr std::size_t kLoneLineAbove = 4, kLoneLineBins = 16;
/// Corner of one channel over that of the other, from which their filters differ.
inline constexpr double kFiltersDiffer = 1.5;

/// Standard errors by which what is undone must be there: it changes every sample, and levels of plateaus wander more
/// than their scatter shows.
inline constexpr double kSignificance = 6;

// ---- readings at rest, see RestModel
/// What a term must change over the level: less does not matter to the law (drive, high-pass, ripple); creep of the
/// contact from which other terms are doubted. And of its size, by which it may differ between halves of a record.
inline constexpr double kLeastOfRest = 0.005, kLeastCreep = 5e-4, kHalvesOfRest = 0.35;
/// Of the usual plateau, below which one is too short to show a level; pieces of one, as many as show how it bends.
inline constexpr double kShortestPlateau = 0.25;
inline constexpr std::size_t kMostPieces = 16;
inline constexpr double kFittable = 1e-8;  // reciprocal condition of the fit: below, rounding decides
/// Standard deviations from which a level is left out of the next fit, and part of them that must remain; rounding.
inline constexpr double kFarLevel = 5, kLevelsKept = 0.7, kRoundingOfLevel = 1e-9;
/// Time constants of a drive that are tried, over the usual stick, each so many times the one before.
inline constexpr double kFastestDrive = 0.02, kSlowestDrive = 2, kNextDrive = 1.1;
/// Static friction over the highest in the middle of a stick, as it may be where the contact creeps.
inline constexpr double kStaticOverHighest[] = {1.01, 1.03, 1.06, 1.1, 1.2};
inline constexpr int kHighestOrder = 6;  // of a ripple
/// Revolutions between the middles of the first and the last plateau, of two recorded ones: with fewer a drift looks
/// like a ripple.
inline constexpr double kFewestRevolutions = 1.95;
/// Plateaus in all, for at most six coefficients, and in a period of the ripple, so that it is not an alias.
inline constexpr std::size_t kFewestPlateaus = 12;
inline constexpr double kFewestPlateausAPeriod = 4;
/// Of the mean speed: by more a disc neither swings nor slows down.
inline constexpr double kMostOfDisc = 0.25;

// ---- plateau over omega r
/// What sampling and the corner leave in the level of a restored plateau, over the level; and standard error of the
/// creep taken off, over the creep: a real contact rings, and mu_s is not known that well.
inline constexpr double kErrorAfterHighPass = 1e-3, kErrorOfCreep = 0.5;

// ---- clocks of the two channels
/// [s] and samples, from which a delay is worth a warning: a force sensor with a bandwidth of 500 Hz is late by the
/// first (1/(2 pi f)), and the place of a jump is known to the second.
inline constexpr double kDelayWarned = 3e-4, kDelayWarnedSamples = 2.5;

/// Samples by which one may fall behind the other over a record: re-stick is not seen more closely in a slip.
inline constexpr double kDriftSamples = 3;
/// Part of the period within which friction jumps beside re-stick, and the scatter of that [samples]: more is no jump.
inline constexpr double kDriftReach = 0.1, kDriftScatter = 3;
/// Of the change of friction over five samples, what one of them must have for a jump.
inline constexpr double kSharpJump = 0.8;

// ---- two files of one run
/// Samples for a quantile, part of the velocity left out at either end of its range, and bins in which the usual
/// velocity is looked for.
inline constexpr std::size_t kEnough = 20000, kVelocityBins = 100;
inline constexpr double kSpikesOfVelocity = 0.002;
/// Parts of the largest excursion of the velocity that it rises from and to at a break-away: noise goes through one of
/// them, not through both.
inline constexpr double kRiseFrom = 0.1, kRiseTo = 0.35;
/// Samples without which an excursion is noise; bins of a slip, in which its edges show; most bins of a record: of more
/// the comparison takes seconds.
inline constexpr double kFewestInSlip = 4, kBinsOfSlip = 32, kMostBins = 1 << 21;
/// Part of the period by which two offsets are not the same one, and how many are looked at closely.
inline constexpr double kOffsetsApart = 0.3;
inline constexpr std::size_t kMostOffsets = 4;
/// Cycles that two records must share at an offset; that the balance and a line are fitted to; for which a wrong offset
/// may stay good by chance.
inline constexpr std::size_t kFewestShared = 3;
inline constexpr double kCyclesFitted = 3, kCyclesAlike = 20;
/// Drift of one clock against the other: quartz clocks are off by 100 ppm each at most. And by what part of a slip it
/// may blur what is compared at one offset.
inline constexpr double kMostClockDrift = 3e-4, kMostBlur = 1.0 / 3;
/// Of a slip's duration, to either side, for the acceleration: noise averages out, the jump at re-stick stays sharp.
inline constexpr double kAccelerationOver = 1.0 / 30;
/// Samples without which nothing is balanced, and of the final search; from before to after a slip, over its duration.
inline constexpr std::size_t kFewestBalanced = 20;
inline constexpr double kSearched = 200000, kBeforeSlip = 1, kAfterSlip = 2.5;
/// Parts of the shared time in which the offset is found by itself, and cycles of one.
inline constexpr std::size_t kFewestParts = 4, kMostParts = 12, kCyclesOfPart = 2;
/// How nearly an offset is found, in bins and in samples; and by what part of a sample a jump of friction is misplaced.
inline constexpr double kFoundInBin = 1.0 / 8, kFound = 1.0 / 50, kBetweenSamples = 0.03;

/// What the motion may leave of the squares of friction where both files are of one run.
inline constexpr double kMostUnbalanced = 0.3;
/// Logarithm of the odds against the next best offset: of two runs one pair in ninety is beyond 3, in 500 beyond 5.
inline constexpr double kClearEvidence = 7;

// ---- low-pass of the velocity
/// The end of a slip that is looked at, over the fastest: from where v_r last falls below the first to below the third
/// (a cubic follows it), of slips that reach the last. Behind a slow filter from the second on, where from the first
/// there is neither a filter nor a corner that leaves less than kRestickUnexplained of the fastest. Before short
/// sticks, which hold less than half as many samples as v_r falls in, from kRestickFromShort on.
inline constexpr double kRestickFrom = 0.2, kRestickFromSlow = 0.45, kRestickFromShort = 0.06, kRestickDown = 0.02,
                        kRestickSlip = 0.5;
inline constexpr double kRestickUnexplained = 2e-3;
/// The rest that is looked at, over the fall: twice as much where the stick is long. Less shows that there is none.
inline constexpr double kRestickRest = 1.5, kRestickRestShort = 0.5;
/// Slope of v_r when it comes to rest, over its mean one in the look: a spring brakes it most at the end, a mean over
/// more than the look makes a parabola of it.
inline constexpr double kRestickSteep = 0.6;
/// Squares that a decay from where the look begins leaves over those of a filter; fewer: re-stick was before.
inline constexpr double kRestickInside = 30;
/// Samples in which it falls: fewer show no corner, of more every other will do. Slips; those of a first look.
inline constexpr std::size_t kRestickSamples = 5, kRestickMost = 40, kRestickSlips = 12, kRestickFew = 4;
/// Time constants [samples], each so many times the one before; what the first look may leave, over the least.
inline constexpr double kRestickFirst = 0.15, kRestickNext = 1.35, kRestickRival = 4;
/// Of a time constant, or of a place between two that were tried, that is searched for: to a ten-thousandth.
inline constexpr int kBitsOfSearch = 14;
/// Standard uncertainty of a time constant, over it, for the cubic that stands for v_r before re-stick (off by 2 %
/// either way in simulated records) and where it is of the tail alone; from when on, how long that is [times it].
inline constexpr double kRestickModel = 0.01, kDecayModel = 5e-4, kDecayAfter = 0.5, kDecayLasts = 3;
/// What v_r reads at re-stick over the fastest: alpha is off by some five times as much; what does not matter.
inline constexpr double kRestickSeen = 0.008, kRestickHarmless = 0.001;
/// Squares that a corner leaves over those a filter leaves, and what the filter may leave over the reading: a contact
/// that rings there is no filter.
inline constexpr double kRestickExplained = 2.5, kRestickLeft = 0.08;
/// How far v_r may go beyond rest, over the reading and over the noise, and rise in the middle of a stick, over the
/// reading: a filter does not (1e-4), a contact that yields or spins does (0.1 to 0.8).
inline constexpr double kRestickBeyond = 0.1, kRestickNoise = 4, kRestickCreeps = 0.05;

/// Samples by which a restored velocity may be early or late for what its filter does to a sample.
inline constexpr double kHeldInput = 0.75;
/// What a restored velocity may have of noise, over the fastest: the law averages over it. The derivative is taken over
/// so much of the time constant at most: more is a filter again.
inline constexpr double kRestoredNoise = 2e-3, kRestoredSmear = 0.25;

/// Samples of a slip over which v_r is straight within one: with fifteen, alpha is 3 % less.
inline constexpr double kFewSlipSamples = 24;

// ---- low-pass of friction
/// Of the time from re-stick to re-stick over which friction is looked at after it, and the fewest samples of that;
/// samples before, through which a line says where the slip came to.
inline constexpr double kTailPart = 0.25;
inline constexpr std::size_t kTailSamples = 24, kTailBefore = 3;
/// Time constants tried: from so many samples to so much of these; the first, as good as none, does not count.
inline constexpr double kTailFirst = 0.4, kTailDecay = 0.1;
/// What decays after re-stick over the jump: without a filter friction jumps between two samples. Where it begins to
/// [samples, time constants]: a filter that holds its input for a sample begins half of one early.
inline constexpr double kTailSize = 0.3, kTailOnset = 1.2, kTailOnsetPart = 0.2;
/// Median fall over its spread from slip to slip: jumps of friction are alike to a fifth. Noise with a memory decays
/// too, where friction is recorded early and its jump is over by re-stick, but to either side. Samples beside re-stick
/// that are not looked at, for not knowing its place better.
inline constexpr double kTailAlike = 2, kTailGap = 0.4;
/// Variance left while it decays over that afterwards, and beside it over the size of the decay, squared: filters of
/// second order and contacts that ring leave more.
inline constexpr double kTailLeft = 1.6, kTailModel = 0.01;
/// Samples from which a jump is drawn out, what noise may leave of it, and rise times the corner of a low-pass.
inline constexpr double kDrawnOut = 4, kDrawnNoise = 0.05, kRiseOfLowPass = 0.35;

// ---- v_r as measured
/// How far from zero it may rest in stick, over its largest excursion: creep stays below. alpha is off by some eight
/// times as much.
inline constexpr double kZeroPart = 0.005;
/// How far its mean may be from omega r: the block is where it was but for a part of a slip length. And from where on
/// it is worth a word: a slip more at one end than at the other makes less of a record of a minute.
inline constexpr double kGainOff = 0.1, kGainWarned = 0.03;

// ---- zero of v_b
/// Mean v_b of a block that goes nowhere, over the plateau: a smaller one moves alpha by less than its error; a larger
/// one belongs to a block that nothing holds.
inline constexpr double kLeastZero = 0.002, kLargestZero = 0.5;
/// How nearly the plateau is off omega r by as much, over the mean and over its standard error, where it is the zero: a
/// compressed slip leaves the plateau where it is.
inline constexpr double kZeroAgrees = 0.1, kZeroErrors = 3;
/// The same for either half of the record, where slips are read wrongly: they are in both, as fast at least as this.
inline constexpr double kHalvesAgree = 0.3, kHalfOfMean = 0.5;

// ---- static response of either channel
/// Part of the gain that may be lost at the fastest, and how nearly the plateau is omega r where slips alone are read
/// wrongly, over what the block would move on average.
inline constexpr double kMostCompressed = 0.3, kPlateauHolds = 0.2;
/// The least part of friction's gain that is lost at its largest: a spring is not straighter.
inline constexpr double kLeastCurvature = 0.01;
/// Of the part, its standard error for not knowing the characteristic: of third order it may be or of any other.
inline constexpr double kOtherCharacteristic = 0.1;

// ---- steps of the disc's speed
/// A step over the speed; over the scatter of the plateaus on either side, and over their trend (a ripple or a drift
/// moves within either side by half of what it moves between them).
inline constexpr double kLeastStep = 2 * kSettled, kClearStep = 8, kSteepStep = 4;
/// Part of the record beside the plateaus of one level in which others are looked for.
inline constexpr double kStepPart = 0.1;

// ---- steps of a converter
/// Values in which steps and noise are looked for, and levels of a channel that has some: 12 bits are finer than noise.
inline constexpr std::size_t kValuesForSteps = 65536, kFewestLevels = 8, kMostLevels = 4096;
/// Part of the distances between levels that are whole numbers of the smallest, and how nearly; of the changes
/// of a channel that holds its values for some samples, those that come when they should; most samples; and how
/// much more lines bend where they are drawn from value to value.
inline constexpr double kWholeSteps = 0.95, kOffWholeStep = 0.05, kHeldAlike = 0.99, kBendAlike = 0.9, kBendsMore = 4;
inline constexpr std::size_t kLongestHold = 100;
/// Repeats that begin in a sample, of white noise behind a running median 0.2 to 0.26; and changes over the smallest
/// ones, below which a converter's steps repeat as often.
inline constexpr double kUnevenRepeats = 0.15, kFineChanges = 8;
/// Steps of friction over its range that show in a fit; of velocity over the fastest, from which alpha is off by more
/// than its error (at 4 % by 2 %, at 1 % by nothing).
inline constexpr double kCoarseStep = 0.01, kTooCoarseFriction = 0.03, kTooCoarse = 0.015;

// ---- samples that are missing
/// Change of the velocity within a sample over the changes beside it: a motion whose slip has ten samples changes by a
/// third more. How nearly changes are alike where the motion is smooth.
inline constexpr double kJumpOver = 1.6, kJumpSmooth = 0.3;
/// Jumps in all and per plateau (a blow on the rig now and then is no lost sample), and per plateau from rest, or to
/// it: a stiff rig breaks away within a sample.
inline constexpr std::size_t kFewestJumps = 5;
inline constexpr double kJumpsPerPlateau = 0.1, kUsualJump = 0.5;

// ---- derivatives of the pull of a spring
/// Part of the natural period to either side of a sample: a polynomial of fourth degree follows a sixth of a sine to
/// 1e-4 in its slope and 1e-3 in its second derivative; wider, slips are rounded; narrower, noise grows with the power
/// -5/2.
inline constexpr double kPartOfPeriod = 1.0 / 12;
/// Samples to either side: fewer leave no degree of freedom that would show a corner; more cost time for nothing.
inline constexpr std::size_t kShortestHalf = 4, kWidestHalf = 500;
/// Window of the slope of a position over the one that predicts its value best: its noise falls with the third power of
/// the window, that of a value with the first. 1: the velocity of a simulated slider is so noisy that mu_s is 1 % low.
inline constexpr double kSlopeOverValue = 1.75;
/// How nearly the steepest fall of the pull is that of stiffness and mass: friction that falls with speed makes it
/// steeper by some per cent, noise by some more.
inline constexpr double kFrequencyAgrees = 0.2;
/// Standard error of a velocity over the median, from which it is not used, and samples beside it: where a window
/// ends at a corner the error is six times as large, and the slope of the velocity over five samples is nothing.
inline constexpr double kUnsure = 2.5;
inline constexpr std::size_t kBesideUnsure = 2;
/// Standard errors of the velocity and part of the fastest slip, from which a slider on a spring slips.
inline constexpr double kSlipsOverError = 8, kSlipsOverFastest = 0.06;
/// Windows before that, in which a slip begins: the velocity grows e-fold in one or less.
inline constexpr std::size_t kRisesWithin = 2;
/// Of the largest velocity, from which a swing counts for the level of friction in its direction: slower, friction is
/// that of the turning point.
inline constexpr double kSlidesFreely = 0.3;
/// Of the largest velocity, beyond which a mass that turns round within two windows has not rested between.
inline constexpr double kTurnsRound = 0.1;
/// Power that friction takes in the wrong direction from one motion over that from another, up to which the first is
/// the sliding: of the true one only the noise at its reversals is left.
inline constexpr double kAlikePowers = 0.5;

// ---- faults of the recording
/// Samples of which a distribution can be seen, and how many are looked at for one.
inline constexpr std::size_t kFewestDistributed = 64, kThinned = 16384;
/// Degrees of freedom of innovations: the noise of a laser has three, and from the second on it is as good as normal.
inline constexpr double kHeaviestTail = 3, kNormalTail = 200;
/// How far a jump to an outlier must go at least, over the range of the channel, and in steps of a converter: nearer
/// ones are as likely noise, and leaving those out would bias the noise floor.
inline constexpr double kLeastOutlier = 0.01, kStepsOfOutlier = 2.5;
/// The most that innovations reach, over what one in twenty exceeds: t of three degrees goes there once in 200,000
/// samples; corners of slips, which are no noise, do not make it larger.
inline constexpr double kMostReach = 22;
/// How far a marker lies beyond the range of all but two values in a thousand, over that range: no channel of a machine
/// leaves its range so far within a sample.
inline constexpr double kMarkerReach = 3;
/// What a channel changes by before an outlier, within it, and over it, of the jump; samples of one at the most; and
/// part of the range by which the other channel changes where it is a slip of few samples: friction falls by most of
/// it.
inline constexpr double kQuietBeside = 0.25, kSlipOfSamples = 0.3;
inline constexpr std::size_t kWidestOutlier = 64;
/// Part of the usual largest sliding speed from which on a velocity does not come to zero by itself within a sample,
/// and scatters of friction by which it leaves its level at rest, of so many samples to either side. Smaller: a plug
/// that is loose in noisy friction passes for rest; larger: a rest under nearly the friction of sliding passes for a
/// loose plug.
inline constexpr double kOfUsualSpeed = 0.25, kFrictionStays = 2;
inline constexpr std::size_t kBesideZeros = 50;
/// Samples of one value in a row that chance must not explain, at least; and samples over which the motion is not
/// known.
inline constexpr std::size_t kShortestRun = 3, kShortestStretch = 16;
/// A channel with noise and fine steps repeats a value in fewer samples than the first (a coarse converter repeats
/// more), and turns in more than the second (white noise in 2 of 3, a motion without noise in one of a hundred).
inline constexpr double kFewRepeats = 0.02, kManyTurns = 0.05;
/// Part of its samples that a coarse converter repeats: no limit shows in such a channel, nor a run that this explains.
inline constexpr double kRepeatsOfSteps = 0.2;
/// Samples of a run at the end of the range over those one step inside: the flattest peak of a law at break-away, a
/// fourth power of time, stays 5 times as long in its last step as in the one before.
inline constexpr double kStepsOfATurn = 8;
/// Part of the record at a limit, from which mu_s or the law's decay is off by more than its error; part of the
/// declared range from which a channel is at its end; part of a record that stands still or is left out, and of gaps in
/// time: the rest does not make up for more.
inline constexpr double kMuchClipped = 1e-3, kAtDeclaredRange = 0.995, kMuchFrozen = 0.05, kMuchFaulty = 1e-3;
/// Bins of a channel's range, and the widest dense part as a part of it.
inline constexpr std::size_t kClipBins = 4096, kNarrowestRange = 16;
/// Density of samples at the limit over that beside it. A turning point (a parabola) has 3 over any width, a peak 1:
/// the first needs quiet (noise over that elsewhere), the second, of a block that sticks and slips, does not.
inline constexpr double kDenseQuiet = 2, kDenseAlone = 6, kQuiet = 0.7;
/// Of its usual rise over the displacement of the block, by which friction at a limit goes on; standard errors of a
/// mean below it; change of that displacement, with which the block still rests.
inline constexpr double kStillRises = 0.5, kClippedErrors = 4, kCarriedOn = 0.02;
/// Samples at a limit: fewer do not bear on a fit; samples between two at it that are taken for clipped too (noise
/// brings them below it), and beside a stretch.
inline constexpr std::size_t kFewestClipped = 32, kOneClippedIn = 2000, kClipHole = 32, kClipMargin = 8;
/// Changes in a sample that an amplifier cannot exceed: over a converter's steps, how alike, and how many in a row.
inline constexpr double kSlewSteps = 16, kSlewWidth = 0.02;
inline constexpr std::size_t kShortestSlew = 8;
/// Standstill at an end of a stick-slip record: rest for so many periods at less than this part of the plateau.
inline constexpr double kStandstillPeriods = 3, kStandstillPart = 0.1;
inline constexpr std::size_t kFewestPeriods = 5;

// ---- the load point of velocity steps and holds
/// Speed backwards over the fastest, below which it creeps in a hold; part of a record one way that is the test.
inline constexpr double kCreepOfHold = 1e-3, kLeastOneWay = 0.6;
/// Errors of the mean of a recorded speed by which phases differ: its integral is cut where it wanders most. Logarithm
/// of the ratio of speeds that are the same: a rest between them is a hold. Samples within which a step is answered.
inline constexpr double kSpeedsOfNoise = 8, kSameSpeed = 0.3;
inline constexpr std::size_t kAnswerOfStep = 10;
/// Time and length, over those of the sliding on either side, of what a drive does between two speeds (overshoot, a
/// pause): it is simulated as it was, but makes no step. Larger: short slides between long ones are lost.
inline constexpr double kPassageBeside = 0.1;

}  // namespace tribofit::kinematics
