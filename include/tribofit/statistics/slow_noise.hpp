#pragma once

#include <span>
#include <vector>

namespace tribofit {

/// The part of the noise of a series that wanders: what is left beside noise that is independent from value to value.
struct SlowNoise {
  std::vector<double> covariance;  ///< of values 0, 1, 2 ... apart; empty: there is none
  bool is_flicker = false;         ///< taken for 1/f noise, not for an autoregression

  /// Variance of the sum of weights[i] times value i. weights: as many as the series has values.
  double variance_of_sum(std::span<const double> weights) const;
  /// Of a value about the mean of the series.
  double variance_within() const;
};

/// Slow noise of a series of residuals, one a cycle in order of time, by the likelihood of its periodogram
/// (P. Whittle, Ark. Mat. 2 (1953) 423): independent noise plus either a first-order autoregression or 1/f noise,
/// whose power rises without end towards low frequencies (M. S. Keshner, Proc. IEEE 70 (1982) 212); 1/f unless the
/// autoregression is clearly likelier. Its spectrum is s^2 + a/f or s^2 + a (1-m^2)/(1 - 2 m cos(2 pi f) + m^2) over
/// the frequency f per value; s^2 and a in squares of the unit of the series.
///
/// The mean of a record with 1/f noise errs by more than its own lowest frequencies show, and a slow function fitted to
/// it takes away the very power that would tell so. Here that power follows from all frequencies. Single lines, which
/// may be an effect, do not count beyond the largest value that chance would give. None for less than 16 values.
/// known_flicker: a of 1/f noise that the values have for certain; 0: none is known.
SlowNoise slow_noise(std::span<const double> series, double known_flicker = 0);

/// The power a of 1/f noise, as above, that many stretches of one length show: half its variance in every e-fold of
/// time, whatever the step between values. From the median of their periodograms, about a parabola in each: few
/// stretches that hold something else do not matter. 0 where the noise is independent or rather an autoregression, and
/// for less than 20 stretches or stretches of less than 32 values.
double flicker_power(std::span<const std::span<const double>> stretches);

}  // namespace tribofit
