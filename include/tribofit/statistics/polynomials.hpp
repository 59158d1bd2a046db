#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// Straight line of least squares.
struct StraightLine {
  double middle = 0;   ///< mean abscissa, weighted
  double value = 0;    ///< of the line at `middle`: the mean ordinate
  double slope = 0;    ///< 0 where the abscissa does not vary
  double squares = 0;  ///< weighted sum of squares of the abscissa about `middle`; the slope's variance is that of one
                       ///< ordinate over it
  double at(double x) const { return value + slope * (x - middle); }
};

/// Line through samples at 0, 1, 2 ... All zero where there are none.
StraightLine fit_line(std::span<const double> samples);

/// Line through points (x, y) of equal weight, or of weights >= 0, as many as points and not all zero.
StraightLine fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weights = {});

/// What a fit leaves of samples in order.
struct Remainder {
  double squares = 0, products = 0;  ///< sums of r_i^2 and of r_i r_(i-1)
  double count = 0, last = 0;        ///< of samples; the last residual
  void add(double residual) {
    squares += residual * residual;
    products += residual * last;
    count += 1;
    last = residual;
  }
  /// Another stretch: its first residual is no neighbour of the last one here.
  Remainder& operator+=(const Remainder& other) {
    return *this = {squares + other.squares, products + other.products, count + other.count, other.last};
  }
  /// Correlation of neighbours, between 0 and `most` < 1.
  double correlation(double most) const { return squares > 0 ? std::clamp(products / squares, 0.0, most) : 0; }
};

/// By how much noise whose neighbours are correlated by rho, and by rho^k over k samples, makes the variance of a mean
/// larger: (1 + rho) / (1 - rho).
inline double variance_inflation(double rho) {
  return (1 + rho) / (1 - rho);
}

/// Parabola of least squares through samples at equal distances, in orthogonal polynomials:
/// y(x) = mean + slope x + curvature (x^2 - shift), x = i - (n-1)/2 samples from the middle. The three coefficients are
/// independent, so that without `curvature` it is the straight line.
struct Parabola {
  double count = 0;
  double mean = 0;
  double slope = 0;      ///< per sample; 0 for fewer than two samples
  double curvature = 0;  ///< per sample squared; 0 for fewer than three
  double centre() const { return 0.5 * (count - 1); }
  double shift() const { return (count * count - 1) / 12; }
  /// Sums over the samples of x^2 and of (x^2 - shift)^2, by which the variances of slope and curvature divide.
  double line_norm() const { return count * shift(); }
  double curvature_norm() const { return line_norm() * (count * count - 4) / 15; }
  /// Value and slope at x samples from the middle.
  double at(double x) const { return mean + slope * x + curvature * (x * x - shift()); }
  double slope_at(double x) const { return slope + 2 * curvature * x; }
};

/// Cost: linear, one pass.
Parabola fit_parabola(std::span<const double> samples);

/// Residuals of samples in order about `parabola`: their squares, and the products of neighbours.
Remainder remainder_about(const Parabola& parabola, std::span<const double> samples);

/// Where the parabola through three values at -1, 0 and 1 has its extreme, within half a step of the middle one, which
/// is the largest; 0 where it has none.
double peak_between(double before, double middle, double after);

/// Noise whose neighbours are correlated, and by its powers over more samples.
struct CorrelatedNoise {
  double deviation = 0, correlation = 0;
};

/// The noise of which parabolas through `stretches` stretches of like length left `all`: the parabolas made it smaller
/// and less correlated, by what an autoregression of first order lets expect.
CorrelatedNoise noise_about_parabolas(const Remainder& all, double stretches);

/// Weights of the samples of a window whose sums of products are the value and the slope [1/sample] of their parabola
/// of least squares at one of them (A. Savitzky, M. J. E. Golay, Anal. Chem. 36 (1964) 1627, doi:10.1021/ac60214a047).
struct ParabolaWeights {
  std::vector<double> value, slope;
};

/// At the sample with `left` others before it and `right` behind; left + right >= 2.
ParabolaWeights parabola_weights(std::size_t left, std::size_t right);

/// Slope of a parabola through 2*half_window+1 samples about each sample, per unit of `step`, the distance of samples.
/// The ends take it from the first and last full window; a signal that is shorter than one takes the longest that fits.
/// Returns as many values as samples. Cost: linear, whatever the window.
std::vector<double> savitzky_golay_slope(std::span<const double> signal, double step, std::size_t half_window);

}  // namespace tribofit
