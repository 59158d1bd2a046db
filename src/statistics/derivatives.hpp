#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// A sampled signal with its first two derivatives and their standard errors.
struct LocalDerivatives {
  double noise = 0;                                     ///< standard deviation of a sample
  double prediction_error = 0;                          ///< usual distance of a sample from what the others say of it
  std::vector<double> value, slope, second_derivative;  ///< of the signal, d/dt, d^2/dt^2
  std::vector<double> slope_std_error, second_derivative_std_error;
};

/// Derivatives by local polynomials of least squares over 2 half + 1 samples at a distance of `step` (A. Savitzky, M.
/// J. E. Golay, Anal. Chem. 36 (1964) 1627, doi:10.1021/ac60214a047), of fourth degree about a sample. Where the signal
/// has a corner nearby, of third degree over a window that ends before it or begins behind it: of several windows that
/// hold the sample the one that leaves least (I. Gijbels, A. Lambert, P. Qiu, J. Nonparametric Statistics 19 (2007)
/// 77, doi:10.1080/10485250601097312). At a corner itself, which the window that ends there follows and the one that
/// begins there, half of the difference of their slopes is an error too. Errors are those of independent noise, as
/// large as most windows show it. A signal shorter than a window: shorter windows; fewer than 7 samples: all
/// derivatives are 0. corners: first samples behind corners that are known, ascending: windows beside one are narrower,
/// none reaches over it, and where two are too near for a window between them, errors are ten times as large. Cost:
/// proportional to samples times window.
LocalDerivatives local_derivatives(std::span<const double> signal, double step, std::size_t half,
                                   std::span<const std::size_t> corners = {});

/// The most samples to either side over which local_derivatives() predicts each sample from the others as well as over
/// any, within the standard error of that (leave-one-out cross-validation; a slope wants a wider window than a value).
/// Errors of the samples are taken as independent.
/// narrowest, widest: to be tried. Cost: that of local_derivatives() for some twenty windows.
std::size_t window_by_prediction(std::span<const double> signal, double step, std::size_t narrowest,
                                 std::size_t widest);

/// A sampled signal and its first two derivatives, all three as means over the same short stretch with the same
/// weights: what is linear in signal and derivatives holds of the means exactly, however fast the signal turns.
struct SmoothedDerivatives {
  std::vector<double> value, slope, second_derivative;                ///< of the signal, d/dt, d^2/dt^2
  double variance = 0;                                                ///< of the weights over time [s^2]
  double value_gain = 0, slope_gain = 0, second_derivative_gain = 0;  ///< standard error of each over that of a sample
  std::size_t reach = 0;                                              ///< samples to either side that a mean takes
};

/// Weights are a bell (Gaussian with a third of `half` as its standard deviation, cut at `half`) over the triangle of
/// two sampling intervals, of which central differences are the means; the mean of the signal itself over it is
/// Numerov's, (x_(i-1) + 10 x_i + x_(i+1))/12. Within `reach` samples of the ends the signal and 0 stand. half >= 3.
/// Cost: proportional to samples times window.
SmoothedDerivatives smoothed_derivatives(std::span<const double> signal, double step, std::size_t half);

/// Puts the mean of its two neighbours in the place of a lone sample that is far from it, in units of what samples
/// usually are, and farther than the signal goes from sample to sample there; returns their number. A signal that
/// repeats its values in three samples of four has none.
std::size_t remove_lone_samples(std::vector<double>& signal);

}  // namespace tribofit
