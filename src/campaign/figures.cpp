#include "tribofit/campaign/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <span>

#include "fit/errors.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kBins = 40;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Sums over the slip samples of one bin.
struct Bin {
  std::size_t samples = 0;
  double friction = 0, fitted = 0, relative = 0, largest = 0;
};

double mean(double sum, std::size_t count) {
  return count > 0 ? sum / static_cast<double>(count) : kNone;
}

/// |v_r| of the fastest slip sample [m/s].
double fastest_slip(const Identification& result) {
  double fastest = 0;
  for (const Cycle& cycle : result.segmentation.cycles) {
    const std::size_t end = std::min(cycle.slip.end, result.motion.size());
    for (std::size_t i = cycle.slip.begin; i < end; ++i) {
      fastest = std::max(fastest, std::abs(result.motion.relative_velocity[i]));
    }
  }
  return fastest;
}

std::size_t bin_of(double velocity, double bins_per_velocity) {
  return std::min(static_cast<std::size_t>(std::abs(velocity) * bins_per_velocity), kBins - 1);
}

/// The error curve of one fit; the bins serve what all fits share.
ErrorCurve error_curve(const Fit& fit, const Record& one, const Observations& observations, double fastest,
                       std::vector<Bin>& bins) {
  bins.assign(kBins, {});
  std::size_t samples = 0, below = 0;
  double sum = 0, largest = 0;
  const std::vector<double> p = fit.values();
  const double bins_per_velocity = static_cast<double>(kBins) / fastest;
  const FullRecord record(std::span(&one, 1), observations, fit.model.needs());
  FullRecord::Made made;
  std::vector<double> model;  // of one slip at a time: a channel of the whole record would cost its pages
  for (const Observations::SlipObservation& range : observations.slips) {
    const Slip slip = record.slip(range, made);
    model.resize(slip.size());
    evaluate<double>(fit.model, p.data(), slip, slip.velocity, model);
    const std::span<const double> measured = record.friction(range);
    for (std::size_t i = 0; i < model.size(); ++i) {
      const double mu = measured[i], v = slip.velocity[i];
      if (mu == 0) continue;
      const double e = std::abs((mu - model[i]) / mu);
      Bin& bin = bins[bin_of(v, bins_per_velocity)];
      ++bin.samples;
      const double direction = model[i] < 0 ? -1 : 1;  // of the slip: noise may turn v round near rest
      bin.friction += direction * mu;
      bin.fitted += direction * model[i];
      bin.relative += e;
      bin.largest = std::max(bin.largest, e);
      ++samples;
      below += e < published_error_limit ? 1 : 0;
      sum += e;
      largest = std::max(largest, e);
    }
  }
  ErrorCurve curve;
  curve.law = to_string(fit.model.law());
  curve.protocol = to_string(fit.protocol);
  curve.below_limit = mean(static_cast<double>(below), samples);
  curve.mean_relative = mean(sum, samples);
  curve.max_relative = samples > 0 ? largest : kNone;
  return curve;
}

void add_bins(const std::vector<Bin>& bins, ErrorCurve& curve) {
  std::size_t filled = 0, below = 0;
  for (const Bin& bin : bins) {
    curve.fitted.push_back(mean(bin.fitted, bin.samples));
    curve.bin_mean_relative.push_back(mean(bin.relative, bin.samples));
    curve.bin_max_relative.push_back(bin.samples > 0 ? bin.largest : kNone);
    if (bin.samples == 0) continue;
    const double e = std::abs((bin.friction - bin.fitted) / bin.friction);
    ++filled;
    below += e < published_error_limit ? 1 : 0;
    curve.largest_of_bins = std::max(curve.largest_of_bins, e);
  }
  curve.bins_below_limit = mean(static_cast<double>(below), filled);
}

void add_errors(const Identification& result, RunFigures& figures) {
  const double fastest = fastest_slip(result);
  if (!(fastest > 0)) return;
  std::vector<Bin> bins;
  const Record one = {&result.motion, &result.segmentation};
  std::optional<Observations> observations;  // the same for fits with the same effects
  std::vector<std::string> effects;
  for (const Fit& fit : result.fits) {
    if (fit.parameters.empty()) continue;
    if (!observations || effects != fit.model.effect_keys()) {
      effects = fit.model.effect_keys();
      observations = observe(result.motion, result.segmentation, fit.model.needs());
    }
    figures.errors.push_back(error_curve(fit, one, *observations, fastest, bins));
    add_bins(bins, figures.errors.back());
  }
  if (figures.errors.empty()) return;
  figures.bin_width = fastest / kMillimetre / static_cast<double>(kBins);
  for (const Bin& bin : bins) {
    figures.bin_samples.push_back(bin.samples);
    figures.bin_friction.push_back(mean(bin.friction, bin.samples));
  }
}

