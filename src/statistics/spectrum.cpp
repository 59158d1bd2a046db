#include "tribofit/statistics/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "fast_length.hpp"
#include "golden_section.hpp"
#include "limits.hpp"
#include "reductions.hpp"
#include "tribofit/statistics/parallel.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {
namespace {

// sin^2 window, periodic; by rotation instead of a cosine per sample.
class Hann {
 public:
  explicit Hann(std::size_t n) : step_(std::polar(1.0, (2 * std::numbers::pi) / static_cast<double>(n))) {}
  double next() {
    const double w = 0.5 * (1 - phase_.real());
    phase_ *= step_;
    return w;
  }

 private:
  std::complex<double> phase_{1, 0}, step_;
};

std::vector<std::complex<double>> transform(const std::vector<double>& values) {
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<std::complex<double>> lines;
  fft.fwd(lines, values);
  return lines;
}

/// The same, but for rounding, from the transforms of the even and of the odd values, which are made side by side
/// (G. C. Danielson, C. Lanczos, J. Franklin Inst. 233 (1942) 365).
std::vector<std::complex<double>> transform_of_halves(const std::vector<double>& values, int threads) {
  const std::size_t n = values.size();
  // Of a length that is no multiple of four Eigen makes the transform of a complex series, which is twice the work.
  if (n % 8 != 0 || n < kFewestOfHalves) return transform(values);
  std::array<std::vector<std::complex<double>>, 2> half;
  run_tasks(2, threads, [&](std::size_t k) {
    std::vector<double> own(n / 2);
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = values[2 * i + k];
    half[k] = transform(own);
  });
  std::vector<std::complex<double>> lines(n / 2 + 1);
  const std::complex<double> step = std::polar(1.0, -(2 * std::numbers::pi) / static_cast<double>(n));
  std::complex<double> turn{1, 0};
  for (std::size_t k = 0; k <= n / 4; ++k) {
    const std::complex<double> even = half[0][k], odd = turn * half[1][k];
    lines[k] = even + odd;
    lines[n / 2 - k] = std::conj(even - odd);
    turn *= step;
  }
  return lines;
}

// Amplitude of the sine of a given frequency under the window, by direct summation.
double amplitude_at(std::span<const double> signal, double mean, double step, double frequency) {
  Hann window(signal.size());
  const std::complex<double> turn = std::polar(1.0, -(2 * std::numbers::pi) * frequency * step);
  std::complex<double> phase{1, 0}, sum{0, 0};
  for (double x : signal) {
    sum += window.next() * (x - mean) * phase;
    phase *= turn;
  }
  return 4 * std::abs(sum) / static_cast<double>(signal.size());
}

struct Line {
  double frequency = 0, amplitude = 0;
};

// Short slips are pulses, whose harmonics can exceed the fundamental: a line of half the height at a half, a third ...
// a tenth of the strongest is taken for what it is.
std::size_t fundamental_bin(const std::vector<double>& lines, std::size_t strongest, std::size_t first) {
  for (std::size_t divisor = kHighestHarmonic; divisor >= 2; --divisor) {
    const std::size_t near = strongest / divisor;
    if (near <= first) continue;
    const auto begin = lines.begin() + static_cast<std::ptrdiff_t>(near - 1);
    const auto peak = std::max_element(begin, begin + 3 + static_cast<std::ptrdiff_t>(near / 50));
    if (*peak > kFundamentalHeight * lines[strongest]) return static_cast<std::size_t>(peak - lines.begin());
  }
  return strongest;
}

Line strongest_line(std::span<const double> signal, double step) {
  const Spectrum spectrum = amplitude_spectrum(signal, step);
  constexpr std::size_t first = kSlowestBin;
  if (spectrum.amplitude.size() <= first + 1) return {};
  const auto& lines = spectrum.amplitude;
  const auto strongest = static_cast<std::size_t>(std::max_element(lines.begin() + first, lines.end()) - lines.begin());
  const auto bin = static_cast<double>(fundamental_bin(lines, strongest, first));
  const double mean = mean_of(signal);
  // Golden section between the neighbouring bins: the windowed spectrum has one maximum there.
  constexpr int kSteps = 20;  // to 1e-4 of a bin
  const auto cost = [&](double frequency) { return -amplitude_at(signal, mean, step, frequency); };
  const Minimum peak = golden_section(cost, (bin - 1) * spectrum.bin_width, (bin + 1) * spectrum.bin_width, kSteps);
  return {peak.at, -peak.value};
}

double block_transmission(double frequency, double block) {
  const double x = std::numbers::pi * frequency * block;
  return x > 0 ? std::sin(x) / x : 1;
}

}  // namespace

