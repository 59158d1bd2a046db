#include "spectral_lines.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "limits.hpp"
#include "starts.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/spectrum.hpp"

namespace tribofit {

namespace {

constexpr std::size_t kSideBySide = 4;  // a rotation waits for the one before it: others fill the time

/// Amplitudes of lines of these frequencies in the residual, slips one after the other: |sum r e^(-i w t)|.
std::array<double, kSideBySide> strengths(const Observations& observations, std::span<const double> residual,
                                          const std::array<double, kSideBySide>& frequencies) {
  std::array<double, kSideBySide> real{}, imaginary{}, x{}, y{}, turn_x{}, turn_y{}, out{};
  for (const auto& slip : observations.slips) {
    if (slip.record != 0 || slip.end == slip.begin) continue;
    // Equal steps within a slip: one rotation a value.
    const double step = (observations.time[slip.end - 1] - observations.time[slip.begin]) /
                        static_cast<double>(std::max<std::size_t>(1, slip.end - slip.begin - 1));
    for (std::size_t k = 0; k < kSideBySide; ++k) {
      const double w = -(2 * std::numbers::pi) * frequencies[k], at = w * observations.time[slip.begin];
      x[k] = std::cos(at), y[k] = std::sin(at);
      turn_x[k] = std::cos(w * step), turn_y[k] = std::sin(w * step);
    }
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const double value = observations.weight[i] * residual[i];
      for (std::size_t k = 0; k < kSideBySide; ++k) {
        real[k] += value * x[k];
        imaginary[k] += value * y[k];
        const double turned = x[k] * turn_x[k] - y[k] * turn_y[k];
        y[k] = x[k] * turn_y[k] + y[k] * turn_x[k];
        x[k] = turned;
      }
    }
  }
  for (std::size_t k = 0; k < kSideBySide; ++k) out[k] = std::hypot(real[k], imaginary[k]);
  return out;
}

/// Median time from break-away to the end of a slip [s]; 0 where fewer than three slips begin with a break-away.
double median_slip_time(const Observations& observations) {
  std::vector<double> lengths;
  for (const auto& slip : observations.slips) {
    if (slip.from_stick && slip.end > slip.begin) {
      lengths.push_back(observations.time[slip.end - 1] - slip.break_away_time);
    }
  }
  if (lengths.size() < kFewestCycles) return 0;
  return median(std::move(lengths));
}

/// The frequency with so many periods in a slip; 0 where there is none.
double frequency_of(double periods, const Observations& observations) {
  const double length = median_slip_time(observations);
  return length > 0 ? periods / length : 0;
}

}  // namespace

double observation_rate(const Observations& observations) {
  double slowest = 0;
  for (const auto& slip : observations.slips) {
    const std::size_t n = slip.end - slip.begin;
    if (n < 3) continue;
    const double rate = static_cast<double>(n - 2) / (observations.time[slip.end - 2] - observations.time[slip.begin]);
    slowest = slowest > 0 ? std::min(slowest, rate) : rate;
  }
  return slowest;
}

double lowest_steady_line(const Observations& observations) {
  const double line = observations.noise.empty() ? 0 : observations.noise[0].line;
  const double shown = frequency_of(kFewestPeriodsOfLine, observations);
  return line > 0 ? std::min(shown, kBelowLineInStick * line) : shown;
}

double lowest_ringing(const Observations& observations) {
  return frequency_of(kFewestPeriodsOfRing, observations);
}

namespace {

/// Adds to `series`, sampled at `rate` from time 0, what is left of a stick about a parabola.
void add_stick(const Motion& motion, const SampleRange& stick, double rate, std::vector<double>& series) {
  if (stick.size() < kShortestStickOfLine) return;
  const auto friction = std::span<const double>(motion.friction).subspan(stick.begin, stick.size());
  const Parabola parabola = fit_parabola(friction);
  for (std::size_t i = 0; i < stick.size(); ++i) {
    const auto at = static_cast<std::size_t>((motion.time[stick.begin + i] - motion.time[0]) * rate);
    const double left = friction[i] - parabola.at(static_cast<double>(i) - parabola.centre());
    if (at < series.size()) series[at] = left;
  }
}

/// Squares that a sinusoid takes off a series where it is not zero. frequency: in periods a sample.
double squares_of_line(std::span<const double> series, double frequency) {
  Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
  Eigen::Vector2d right = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < series.size(); ++i) {
    if (series[i] == 0) continue;
    const double phase = (2 * std::numbers::pi) * frequency * static_cast<double>(i);
    const Eigen::Vector2d wave(std::cos(phase), std::sin(phase));
    normal += wave * wave.transpose();
    right += wave * series[i];
  }
  return right.dot(normal.ldlt().solve(right));
}

}  // namespace

LineInStick line_in_stick(const Record& record, double noise) {
  const Motion& motion = *record.motion;
  if (motion.size() < kFewestTransformed || !(motion.step > 0)) return {0, noise};
  std::vector<double> series(std::min(motion.size(), kMostTransformed / 2), 0.0);
  double squares = 0;
  std::size_t count = 0;
  for (const Cycle& cycle : record.segmentation->cycles) add_stick(motion, cycle.stick, 1 / motion.step, series);
  for (const double x : series) {
    squares += x * x;
    count += x != 0 ? 1 : 0;
  }
  if (count < kFewestOfStickLine) return {0, noise};
  const Spectrum spectrum = amplitude_spectrum(series, motion.step);
  const double frequency = peak_frequency(spectrum, 0, 0.5 / motion.step);
  const double line = squares_of_line(series, frequency * motion.step), rest = squares - line;
  if (line < kLineInNoise * squares) return {0, noise};
  // The noise that was given may have lost a part of a slow line already.
  return {frequency,
          std::min(noise, std::sqrt(std::max(rest, kLeftBesideLine * squares) / static_cast<double>(count)))};
}

