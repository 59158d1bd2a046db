#pragma once

#include <cmath>
#include <cstddef>
#include <numeric>
#include <string>
#include <vector>

#include "tribofit/fit/identification.hpp"

namespace tribofit {

/// Relative error that [D] states for all its fits ("each less than 0.08").
inline constexpr double published_error_limit = 0.08;
inline constexpr const char* published_error_limit_text = "0.08";

/// How far a fit is off, as in [D] Fig 12: e = |(mu - model)/mu| (Eq 5) of the slip samples.
struct RelativeErrors {
  std::string law, protocol;
  double below_limit = 0;       ///< share of the slip samples with e below published_error_limit
  double bins_below_limit = 0;  ///< share of the bins that hold samples in which e of the mean friction is below it
  double largest_of_bins = 0;   ///< largest e of the mean friction of a bin
  double mean_relative = 0, max_relative = 0;  ///< over all samples
};

/// The same over speed, bin by bin; NaN where a bin holds no samples.
struct ErrorCurve : RelativeErrors {
  std::vector<double> fitted;                               ///< mean of the model
  std::vector<double> bin_mean_relative, bin_max_relative;  ///< mean and largest e
};

/// A line of the spectrum of v_r and its multiples.
struct Harmonic {
  double frequency = 0;  ///< [Hz]
  double amplitude = 0;  ///< of the sine [mm/s]
};

/// What Fig 5 to 12 of [D] show of a run, small enough to be kept with its result. In the units people read: mm/s, and
/// friction as a coefficient, or in N where it is a force; friction of slips is positive in either direction.
struct RunFigures {
  double bin_width = 0;                  ///< of |v_r| [mm/s]; bins begin at 0, the last ends at the fastest slip
  std::vector<std::size_t> bin_samples;  ///< slip samples in each bin
  std::vector<double> bin_friction;      ///< their mean friction (Fig 10, 11); NaN where there are none
  std::vector<ErrorCurve> errors;        ///< one a fit (Fig 12)

  std::size_t slip_samples() const { return std::accumulate(bin_samples.begin(), bin_samples.end(), std::size_t{0}); }
  /// e of the mean friction of a bin.
  double error_of_mean(const ErrorCurve& curve, std::size_t bin) const {
    return std::abs((bin_friction[bin] - curve.fitted[bin]) / bin_friction[bin]);
  }

  double spectrum_step = 0;         ///< [Hz]
  std::vector<double> spectrum;     ///< amplitude of v_r at k spectrum_step (Fig 7) [mm/s]
  std::vector<Harmonic> harmonics;  ///< the fundamental first

  std::vector<double> time, velocity, friction;  ///< three cycles (Fig 6, 8), closer in slip than in stick [s], [mm/s]
};

/// Takes the figures of one analysed trace.
///
/// Errors: 40 bins over 0 to the fastest slip. Spectrum: root mean square over stretches as long as the transform of
/// [D] (1.64 s; longer where that is less than five periods), Hann window, up to the eighth harmonic. The amplitude of
/// a harmonic is that of a sine of the power within half a fundamental of it, so that periods that scatter do not lower
/// it. Times: the first three cycles that are whole and follow each other. Cost: a pass over the slips for each fit.
RunFigures figures_of(const Identification& result);

}  // namespace tribofit
