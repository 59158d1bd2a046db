#include "tribofit/campaign/figures.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "fit/errors.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

constexpr std::size_t kBins = 40;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Sums over slip samples: of one bin, or of all.
struct Bin {
  std::size_t samples = 0, below = 0;  ///< those with an error below the limit of [D]
  double friction = 0, fitted = 0, relative = 0, largest = 0;

  void add(const Bin& more) {
    samples += more.samples;
    below += more.below;
    friction += more.friction;
    fitted += more.fitted;
    relative += more.relative;
    largest = std::max(largest, more.largest);
  }
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

std::vector<Bin> bins_of(const Fit& fit, const Record& one, const Observations& observations, double fastest) {
  std::vector<Bin> bins(kBins);
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
      if (measured[i] == 0) continue;
      const double e = std::abs((measured[i] - model[i]) / measured[i]);
      const double direction = model[i] < 0 ? -1 : 1;  // of the slip: noise may turn v round near rest
      const auto bin = static_cast<std::size_t>(std::abs(slip.velocity[i]) * bins_per_velocity);
      bins[std::min(bin, kBins - 1)].add(
          {1, e < published_error_limit ? std::size_t{1} : 0, direction * measured[i], direction * model[i], e, e});
    }
  }
  return bins;
}

ErrorCurve curve_of(const Fit& fit, const std::vector<Bin>& bins) {
  ErrorCurve curve;
  curve.law = to_string(fit.model.law());
  curve.protocol = to_string(fit.protocol);
  Bin all;
  std::size_t filled = 0, below = 0;
  for (const Bin& bin : bins) {
    all.add(bin);
    curve.fitted.push_back(mean(bin.fitted, bin.samples));
    curve.bin_mean_relative.push_back(mean(bin.relative, bin.samples));
    curve.bin_max_relative.push_back(bin.samples > 0 ? bin.largest : kNone);
    if (bin.samples == 0) continue;
    const double e = std::abs((bin.friction - bin.fitted) / bin.friction);
    ++filled;
    below += e < published_error_limit ? 1 : 0;
    curve.largest_of_bins = std::max(curve.largest_of_bins, e);
  }
  curve.below_limit = mean(static_cast<double>(all.below), all.samples);
  curve.bins_below_limit = mean(static_cast<double>(below), filled);
  curve.mean_relative = mean(all.relative, all.samples);
  curve.max_relative = all.samples > 0 ? all.largest : kNone;
  return curve;
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
    bins = bins_of(fit, one, *observations, fastest);
    figures.errors.push_back(curve_of(fit, bins));
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