Spectrum amplitude_spectrum(std::span<const double> signal, double step, int threads) {
  Spectrum spectrum;
  if (signal.size() < 4 || !(step > 0)) return spectrum;
  const std::size_t size = fast_length(signal.size());
  const double mean = mean_of(signal);
  std::vector<double> padded(size, 0.0);
  Hann window(signal.size());
  for (std::size_t i = 0; i < signal.size(); ++i) padded[i] = window.next() * (signal[i] - mean);
  const auto lines = transform_of_halves(padded, threads);
  spectrum.bin_width = 1 / (static_cast<double>(size) * step);
  spectrum.amplitude.reserve(lines.size());
  for (const auto& line : lines) {
    // Not std::abs: its care for squares that overflow costs time, and none does here.
    spectrum.amplitude.push_back(4 * std::sqrt(std::norm(line)) / static_cast<double>(signal.size()));
  }
  return spectrum;
}

Spectrum spectrum_up_to(std::span<const double> signal, double step, double top) {
  if (signal.size() < kFewestOfSpectrum || !(step > 0) || !(top > 0)) return {};
  top = std::min(top, 0.5 / step);
  const auto every = static_cast<std::size_t>(std::max(1.0, 1 / (kSamplesPerPeriod * top * step)));
  const BlockMeans reduced = block_means(signal, every, step);
  if (reduced.mean.size() < kFewestReduced) return {};
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
  SpectralPeak peak;
  if (signal.size() < 8 || !(step > 0)) return peak;
  constexpr std::size_t most = kMostTransformedAtOnce;
  // The whole record, reduced, sees low lines; one stretch at the full rate sees what the reduction would have lost.
  const std::size_t reduction = (signal.size() + most - 1) / most;
  const BlockMeans reduced = block_means(signal, reduction, step);
  Line line = strongest_line(reduced.mean, reduced.step);
  line.amplitude /= block_transmission(line.frequency, reduction > 1 ? reduced.step : 0);
  if (reduction > 1) {
    const Line fast = strongest_line(signal.first(std::min(signal.size(), most)), step);
    if (fast.frequency > 0.5 / reduced.step && fast.amplitude > line.amplitude) {
      const auto blocks = static_cast<std::size_t>(1 / (kSamplesPerRefined * fast.frequency * step));
      const BlockMeans finer = block_means(signal, std::max<std::size_t>(1, blocks), step);
      const Line refined = strongest_line(finer.mean, finer.step);
      line = {refined.frequency,
              refined.amplitude / block_transmission(refined.frequency, finer.length > 1 ? finer.step : 0)};
    }
  }
  peak.frequency = line.frequency;
  peak.amplitude = line.amplitude;
  peak.bin_width = 1 / (static_cast<double>(plain_size) * step);
  peak.bin_frequency = std::round(peak.frequency / peak.bin_width) * peak.bin_width;
  return peak;
}

std::vector<double> products_at_every_lag(std::span<const double> x, std::span<const double> y) {
  const std::size_t lags = x.size() + y.size() - 1, size = fast_length(lags);
  std::vector<double> first(size), second(size);
  std::copy(x.begin(), x.end(), first.begin());
  std::reverse_copy(y.begin(), y.end(), second.begin());
  std::vector<std::complex<double>> lines = transform(first);
  const std::vector<std::complex<double>> factors = transform(second);
  for (std::size_t k = 0; k < lines.size(); ++k) lines[k] *= factors[k];
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  std::vector<double> products;
  fft.inv(products, lines, static_cast<Eigen::Index>(size));
  products.resize(lags);
  return products;
}

}  // namespace tribofit
