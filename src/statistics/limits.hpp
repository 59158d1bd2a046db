#pragma once

#include <cstddef>

// The thresholds by which statistics decide, with their reasons and what moves when they change.

namespace tribofit {

// ---- slow noise; all likelihoods are logarithms

/// Values of a series that show slow noise: fewer have no frequencies beside those that a model takes away.
inline constexpr std::size_t kFewestSlowValues = 16;

/// Stretches, and values in one, whose median periodogram shows 1/f noise: with fewer a median is not yet that of the
/// distribution, and no octave is left beside a parabola.
inline constexpr std::size_t kFewestStretches = 20, kShortestStretch = 32;

/// Of the squares of a series: what rounding leaves of one that is constant.
inline constexpr double kConstantSeries = 1e-20;

/// By how much the likelihood of an autoregression must exceed that of 1/f noise: it has a parameter more, and a record
/// that is not much longer than its memory cannot distinguish the two. Less: 1/f noise passes for an autoregression,
/// and slow effects are named in it.
inline constexpr double kClearlyLikelier = 5;

/// By how much slow noise must exceed independent noise alone (H. Akaike, IEEE Trans. Autom. Control 19 (1974) 716).
inline constexpr double kLikelier = 1;

/// Below as many periods in the record a model that was fitted has taken power away.
inline constexpr double kFirstBin = 3;

/// 1/f noise has power below the lowest frequency of its record too: down to that of one so many times as long.
inline constexpr std::size_t kLonger = 8;

/// Greatest ratio of slow to independent noise at the lowest frequencies, and of independent to slow.
inline constexpr double kMostSlow = 256;

/// No value of a periodogram counts beyond the largest that this chance would give: it is a line, perhaps an effect.
inline constexpr double kChanceOfLine = 0.5;

// ---- a periodic line in a series, for the standard error of its mean

/// Values that show a line, bin of a transform over twice the series below which a line is a drift (two periods in
/// the record), and chance that the largest of all bins is as high in noise.
inline constexpr std::size_t kFewestOfLine = 32, kSlowestBinOfLine = 4;
inline constexpr double kChanceOfPeriod = 1e-3;

// ---- the strongest line of a signal

/// Bin of the transform below which a drift is not distinguishable from a line.
inline constexpr std::size_t kSlowestBin = 3;
/// Harmonics that may exceed their fundamental (short slips are pulses), and its height over theirs where it is one.
inline constexpr std::size_t kHighestHarmonic = 10;
inline constexpr double kFundamentalHeight = 0.5;
/// Samples that are transformed: more cost time, and the reduced record shows low lines as well.
inline constexpr std::size_t kMostTransformedAtOnce = std::size_t{1} << 15;
/// Samples in a period of what is kept of a spectrum (what lies above then folds back from seven times as high on), and
/// of a line whose place is refined.
inline constexpr double kSamplesPerPeriod = 8, kSamplesPerRefined = 16;
/// Samples of a spectrum.
inline constexpr std::size_t kFewestOfSpectrum = 16, kFewestReduced = 8;

/// Values from which a transform is made of two of half the length, side by side: below, starting a thread costs more.
inline constexpr std::size_t kFewestOfHalves = 1 << 14;

// ---- local derivatives

/// Squares that a window leaves over the usual ones, from which there is a kink in it, and over those of a window
/// beside it that is taken instead: by chance one window in a thousand.
inline constexpr double kKinkSquares = 3, kBetterWindow = 2;
/// Standard deviations by which a lone sample is off its neighbours (noise alone never is), and that over what the
/// signal does beside: at a turning point it is a third.
inline constexpr double kLoneSample = 6, kLoneSteepness = 3;

// ---- noise that wanders

/// Logarithm of the largest ratio of the variances of wandering and white noise, and of the smallest: beyond it one of
/// them is not seen.
inline constexpr double kLargestNoiseRatio = 14;
/// Fall of minus twice the logarithm of the likelihood from which on noise is said to wander: the price of its two
/// parameters by Akaike's criterion. White noise reaches it in one series of ten or fewer.
inline constexpr double kLikelihoodOfWandering = 4;

// ---- lines with corners

/// Change of a slope, over the larger one, that is a corner: a drive keeps a speed to a few per cent, and steps of it
/// are by half at least. Smaller: a drive that hunts has corners where nobody set any; larger: small steps are missed.
inline constexpr double kLeastChangeOfSlope = 0.15;
/// Distance of a corner from the straight line over it, over the noise (its square is what a corner must save in
/// squares of the noise, where noise alone saves twenty), and way of a level over the noise; slope of a level over
/// those beside it, which is below any step that people make.
inline constexpr double kCornerOfNoise = 8, kLevelBeside = 2e-3;
/// The same of a line that may be part of a ramp: what it would hide, over what a corner must save. Smaller: ramps that
/// bend are cut into speeds that nobody set; larger: short slides at a speed between two others are lost. Errors of a
/// slope by which it may fall behind the one before it.
inline constexpr double kCornersOfRamp = 10, kErrorsOfSlope = 3;
/// Samples of a piece, and those beside a corner that do not count for its lines, as a drive takes time to change.
inline constexpr std::size_t kFewestOfPiece = 4, kMarginOfPiece = 5;
/// Samples among which corners are looked for first: without a corner the work grows with their square.
inline constexpr std::size_t kMostSplit = 4000;
/// Strides beside a corner of them among which all samples are looked at, for pieces that a stride steps over.
inline constexpr std::size_t kReachOfCorner = 5;
/// Noise of a reading over the least step between readings: by rounding alone 12^-1/2.
inline constexpr double kNoiseOfDigit = 0.3;
/// What numbers are rounded to, over the whole way: a displacement without noise has corners all the same.
inline constexpr double kRoundingOfWay = 1e-9;
/// Intervals beside the samples of a corner within which the lines must meet: farther off one of them is no line.
inline constexpr double kNearCorner = 2;

// ---- noise about parabolas

/// Largest correlation of neighbours, and share of the variance that a parabola may have taken. Larger: what is left of
/// a stretch says next to nothing of the noise, and a slow change of the contact is taken for it.
inline constexpr double kMostCorrelation = 0.97, kLargestShare = 0.75;
/// Correlations that are the same.
inline constexpr double kSameCorrelation = 1e-4;

}  // namespace tribofit
