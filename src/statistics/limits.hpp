#pragma once

#include <cstddef>

// The thresholds by which statistics decide, with their reasons and what moves when they change.

namespace tribofit {

// ---- series and their spectra

/// Values of a series that have a spectrum: fewer have no frequencies beside those that a model takes away. Of one in
/// which a line, or noise beside a parabola, is looked for: fewer leave no octave to compare with.
inline constexpr std::size_t kFewestOfSpectrum = 16, kFewestOfLine = 32;

/// Periods in a record below which a drift is not distinguishable from a line, and a model that was fitted has taken
/// power away.
inline constexpr std::size_t kFewestPeriods = 3;

/// Place of a line between bins of a transform, as bits: to 2e-6 of a bin.
inline constexpr int kBitsOfPlace = 20;

/// What rounding leaves of the squares of a series that is constant.
inline constexpr double kRounding = 1e-24;

/// By how much a likelihood must rise for each parameter that is added (H. Akaike, IEEE Trans. Autom. Control 19 (1974)
/// 716). Noise that does not wander reaches that of two in one series of ten or fewer.
inline constexpr double kPriceOfParameter = 1;

// ---- slow noise; all likelihoods are logarithms

/// Stretches whose median periodogram shows 1/f noise: with fewer a median is not yet that of the distribution.
inline constexpr std::size_t kFewestStretches = 20;

/// By how much the likelihood of an autoregression must exceed that of 1/f noise: it has a parameter more, and a record
/// that is not much longer than its memory cannot distinguish the two. Less: 1/f noise passes for an autoregression,
/// and slow effects are named in it.
inline constexpr double kClearlyLikelier = 5;

/// 1/f noise has power below the lowest frequency of its record too: down to that of one so many times as long.
inline constexpr std::size_t kLonger = 8;

/// Greatest ratio of slow to independent noise at the lowest frequencies, and of independent to slow.
inline constexpr double kMostSlow = 256;

/// No value of a periodogram counts beyond the largest that this chance would give: it is a line, perhaps an effect.
inline constexpr double kChanceOfLine = 0.5;

// ---- a periodic line in a series, for the standard error of its mean

/// Bin of a transform over twice the series below which a line is a drift (two periods in the record), and chance that
/// the largest of all bins is as high in noise.
inline constexpr std::size_t kSlowestBinOfLine = 4;
inline constexpr double kChanceOfPeriod = 1e-3;

// ---- the strongest line of a signal

/// Harmonics that may exceed their fundamental (short slips are pulses), and its height over theirs where it is one.
inline constexpr std::size_t kHighestHarmonic = 10;
inline constexpr double kFundamentalHeight = 0.5;
/// Samples that are transformed: more cost time, and the reduced record shows low lines as well.
inline constexpr std::size_t kMostTransformedAtOnce = std::size_t{1} << 15;
/// Samples in a period of what is kept of a spectrum (what lies above then folds back from seven times as high on); of
/// a line whose place is refined twice as many.
inline constexpr double kSamplesPerPeriod = 8;

// ---- local derivatives

/// Squares that a window leaves over the usual ones, from which there is a corner in it, and over those of a window
/// beside it that is taken instead: by chance one window in a thousand.
inline constexpr double kCornerSquares = 3, kBetterWindow = 2;
/// Standard deviations by which a lone sample is off its neighbours (noise alone never is), and that over what the
/// signal does beside: at a turning point it is a third.
inline constexpr double kLoneSample = 6, kLoneSteepness = 3;

// ---- noise that wanders

/// Logarithm of the largest ratio of the variances of wandering and white noise, and of the smallest: beyond it one of
/// them is not seen.
inline constexpr double kLargestNoiseRatio = 14;

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
