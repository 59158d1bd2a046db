#include "tribofit/statistics/spectrum.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <numbers>

#include "fourier.hpp"
#include "limits.hpp"
#include "reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {
namespace {

/// About its mean, under the window.
std::vector<double> windowed(std::span<const double> signal) {
  std::vector<double> out = hann_window(signal.size());
  const double mean = mean_of(signal);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] *= signal[i] - mean;
  return out;
}

/// Of a sine that leaves these squares in the periodogram of as many values under the window.
double amplitude_of(double squares, std::size_t values) {
  return 4 * std::sqrt(squares) / static_cast<double>(values);
}

/// Square of the sum of windowed values at any frequency, per value.
double power_at(const std::vector<double>& values, double frequency) {
  const std::complex<double> turn = std::polar(1.0, -(2 * std::numbers::pi) * frequency);
  std::complex<double> phase{1, 0}, sum{0, 0};
  for (const double x : values) {
    sum += x * phase;
    phase *= turn;
  }
  return std::norm(sum);
}

// Short slips are pulses, whose harmonics can exceed the fundamental: a line of half the height at a half, a third ...
// a tenth of the strongest is taken for what it is.
std::size_t fundamental_bin(const std::vector<double>& lines, std::size_t strongest) {
  for (std::size_t divisor = kHighestHarmonic; divisor >= 2; --divisor) {
    const std::size_t near = strongest / divisor;
    if (near <= kFewestPeriods) continue;
    const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(near - 1);
    const auto peak = std::max_element(begin, begin + 3 + static_cast<std::ptrdiff_t>(near / 50));
    if (*peak > kFundamentalHeight * lines[strongest]) return static_cast<std::size_t>(peak - lines.begin());
  }
  return strongest;
}

SpectralPeak strongest_line(std::span<const double> signal, double step) {
  const Spectrum spectrum = amplitude_spectrum(signal, step);
  const auto& lines = spectrum.amplitude;
  if (lines.size() <= kFewestPeriods + 1) return {};
  const auto strongest =
      static_cast<std::size_t>(std::max_element(lines.begin() + kFewestPeriods, lines.end()) - lines.begin());
  const auto bin = static_cast<double>(fundamental_bin(lines, strongest));
  const std::vector<double> values = windowed(signal);
  const double per_value = spectrum.bin_width * step;
  const auto cost = [&](double bins) { return -power_at(values, (bin + bins) * per_value); };
  // Between the neighbouring bins the windowed spectrum has one maximum, or rises towards another line beyond one of
  // them.
  const bool is_lower = cost(-0.25) < cost(0.25);
  const auto [beside, least] =
      boost::math::tools::brent_find_minima(cost, is_lower ? -1.0 : -0.25, is_lower ? 0.25 : 1.0, kBitsOfPlace);
  return {(bin + beside) * spectrum.bin_width, amplitude_of(-least, signal.size())};
}

double block_transmission(double frequency, double block) {
  const double x = std::numbers::pi * frequency * block;
  return x > 0 ? std::sin(x) / x : 1;
}

/// Of means over blocks, what they take away given back.
SpectralPeak strongest_line(std::span<const double> signal, double step, std::size_t block) {
  const BlockMeans reduced = block_means(signal, block, step);
  SpectralPeak line = strongest_line(reduced.mean, reduced.step);
  line.amplitude /= block_transmission(line.frequency, reduced.length > 1 ? reduced.step : 0);
  return line;
}

}  // namespace

Spectrum amplitude_spectrum(std::span<const double> signal, double step) {
  Spectrum spectrum;
  if (signal.size() < 4 || !(step > 0)) return spectrum;
  const std::size_t size = fast_length(signal.size());
  spectrum.bin_width = 1 / (static_cast<double>(size) * step);
  spectrum.amplitude = periodogram(windowed(signal), size);
  for (double& a : spectrum.amplitude) a = amplitude_of(a, signal.size());
  return spectrum;
}

