#include "tribofit/statistics/slow_noise.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include "fourier.hpp"
#include "limits.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {

namespace {

/// Squares of the Fourier transform of a series over its length, at frequencies finer than it resolves.
struct Resolved {
  std::vector<double> frequency, power;  ///< per value, from kFewestPeriods periods in the series up to a half
  double resolved = 0;                   ///< values that are independent of each other, as a part of all of them
};

/// About its mean. window: Hann's, which keeps a line and a slope at their own frequencies, its zeros between values.
Resolved resolved_periodogram(std::span<const double> series, const std::vector<double>& window) {
  // Of values about one frequency so many are worth one: n sum(w^4) / sum(w^2)^2 of the Hann window
  // (P. D. Welch, IEEE Trans. Audio Electroacoust. 15 (1967) 70).
  constexpr double kBandwidth = 35.0 / 18;
  const auto n = static_cast<double>(series.size());
  const std::size_t size = std::bit_ceil(series.size());
  double mean = 0, weights = 0;
  for (const double x : series) mean += x / n;
  for (const double w : window) weights += w * w;
  std::vector<double> windowed(window);
  for (std::size_t i = 0; i < series.size(); ++i) windowed[i] *= series[i] - mean;
  const std::vector<double> squares = periodogram(windowed, size);
  Resolved out;
  out.resolved = n / kBandwidth / static_cast<double>(size);
  for (std::size_t j = 1; j < squares.size(); ++j) {
    const double f = static_cast<double>(j) / static_cast<double>(size);
    if (f * n < kFewestPeriods) continue;
    out.frequency.push_back(f);
    out.power.push_back(squares[j] / weights);
  }
  return out;
}

/// Spectrum of slow noise: of an autoregression of that memory, or 1/f (0), with covariance_of_flicker().
std::vector<double> slow_spectrum(std::vector<double> frequency, double memory = 0) {
  for (double& f : frequency) {
    const double swing = std::cos(2 * std::numbers::pi * f);
    f = memory > 0 ? (1 - memory * memory) / (1 - 2 * memory * swing + memory * memory) : 1 / f;
  }
  return frequency;
}

/// power: a of the noise, see slow_noise().
std::vector<double> covariance_of_flicker(std::size_t n, double power) {
  const std::size_t longer = std::bit_ceil(kLonger * n);
  std::vector<double> spectrum(longer, 0.0), out(n);
  for (std::size_t j = 1; j < longer; ++j) spectrum[j] = 1 / static_cast<double>(std::min(j, longer - j));
  const auto covariance = fourier_lines(spectrum, longer);
  for (std::size_t k = 0; k < n; ++k) out[k] = covariance[k].real() * power;
  return out;
}

/// Of several series of one length, about a parabola in each: the median at every frequency, which is that of an
/// exponential distribution.
Resolved median_periodogram(std::span<const std::span<const double>> stretches) {
  std::vector<Resolved> all;
  const std::vector<double> window = hann_window(stretches.front().size(), 0.5);
  for (const auto& stretch : stretches) {
    const Parabola parabola = fit_parabola(stretch);
    std::vector<double> left(stretch.begin(), stretch.end());
    for (std::size_t i = 0; i < left.size(); ++i) left[i] -= parabola.at(static_cast<double>(i) - parabola.centre());
    all.push_back(resolved_periodogram(left, window));
  }
  Resolved out = all.front();
  std::vector<double> values(all.size());
  for (std::size_t j = 0; j < out.power.size(); ++j) {
    for (std::size_t k = 0; k < all.size(); ++k) values[k] = all[k].power[j];
    out.power[j] = median(values) / std::numbers::ln2;
  }
  // A median of n such values errs by 1/sqrt(n), its mean by ln 2 of that.
  out.resolved *= static_cast<double>(all.size()) * std::numbers::ln2 * std::numbers::ln2;
  return out;
}

/// Independent noise plus slow noise of one shape, as likely as it can be.
struct Likeliest {
  double slow = 0;         ///< factor of the shape
  double independent = 0;  ///< variance
  double log_likelihood = -std::numeric_limits<double>::infinity();
  double gain = 0;  ///< of that over independent noise alone
};

Likeliest likeliest(const Resolved& seen, const std::vector<double>& shape) {
  Likeliest best;
  constexpr double kStep = 1.5;
  const auto n = static_cast<double>(seen.power.size());
  const auto try_ratio = [&](double ratio) {  // of slow to independent noise
    double scale = 0, logs = 0;
    for (std::size_t j = 0; j < seen.power.size(); ++j) {
      const double expected = 1 + ratio * shape[j];
      scale += seen.power[j] / expected / n;
      logs += std::log(expected);
    }
    const double likelihood = -seen.resolved * (logs + n * std::log(scale));
    if (scale > 0 && likelihood > best.log_likelihood) best = {ratio * scale, scale, likelihood};
  };
  try_ratio(0);
  const double without = best.log_likelihood;
  for (double ratio = 1 / kMostSlow; ratio < kMostSlow; ratio *= kStep) try_ratio(ratio);
  best.gain = best.log_likelihood - without;
  return best;
}

constexpr double kMemories[] = {0.3, 0.5, 0.65, 0.8, 0.9, 0.95};

/// The same where no value of the periodogram counts for more than chance would give the largest of them.
Likeliest robust_fit(Resolved seen, const std::vector<double>& shape) {
  constexpr int kRounds = 3;
  const double most = -std::log(kChanceOfLine / (seen.resolved * static_cast<double>(seen.power.size())));
  Likeliest out = likeliest(seen, shape);
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t j = 0; j < seen.power.size(); ++j) {
      seen.power[j] = std::min(seen.power[j], most * (out.independent + out.slow * shape[j]));
    }
    out = likeliest(seen, shape);
  }
  return out;
}

