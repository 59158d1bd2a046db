#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

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

}  // namespace tribofit
