#pragma once

#include <complex>
#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// Next even length with no prime factor above five, n or more: the transform of another may take as many steps for
/// each value as its largest prime factor has ones.
std::size_t fast_length(std::size_t n);

/// Hann's window over n values, sin^2 (pi (i + shift)/n).
std::vector<double> hann_window(std::size_t n, double shift = 0);

/// Fourier transform of real values with zeros behind them, up to `size` of them, which is even: the lines at
/// 0 ... size/2 periods. All transforms of the library are made here, by Eigen.
std::vector<std::complex<double>> fourier_lines(std::span<const double> values, std::size_t size);

/// The values, `size` of them, whose lines these are.
std::vector<double> values_of_lines(const std::vector<std::complex<double>>& lines, std::size_t size);

/// Squares of the lines.
std::vector<double> periodogram(std::span<const double> values, std::size_t size);

}  // namespace tribofit