Spectrum spectrum_up_to(std::span<const double> signal, double step, double top) {
  if (signal.size() < kFewestOfSpectrum || !(step > 0) || !(top > 0)) return {};
  top = std::min(top, 0.5 / step);
  const auto every = static_cast<std::size_t>(std::max(1.0, 1 / (kSamplesPerPeriod * top * step)));
  const BlockMeans reduced = block_means(signal, every, step);
  if (2 * reduced.mean.size() < kFewestOfSpectrum) return {};
  Spectrum out = amplitude_spectrum(reduced.mean, reduced.step);
  out.amplitude.resize(std::min(out.amplitude.size(), static_cast<std::size_t>(top / out.bin_width) + 1));
  for (std::size_t k = 0; k < out.amplitude.size(); ++k) {
    out.amplitude[k] /= block_transmission(static_cast<double>(k) * out.bin_width, every > 1 ? reduced.step : 0);
  }
  return out;
}

double peak_frequency(const Spectrum& spectrum, double lowest, double highest) {
  std::size_t best = 0;
  for (std::size_t k = 1; k + 1 < spectrum.amplitude.size(); ++k) {
    const double f = spectrum.bin_width * static_cast<double>(k);
    if (f < lowest || f > highest) continue;
    if (best == 0 || spectrum.amplitude[k] > spectrum.amplitude[best]) best = k;
  }
  if (best == 0) return 0;
  const auto& a = spectrum.amplitude;
  return spectrum.bin_width * (static_cast<double>(best) + peak_between(a[best - 1], a[best], a[best + 1]));
}

Spectrum averaged_spectrum(std::span<const double> signal, double step, std::size_t segment,
                           std::size_t most_segments) {
  Spectrum average;
  if (signal.size() < 4) return average;
  segment = std::min(segment, signal.size());
  const std::size_t count = std::max<std::size_t>(1, std::min(most_segments, signal.size() / segment));
  const std::size_t stride = count > 1 ? (signal.size() - segment) / (count - 1) : 0;
  for (std::size_t s = 0; s < count; ++s) {
    const Spectrum part = amplitude_spectrum(signal.subspan(s * stride, segment), step);
    if (s == 0) average = {part.bin_width, std::vector<double>(part.amplitude.size(), 0.0)};
    for (std::size_t k = 0; k < part.amplitude.size(); ++k)
      average.amplitude[k] += part.amplitude[k] * part.amplitude[k];
  }
  for (double& a : average.amplitude) a = std::sqrt(a / static_cast<double>(count));
  return average;
}

SpectralPeak fundamental(std::span<const double> signal, double step, std::size_t plain_size) {
  if (signal.size() < 8 || !(step > 0)) return {};
  constexpr std::size_t most = kMostTransformedAtOnce;
  // The whole record, reduced, sees low lines; one stretch at the full rate sees what the reduction would have lost.
  const std::size_t reduction = (signal.size() + most - 1) / most;
  SpectralPeak line = strongest_line(signal, step, reduction);
  if (reduction > 1) {
    const SpectralPeak fast = strongest_line(signal.first(std::min(signal.size(), most)), step);
    if (fast.frequency > 0.5 / (step * static_cast<double>(reduction)) && fast.amplitude > line.amplitude) {
      const double block = 1 / (2 * kSamplesPerPeriod * fast.frequency * step);
      line = strongest_line(signal, step, std::max<std::size_t>(1, static_cast<std::size_t>(block)));
    }
  }
  const double bin_width = 1 / (static_cast<double>(plain_size) * step);
  return {line.frequency, line.amplitude, std::round(line.frequency / bin_width) * bin_width, bin_width};
}

std::vector<double> products_at_every_lag(std::span<const double> x, std::span<const double> y) {
  const std::size_t lags = x.size() + y.size() - 1, size = fast_length(lags);
  std::vector<std::complex<double>> lines = fourier_lines(x, size);
  const std::vector<std::complex<double>> factors = fourier_lines(std::vector<double>(y.rbegin(), y.rend()), size);
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k] *= factors[k];
  std::vector<double> products = values_of_lines(lines, size);
  products.resize(lags);
  return products;
}

}  // namespace tribofit
