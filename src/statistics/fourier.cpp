#include "fourier.hpp"

#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace tribofit {
namespace {

/// Keeps what it has prepared for the last length: many series of one length follow one another.
Eigen::FFT<double>& transform_of(std::size_t size) {
  thread_local std::size_t prepared = 0;
  thread_local Eigen::FFT<double> fft;
  if (size != prepared) {
    fft = Eigen::FFT<double>();
    fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
    prepared = size;
  }
  return fft;
}

}  // namespace

std::size_t fast_length(std::size_t n) {
  for (;; ++n) {
    std::size_t rest = n;
    for (const std::size_t p : {2u, 3u, 5u}) {
      while (rest > 0 && rest % p == 0) rest /= p;
    }
    if (rest == 1 && n % 2 == 0) return n;
  }
}

std::vector<double> hann_window(std::size_t n, double shift) {
  std::vector<double> window(n);
  const double step = 2 * std::numbers::pi / static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) window[i] = 0.5 * (1 - std::cos(step * (static_cast<double>(i) + shift)));
  return window;
}

std::vector<std::complex<double>> fourier_lines(std::span<const double> values, std::size_t size) {
  std::vector<double> padded(values.begin(), values.end());
  padded.resize(size, 0.0);
  std::vector<std::complex<double>> lines;
  transform_of(size).fwd(lines, padded);
  return lines;
}

std::vector<double> values_of_lines(const std::vector<std::complex<double>>& lines, std::size_t size) {
  std::vector<double> values;
  transform_of(size).inv(values, lines, static_cast<Eigen::Index>(size));
  return values;
}

std::vector<double> periodogram(std::span<const double> values, std::size_t size) {
  std::vector<double> power;
  for (const std::complex<double>& line : fourier_lines(values, size)) power.push_back(std::norm(line));
  return power;
}

}  // namespace tribofit