SlowNoise slow_noise_of(std::span<const double> series) {
  const std::size_t n = series.size();
  if (n < kFewestOfSpectrum) return {};
  const Resolved seen = resolved_periodogram(series, hann_window(n, 0.5));
  double squares = 0, left = 0;
  for (const double x : series) squares += x * x;
  for (const double x : seen.power) left += x;
  if (!(left > kRounding * squares)) return {};
  const Likeliest of_flicker = robust_fit(seen, slow_spectrum(seen.frequency));
  Likeliest best;
  double memory = 0;
  for (const double m : kMemories) {
    const Likeliest own = robust_fit(seen, slow_spectrum(seen.frequency, m));
    if (own.log_likelihood > best.log_likelihood) best = own, memory = m;
  }
  SlowNoise out;
  if (std::max(best.gain, of_flicker.gain) < kPriceOfParameter) return out;
  if (best.log_likelihood > of_flicker.log_likelihood + kClearlyLikelier) {
    for (std::size_t k = 0; k < n; ++k) out.covariance.push_back(best.slow * std::pow(memory, static_cast<double>(k)));
  } else if (of_flicker.slow > 0) {
    out.is_flicker = true;
    out.covariance = covariance_of_flicker(n, of_flicker.slow);
  }
  return out;
}

}  // namespace

double SlowNoise::variance_of_sum(std::span<const double> weights) const {
  const std::size_t n = std::min(covariance.size(), weights.size());
  if (n == 0) return 0;
  const std::vector<double> products = products_at_every_lag(weights.first(n), weights.first(n));
  double sum = 0;
  for (std::size_t k = 0; k < n; ++k) sum += (k == 0 ? 1 : 2) * covariance[k] * products[n - 1 + k];
  return std::max(0.0, sum);
}

double SlowNoise::variance_within() const {
  const std::size_t n = covariance.size();
  if (n == 0) return 0;
  return std::max(0.0, covariance[0] - variance_of_sum(std::vector<double>(n, 1 / static_cast<double>(n))));
}

SlowNoise slow_noise(std::span<const double> series, double known_flicker) {
  SlowNoise out = slow_noise_of(series);
  if (!(known_flicker > 0) || series.empty()) return out;
  std::vector<double> known = covariance_of_flicker(series.size(), known_flicker);
  if (out.covariance.empty() || out.covariance[0] < known[0]) out = {std::move(known), true};
  return out;
}

double flicker_power(std::span<const std::span<const double>> stretches) {
  if (stretches.size() < kFewestStretches || stretches.front().size() < kFewestOfLine) return 0;
  const Resolved seen = median_periodogram(stretches);
  const Likeliest of_flicker = likeliest(seen, slow_spectrum(seen.frequency));
  if (of_flicker.gain < kPriceOfParameter) return 0;
  for (const double memory : kMemories) {
    const Likeliest other = likeliest(seen, slow_spectrum(seen.frequency, memory));
    if (other.log_likelihood > of_flicker.log_likelihood + kClearlyLikelier) return 0;
  }
  return of_flicker.slow;
}

}  // namespace tribofit
