#pragma once

#include <array>
#include <cstddef>

#include "segmentation/limits.hpp"

// The thresholds by which fits decide, with their reasons.

namespace tribofit {

/// Standard errors beyond which it is not chance, of one test a record: that mass and stiffness are not zero, that the
/// levels of neighbouring slips differ. Less: white noise passes for it now and then; more: laws are mistaken for one
/// another where levels scatter.
inline constexpr double kClearOfZero = 3;

// Cycles that carry a fit, and samples of a slip that show a curve.
using segmentation::kFewestCycles;
using segmentation::kShortestSlip;

/// Speeds of slip at which friction of neighbouring cycles is compared, of the median peak: most reach them, and little
/// of a high break-away is left there. Steps between levels from which their covariance says more than chance.
inline constexpr double kSpeedsOfLevel[] = {0.8, 0.9};
inline constexpr std::size_t kFewestLevelSteps = 8;

/// Noise is taken about parabolas: over 200 samples at most, which even a ramp that creeps, or sliding at a speed that
/// is swept, is close to, and over a quarter of a slip. 12 leave three quarters of their degrees of freedom beside the
/// parabola.
inline constexpr std::size_t kShortestNoiseStretch = 12, kLongestNoiseStretch = 200;

/// Degrees of freedom below which a variance of its own for each point says too little of a parameter: its interval
/// would be a quarter wider than with one variance for all, which a standard error of each point serves better. And
/// independent values on either side without which it cannot be judged whether a law lacks something.
inline constexpr double kFewestFreeVariances = 5;

/// A parabola over a stretch takes away what is slower than a third of it.
inline constexpr double kPartBesideParabola = 1.0 / 3;

/// Periods in a slip from which a steady line and a ring are looked for. A line with less than half of one moves slips
/// as a whole, as 1/f noise does: with fewer one is named in empty records with such noise. A ring with fewer than six
/// is not distinguished from the shape of the law.
inline constexpr double kFewestPeriodsOfLine = 0.5, kFewestPeriodsOfRing = 3.5;

/// Part of the rate of the values, and of that of samples that are folded, up to which a line is looked for: nearer to
/// a half it is not distinguishable from its alias. Part of a slip in which a ring is looked for, and its fewest
/// values.
inline constexpr double kHighestLine = 0.4, kHighestRing = 0.45, kRingsWithin = 0.6;
inline constexpr std::size_t kFewestOfRing = 32;
/// Values that are transformed, and their fewest; the highest lines that are taken, and bins beside each that are its
/// own: a line in slip alone has side lines at the frequency of stick-slip. Bins beside a peak that are searched in the
/// whole record, and the step of the search in its own bins.
inline constexpr std::size_t kMostTransformed = std::size_t{1} << 18, kFewestTransformed = 64, kMostLines = 3,
                             kBinsOfLine = 4;
inline constexpr double kBesidePeak = 1.5, kFinerThanBin = 0.1;
/// Samples of a stick whose remainder about a parabola shows a line, and samples of all that do; variance of noise that
/// a line makes, from which it is taken off, and what is left of the variance at least.
inline constexpr std::size_t kShortestStickOfLine = 20, kFewestOfStickLine = 1000;
inline constexpr double kLineInNoise = 0.3, kLeftBesideLine = 0.05;
/// Part of the frequency of such a line from which lines are looked for.
inline constexpr double kBelowLineInStick = 0.9;

/// Sine squared of the angle between what a break-away and what slow noise do to a slip, from which the two are
/// distinct: less, and rounding decides.
inline constexpr double kLeastIndependence = 1e-6;

/// Part of a second difference of friction by which what is between two samples is off a straight line: an eighth, of
/// a parabola. How a record without noise was made, and sampled, is not known better. Samples between two such
/// differences that noise does not make alike.
inline constexpr double kOffStraightLine = 1.0 / 8;
inline constexpr std::size_t kApart = 3;

/// Root of the weight of a break-away at the least, whose time is not known: what has none at all has no residual.
inline constexpr double kLeastWeight = 1e-6;

/// Variance of a stretch over that of the quiet quarter, beyond which it holds something else than noise.
inline constexpr double kLoudest = 3;

// ---- the search for parameters

/// Values of a slip on which a search runs before all values take part: what means over more move is within reach of a
/// few Gauss-Newton steps (up to 20 standard errors for a memory of a thirtieth of a slip). Fewer: a start may be led
/// into another valley. A look takes half of them.
inline constexpr double kValuesOfSearch = 100;
/// Iterations behind which a look compares its starts. Fewer: a start that is slow at first is lost; more: time. With
/// these, 147 sets of effects on each of three simulated records were described as well as with twelve, to 3 %.
inline constexpr int kIterationsToCompare = 5;
/// Values of the slips on which it runs where every value counts.
inline constexpr std::size_t kWholeSlips = 12000, kWholeSlipsOfLook = 8000;
/// Part of a standard error by which the last step over all values may move a parameter: what is left then is a tenth
/// of it, and no printed digit moves. Steps that are taken at the most, and by how much each must at least be shorter
/// than the one before it.
inline constexpr double kLastStep = 1e-3, kShortening = 0.7;
inline constexpr int kMostRefiningSteps = 12;
/// A look takes one such step, of any length: where it leaves more than this many times what was left before it, it led
/// astray along a flat valley and is not taken.
inline constexpr double kRiseOfLook = 1.01;
/// Passes over the slips, each with the scatter of break-away as the one before it leaves it. Where scatter is most of
/// what a law leaves, three still hold something of the start.
inline constexpr int kFewestPasses = 3, kMostPasses = 20;

/// Slips before and after a change that it may touch; and the part of its time in which it may, twice that over which a
/// change is smoothed to have a derivative.
inline constexpr std::ptrdiff_t kSlipsTouched = 2;
inline constexpr double kTimeTouched = 0.02;

// ---- slips

/// Samples of a stick that show a spread, and units of evidence of a record that never sticks: enough for folds and
/// long-run variances, and each long beside what is remembered.
inline constexpr std::size_t kShortestStick = 40, kPiecesWithoutStick = 40;
/// Of the slip, friction after re-stick: what rings there is over after the first, and the spring has raised friction
/// little over the second.
inline constexpr double kAfterRestick = 0.015, kMeanAfterRestick = 0.06;
/// Standard deviations of v_r below which the last samples of a slip are stick that noise kept above its threshold.
inline constexpr double kSlowEnd = 6;
/// Part of a stick time that is left where its own levels made the rest of it.
inline constexpr double kLeastStickTime = 0.1;

// ---- the rig

/// Part of what a channel has for itself that may be noise,
/// and samples in a free period: with fewer the derivative is that of another motion.
inline constexpr double kMostNoiseOfRig = 0.3, kShortestPeriod = 8;
/// Chance of a false remark about one record, part of the damping that makes one, and of the stiffness: less is no news
/// about a gain or a radius.
inline constexpr double kChanceOfRemark = 1e-3, kPartOfDamping = 0.1, kPartOfStiffness = 0.005;

// ---- records that share parameters

/// Chance that a sharing which holds is refused. Larger: good campaigns are doubted; smaller: a run with another law
/// passes for one of them, though it shows in its held-out error.
inline constexpr double kChanceOfRefusal = 0.01;
/// Part of what a record knows best, from which it says something of a direction of the common values: along others it
/// sees its own noise of speed.
inline constexpr double kLeastKnownDirection = 1e-3;

// ---- how good a fit is

/// Held-out error over the noise floor up to which what remains is called noise: noise floors are known to some per
/// cent, and every parameter costs a little on held-out cycles. Lower: true laws of short records count as lacking
/// something.
inline constexpr double kAtFloor = 1.15;
/// The same ratio from which a fit is well above the noise floor, so that means that agree may hide what it misses, and
/// from which it says no more than "far above".
inline constexpr double kWellAbove = 1.25, kFarAboveFloor = 100;

/// And from which no noise makes it so, however slow: of empty records with white, coloured and 1/f noise none is
/// beyond 1.2. A record that wanders more than that is not described by law and noise floor.
inline constexpr double kClearlyAbove = 2;

/// Held-out error over that of the fitted cycles from which a model has learnt its cycles by heart.
inline constexpr double kLearntByHeart = 1.5;

/// Part of the fall from mu_s to mu_k that was not recorded at its slow or fast end, from which that level is
/// extrapolated: a law that holds over nine tenths gives it to a few per cent of the fall. Larger: levels that rest on
/// the law alone pass for measured ones.
inline constexpr double kExtrapolated = 0.1;

/// Mean relative errors that count as close, and as an outline only ([D] calls 8 % good).
inline constexpr double kClose = 0.02, kOutline = 0.08;

/// Correlation of two parameters from which the data determine them together rather than each: either would be known
/// more than twice as well if the other were, by 1/sqrt(1 - r^2).
inline constexpr double kStrongCorrelation = 0.9;

/// p value from which one law is clearly better than another.
inline constexpr double kClearlyBetter = 0.05;

/// Of the standard deviation of the weights by which a slider's velocity is smoothed, as standard uncertainty of its
/// break-away: in simulated sliders (three springs, three speeds, 12 and 19 bits) it is 0.3 early to 0.8 late.
inline constexpr double kPartOfSmoothing = 0.5;
/// Standard uncertainty of an acceleration that is the curvature of such a pull, over it: a polynomial over a sixth of
/// a period follows a sine to 1e-3, and where a slip begins or ends to some more.
inline constexpr double kSmoothedAcceleration = 1.5e-3;

/// Least scale of a force, over the largest: levels of friction may be five times the scale, and the largest is one.
inline constexpr double kLeastScaleOfForce = 0.2;

// ---- motion of the block in a slip

/// Half windows of the velocity [samples]; part of a slip that each sample of the widest one takes (so that 0.03 of a
/// slip is smoothed to either side, of its slope 0.015); and the squares by which a window may differ from shorter
/// ones, over those of noise alone.
inline constexpr std::array<std::size_t, 8> kHalfWindows = {20, 14, 10, 7, 5, 3, 2, 1};
inline constexpr double kWindowOfSlip = 0.0015, kFlattened = 2;
/// The widest of a slope. Wider: a mass that turns quickly is found too heavy (1.5 % where a drive turns within 20
/// samples); narrower: noise of the acceleration.
inline constexpr std::size_t kWidestOfSlope = 10;
/// Samples of a slip over which windows are compared.
inline constexpr std::size_t kMostLookedAt = 8192;

// ---- velocity steps and holds

/// Part of the sliding at one speed that belongs to the step before it; the rest shows the level before the next step.
/// Of the sliding before the first step as much as is slid behind it, or lasts as long as such a rest: run-in is no
/// level. Larger: steps whose decay is long lose their end; smaller: the level before a step is less well known.
inline constexpr double kPartOfSlidingBehind = 0.7;
/// Mean square that a fit of all steps leaves, over that of the first step alone, from which on it has not found its
/// minimum: near the critical stiffness friction swings, and few starts lead there.
inline constexpr double kFarFromMinimum = 4;
/// Logarithm of the ratio of speeds between which there is no step: a drive that still settles.
inline constexpr double kNoStep = 0.05;
/// Samples behind a step, and half as many before it, without which it shows nothing: a constant, a line and four
/// parameters are asked of it.
inline constexpr std::size_t kFewestBehindStep = 10;
/// Values that a step is fitted to: neighbours are put together where there are more, which moves the parameters by
/// less than 1 % of their errors; and that the search begins with.
inline constexpr std::size_t kValuesOfStep = 1500, kValuesOfStepSearch = 150;
/// D_c behind a step within which a contact adapts: e^-5 of the change is left. What is left there over what is left
/// elsewhere, as a root of mean squares, from which on a law lacks something (with kChanceOfRemark that noise makes it
/// so none of 60 simulated records with wandering noise was said to lack anything). Smaller: drift of the measurement
/// is blamed on the law; larger: a law that fails a little passes.
inline constexpr double kAdapted = 5, kMuchLeft = 1.15;
/// What wanders over the noise of a sample from which on it is said where that cannot be judged.
inline constexpr double kMuchWander = 4;
/// Decades that the times of holds must span for a healing rate: a factor of two.
inline constexpr double kLeastDecades = 0.3;
/// A hold loads the contact as if the speed had changed by e^4.6 (a hundredfold), to begin with.
inline constexpr double kHoldAsRatio = 4.6;
/// Second D_c over the first, to begin with.
inline constexpr double kSecondDistance = 8;
/// By which the time of a step may be wrong, over the shorter sliding beside it where a person has noted it, and over
/// the sampling interval where it was read from a recorded speed.
inline constexpr double kSlackOfStated = 0.1;
/// The same, over the sliding, where a recorded displacement turns: drives run up, catch up and have play, so that
/// friction answered up to 0.004 of the sliding later on real records. It is moved beyond kChanceOfRemark. Smaller: a
/// later answer is taken for a softer machine; larger: what else friction does beside a step is taken for a
/// later one.
inline constexpr double kSlackOfDisplacement = 0.05;
/// Chance that noise makes two states describe the steps so much better, below which they do, and error of a, and of b
/// or D_c of either, over its value above which nothing is known of it. The chance is small as noise that wanders is
/// much like the answer of a second state; data/validation/velocity-steps.md has how often either was taken for the
/// other.
inline constexpr double kChanceOfSecondState = 1e-8, kVagueOfState = 0.5;
/// Bounds of a, b and k over the range of friction, and of D_c and k over what is slid in a sampling interval and in
/// the longest step: nothing of the response is left to see beyond them.
inline constexpr double kLeastOfRange = 1e-5, kLargestOfRange = 30, kLeastOfSampling = 0.03, kMostOfSliding = 10;
/// Upper over lower end of an interval of D_c or k from which the value is not known: not to a factor of two.
inline constexpr double kWidestInterval = 4;
/// Degrees of freedom beyond which more make no difference.
inline constexpr double kLargeFreedom = 1e6;

}  // namespace tribofit