namespace {

/// Takes the highest peaks of a spectrum between two frequencies, each with its neighbourhood. A line that is there in
/// slip alone, or in stick alone, has side lines at the frequency of stick-slip, and what a law leaves of every slip is
/// made of them.
std::vector<double> take_peaks(Spectrum spectrum, double lowest, double highest) {
  std::vector<double> peaks;
  while (peaks.size() < kMostLines) {
    const double peak = peak_frequency(spectrum, lowest, highest);
    if (!(peak > 0)) break;
    peaks.push_back(peak);
    const auto bin = static_cast<std::size_t>(std::lround(peak / spectrum.bin_width));
    const std::size_t end = std::min(spectrum.amplitude.size(), bin + kBinsOfLine + 1);
    for (std::size_t k = bin - std::min(bin, kBinsOfLine); k < end; ++k) spectrum.amplitude[k] = 0;
  }
  return peaks;
}

}  // namespace

SpectralLines strongest_lines(const Record& record, const Observations& observations, std::span<const double> residual,
                              double lowest, double highest, int threads) {
  SpectralLines lines;
  const Motion& motion = *record.motion;
  const double rate = observation_rate(observations);
  if (!(rate > 0) || observations.slips.empty()) return lines;
  highest = std::min(highest, kHighestLine * rate);
  const double length = std::min(motion.duration(), static_cast<double>(kMostTransformed) / rate);
  const auto n = static_cast<std::size_t>(length * rate);
  if (n < kFewestTransformed || highest <= lowest) return lines;
  std::vector<double> series(n, 0.0);
  for (const auto& slip : observations.slips) {
    if (slip.record != 0) continue;
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const auto at = static_cast<std::size_t>((observations.time[i] - motion.time[0]) * rate);
      if (at < n) series[at] = residual[i];
    }
  }
  for (const Cycle& cycle : record.segmentation->cycles) add_stick(motion, cycle.stick, rate, series);
  // The whole record resolves more finely than the stretch that was transformed.
  const double width = kBesidePeak / length, fine = kFinerThanBin / motion.duration();
  constexpr double kPartsOfPeak = 5;             // a peak is as wide as four such steps
  std::vector<std::pair<double, double>> found;  // strength and frequency
  for (const double coarse : take_peaks(amplitude_spectrum(series, 1 / rate), lowest, highest)) {
    const auto strongest = [&](double middle, double beside, double step) {
      std::vector<std::pair<double, double>> tried;
      for (double f = middle - beside; f <= middle + beside; f += step) tried.push_back({0, f});
      run_tasks((tried.size() + kSideBySide - 1) / kSideBySide, threads, [&](std::size_t group) {
        const std::size_t first = group * kSideBySide, count = std::min(kSideBySide, tried.size() - first);
        std::array<double, kSideBySide> frequencies{};
        for (std::size_t k = 0; k < count; ++k) frequencies[k] = tried[first + k].second;
        const std::array<double, kSideBySide> own = strengths(observations, residual, frequencies);
        for (std::size_t k = 0; k < count; ++k) tried[first + k].first = own[k];
      });
      return tried.empty() ? std::pair{-1.0, coarse} : *std::max_element(tried.begin(), tried.end());
    };
    const double step = kPartsOfPeak * fine;
    found.push_back(strongest(strongest(coarse, width, step).second, step - fine, fine));
  }
  std::sort(found.rbegin(), found.rend());
  for (const auto& [strength, frequency] : found) lines.frequencies.push_back(frequency);
  lines.places = std::max(1.0, (highest - lowest) * motion.duration());
  return lines;
}

SpectralLines LinesOfRecord::find(const Record& record, const Observations& observations, double lowest, double highest,
                                  int threads) {
  const std::lock_guard lock(looking_);
  const bool known =
      found_ && found_->values == observations.size() && found_->lowest == lowest && found_->highest == highest;
  if (!known) {
    found_ = {observations.size(), lowest, highest,
              strongest_lines(record, observations, about_mean_curve(observations), lowest, highest, threads)};
  }
  return found_->lines;
}

SpectralLines strongest_ringing(const Observations& observations, std::span<const double> residual, double lowest) {
  SpectralLines line;
  const double rate = observation_rate(observations);
  if (!(rate > 0)) return line;
  const auto n = static_cast<std::size_t>(kRingsWithin * median_slip_time(observations) * rate);
  if (n < kFewestOfRing) return line;
  std::vector<double> total(n, 0.0), count(n, 0.0);
  for (const auto& slip : observations.slips) {
    if (!slip.from_stick) continue;
    for (std::size_t i = slip.begin; i < slip.end; ++i) {
      const auto at = static_cast<std::size_t>((observations.time[i] - slip.break_away_time) * rate);
      if (at >= n) break;
      total[at] += slip.direction * residual[i];
      count[at] += 1;
    }
  }
  for (std::size_t i = 0; i < n; ++i) total[i] = count[i] > 0 ? total[i] / count[i] : 0;
  // What is slower than the lowest frequency is the law's: take it out by a moving mean over one period.
  const auto half = static_cast<std::size_t>(0.5 * rate / lowest);
  std::vector<double> fast(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t begin = i - std::min(i, half), end = std::min(n, i + half + 1);
    double mean = 0;
    for (std::size_t k = begin; k < end; ++k) mean += total[k] / static_cast<double>(end - begin);
    fast[i] = total[i] - mean;
  }
  const double peak = peak_frequency(amplitude_spectrum(fast, 1 / rate), lowest, kHighestRing * rate);
  if (peak > 0) line.frequencies.push_back(peak);
  line.places = static_cast<double>(n) / 2;
  return line;
}

}  // namespace tribofit