/// Amplitude of the sine that has the power of the lines within half a fundamental. A Hann window of `length` [s]
/// spreads a sine over 1.5/length: lines closer than 1/length (the transform is padded) hold its square so much
/// oftener.
double amplitude_about(const Spectrum& spectrum, double length, double frequency, double half_width) {
  const double times = 1.5 / (length * spectrum.bin_width);
  const double last = static_cast<double>(spectrum.amplitude.size()) - 1;
  const auto line_at = [&](double f) {
    return static_cast<std::size_t>(std::clamp(std::ceil(f / spectrum.bin_width), 1.0, last));
  };
  double squares = 0;
  for (std::size_t k = line_at(frequency - half_width); k < line_at(frequency + half_width); ++k) {
    squares += spectrum.amplitude[k] * spectrum.amplitude[k];
  }
  return std::sqrt(squares / times);
}

void add_spectrum(const Identification& result, RunFigures& figures) {
  constexpr double kPublishedStretch = 32768 / 20e3;  // s, of the transform of [D]
  constexpr double kLeastPeriods = 5, kHarmonics = 8;
  const Motion& motion = result.motion;
  const double fundamental = result.spectral_peak.frequency;
  const double stretch = std::max(kPublishedStretch, kLeastPeriods / fundamental);
  if (!(fundamental > 0) || !(stretch < motion.duration())) return;
  const auto segment = static_cast<std::size_t>(std::round(stretch / motion.step));
  const Spectrum spectrum = averaged_spectrum(motion.relative_velocity, motion.step, segment);
  if (spectrum.amplitude.size() < 2) return;
  const double end = (kHarmonics + 0.5) * fundamental, length = static_cast<double>(segment) * motion.step;
  figures.spectrum_step = spectrum.bin_width;
  for (std::size_t k = 0; k < spectrum.amplitude.size() && static_cast<double>(k) * spectrum.bin_width <= end; ++k) {
    figures.spectrum.push_back(spectrum.amplitude[k] / kMillimetre);
  }
  for (double n = 1; n <= kHarmonics; ++n) {
    const double frequency = n * fundamental;
    if (frequency + 0.5 * fundamental > 0.5 / motion.step) break;
    const double amplitude = amplitude_about(spectrum, length, frequency, 0.5 * fundamental);
    figures.harmonics.push_back({frequency, amplitude / kMillimetre});
  }
}

/// At most `count` samples of a stretch, evenly, with its first and last.
void add_samples(const Motion& motion, SampleRange span, std::size_t count, RunFigures& figures) {
  const std::size_t size = span.size();
  count = std::min(count, size);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = span.begin + (count > 1 ? k * (size - 1) / (count - 1) : 0);
    figures.time.push_back(motion.time[i]);
    figures.velocity.push_back(motion.relative_velocity[i] / kMillimetre);
    figures.friction.push_back(motion.friction[i]);
  }
}

void add_cycles(const Identification& result, RunFigures& figures) {
  constexpr std::size_t kCycles = 3, kInStick = 20, kInSlip = 40;
  const std::vector<Cycle>& cycles = result.segmentation.cycles;
  const auto whole = [](const Cycle& c) { return c.stick_complete && c.slip_complete; };
  for (std::size_t first = 0; first + kCycles <= cycles.size(); ++first) {
    const std::span<const Cycle> shown = std::span(cycles).subspan(first, kCycles);
    if (!std::all_of(shown.begin(), shown.end(), whole)) continue;
    for (const Cycle& cycle : shown) {
      add_samples(result.motion, cycle.stick, kInStick, figures);
      add_samples(result.motion, cycle.slip, kInSlip, figures);
    }
    return;
  }
}

}  // namespace

RunFigures figures_of(const Identification& result) {
  RunFigures figures;
  add_errors(result, figures);
  add_spectrum(result, figures);
  add_cycles(result, figures);
  return figures;
}

}  // namespace tribofit
