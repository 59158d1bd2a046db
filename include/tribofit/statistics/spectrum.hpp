#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribofit {

/// The strongest line of a signal.
struct SpectralPeak {
  double frequency = 0;      ///< interpolated between bins [Hz]
  double amplitude = 0;      ///< of the sine at that frequency, in the signal's unit
  double bin_frequency = 0;  ///< nearest bin of a plain FFT as used by [D] [Hz]
  double bin_width = 0;      ///< [Hz]
};

/// One-sided amplitude spectrum of a signal with its mean removed.
struct Spectrum {
  double bin_width = 0;           ///< [Hz]
  std::vector<double> amplitude;  ///< amplitude[k] of the sine at k * bin_width, in the signal's unit
};

/// Amplitude spectrum (Hann window) of `signal` sampled every `step` seconds.
Spectrum amplitude_spectrum(std::span<const double> signal, double step);

/// The same up to the frequency `top` [Hz] (at most half the rate), of means over neighbours where that is far below
/// the rate, which costs less; what the means take away is given back. Empty for less than 16 samples.
Spectrum spectrum_up_to(std::span<const double> signal, double step, double top);

/// Frequency [Hz] of the highest value of a spectrum between two frequencies, interpolated by a parabola through it and
/// its neighbours; 0 where no bin lies between them.
double peak_frequency(const Spectrum& spectrum, double lowest, double highest);

/// Root mean square of the amplitude spectra of up to `most_segments` stretches of `segment` samples, spread evenly
/// over the signal: the noise of a single spectrum averaged down, at a cost that does not grow with the record.
Spectrum averaged_spectrum(std::span<const double> signal, double step, std::size_t segment = 4096,
                           std::size_t most_segments = 8);

/// The fundamental of a periodic signal: interpolated peak of the windowed spectrum of the whole record, beside the bin
/// a plain FFT of `plain_size` samples (32768 in [D]) would report. Signals are reduced before the transform where
/// their rate is far above the band.
SpectralPeak fundamental(std::span<const double> signal, double step, std::size_t plain_size = 32768);

/// Sums over i of x[i + lag] y[i], for every lag from 1 - y.size() to x.size() - 1 in this order. Neither is empty.
/// Cost: n log n.
std::vector<double> products_at_every_lag(std::span<const double> x, std::span<const double> y);

}  // namespace tribofit
