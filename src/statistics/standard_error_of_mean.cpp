#include "tribofit/statistics/standard_error_of_mean.hpp"

#include <algorithm>
#include <boost/math/tools/minima.hpp>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "fourier.hpp"
#include "limits.hpp"
#include "reductions.hpp"
#include "tribofit/statistics/distributions.hpp"

namespace tribofit {

namespace {

void centre(std::vector<double>& x) {
  const double mean = mean_of(x);
  for (double& value : x) value -= mean;
}

/// First-order autocorrelation of a centred series, corrected for its small-sample bias, within [0, kMostCorrelation].
double first_autocorrelation(const std::vector<double>& d) {
  const auto n = static_cast<double>(d.size());
  double zero = 0, one = 0;
  for (std::size_t i = 0; i < d.size(); ++i) {
    zero += d[i] * d[i];
    if (i > 0) one += d[i] * d[i - 1];
  }
  if (zero <= 0) return 0;
  const double r = one / zero * n / (n - 1);
  return std::clamp(r + (1 + 3 * r) / n, 0.0, kMostCorrelation);
}

/// A series without what its first-order autoregression predicts, centred.
std::vector<double> prewhitened(const std::vector<double>& d, double r) {
  std::vector<double> w(d.size());
  w[0] = d[0] * std::sqrt(1 - r * r);
  for (std::size_t i = 1; i < d.size(); ++i) w[i] = d[i] - r * d[i - 1];
  centre(w);
  return w;
}

/// cos and sin of an angle that turns by the same step again and again: less work than the functions, and wrong by a
/// rounding for each step.
struct TurningAngle {
  double cosine, sine, cosine_of_step, sine_of_step;
  TurningAngle(double begin, double step)
      : cosine(std::cos(begin)), sine(std::sin(begin)), cosine_of_step(std::cos(step)), sine_of_step(std::sin(step)) {}
  void turn() {
    const double before = cosine;
    cosine = before * cosine_of_step - sine * sine_of_step;
    sine = before * sine_of_step + sine * cosine_of_step;
  }
};

/// A sine in a series, and the squares that it takes out.
struct SeriesLine {
  double frequency = 0;  ///< per value
  std::complex<double> amplitude;
  double squares = 0;
};

/// Least-squares sine of a frequency in a centred series.
SeriesLine sine_in(const std::vector<double>& d, double frequency) {
  TurningAngle z(0, 2 * std::numbers::pi * frequency);
  // Normal equations of cos, sin and a constant; the constant takes their means off.
  double cc = 0, ss = 0, cs = 0, c = 0, s = 0, xc = 0, xs = 0;
  for (const double x : d) {
    c += z.cosine, s += z.sine;
    cc += z.cosine * z.cosine, ss += z.sine * z.sine, cs += z.cosine * z.sine;
    xc += x * z.cosine, xs += x * z.sine;
    z.turn();
  }
  const auto n = static_cast<double>(d.size());
  cc -= c * c / n, ss -= s * s / n, cs -= c * s / n;
  const double determinant = cc * ss - cs * cs;
  if (!(determinant > 0)) return {};
  const double a = (xc * ss - xs * cs) / determinant, b = (xs * cc - xc * cs) / determinant;
  return {frequency, {a, b}, a * xc + b * xs};
}

/// The clearest line of a centred series; none where nothing stands out.
std::optional<SeriesLine> clearest_line(const std::vector<double>& d) {
  constexpr std::size_t kLeak = 4;  // bins on either side that hold some of a line
  const std::size_t n = d.size();
  if (n < kFewestOfLine) return std::nullopt;
  const std::size_t bins = fast_length(2 * n);  // half as wide as the record resolves, or a little less
  const std::vector<double> power = periodogram(prewhitened(d, first_autocorrelation(d)), bins);
  std::vector<double> up_to(power.size() + 1, 0.0);  // sums of the power below each bin
  for (std::size_t k = 0; k < power.size(); ++k) up_to[k + 1] = up_to[k] + power[k];
  std::size_t peak = 0;
  double least = kChanceOfPeriod / static_cast<double>(n);
  for (std::size_t k = kSlowestBinOfLine; k + 1 < power.size(); ++k) {
    if (power[k] < power[k - 1] || power[k] < power[k + 1]) continue;
    // The neighbourhood: an octave to either side, the line itself left out.
    const std::size_t first = std::max<std::size_t>(1, k / 2), last = std::min(power.size() - 1, 2 * k + 2 * kLeak);
    const std::size_t low = std::max(first, k + 1 - std::min(k + 1, kLeak)), high = std::min(last + 1, k + kLeak);
    const double sum = up_to[low] - up_to[first] + up_to[last + 1] - up_to[high];
    const auto count = static_cast<double>(low - first + last + 1 - high);
    const double independent = count * static_cast<double>(n) / static_cast<double>(bins);
    if (!(independent >= 4)) continue;
    const double chance = sum > 0 ? std::pow(1 + 2 * power[k] / sum, -independent) : 0;
    if (power[k] > 0 && chance < least) peak = k, least = chance;
  }
  if (peak == 0) return std::nullopt;
  const auto frequency_at = [&](double bin) { return bin / static_cast<double>(bins); };
  const double at = static_cast<double>(peak), last = 0.5 * static_cast<double>(bins) - 1;
  const double bin =
      boost::math::tools::brent_find_minima([&](double k) { return -sine_in(d, frequency_at(at + k)).squares; }, -1.0,
                                            std::min(1.0, last - at), kBitsOfPlace)
          .first;
  return sine_in(d, frequency_at(at + bin));
}

void take_out(const SeriesLine& line, std::vector<double>& d) {
  TurningAngle z(0, 2 * std::numbers::pi * line.frequency);
  for (double& x : d) {
    x -= line.amplitude.real() * z.cosine + line.amplitude.imag() * z.sine;
    z.turn();
  }
  centre(d);
}

/// Mean square, over its phase, of the mean of a line over n values.
double mean_square_of_mean(const SeriesLine& line, double n) {
  const double half = std::numbers::pi * line.frequency;
  const double kernel = std::sin(n * half) / (n * std::sin(half));
  return 0.5 * std::norm(line.amplitude) * kernel * kernel;
}

/// Mean square of the `count` lowest cosines of a series.
double lowest_cosines(const std::vector<double>& w, int count) {
  const auto n = static_cast<double>(w.size());
  double sum = 0;
  for (int j = 1; j <= count; ++j) {
    double projection = 0;
    TurningAngle z(0.5 * std::numbers::pi * j / n, std::numbers::pi * j / n);
    for (const double x : w) {
      projection += x * z.cosine;
      z.turn();
    }
    sum += 2 / n * projection * projection;
  }
  return sum;
}

}  // namespace

Estimate standard_error_of_mean(std::span<const double> series) {
  constexpr int kMostLines = 8, kFewestFrequencies = 2;
  const std::size_t n = series.size();
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  if (n < 3) return {mean_of(series), kUnknown};
  const auto count = static_cast<double>(n);
  const int frequencies = std::max(kFewestFrequencies, static_cast<int>(std::lround(0.4 * std::pow(count, 2.0 / 3.0))));
  std::vector<double> d(series.begin(), series.end());
  centre(d);
  double of_lines = 0;
  int freedom = frequencies;
  for (int k = 0; k < kMostLines; ++k) {
    const std::optional<SeriesLine> line = clearest_line(d);
    if (!line) break;
    const bool among = 2 * line->frequency * count <= frequencies + 1;
    if (among && freedom < kFewestFrequencies + 2) break;
    freedom -= among ? 2 : 0;
    of_lines += mean_square_of_mean(*line, count);
    take_out(*line, d);
  }
  const double r = first_autocorrelation(d);
  const double long_run_variance = lowest_cosines(prewhitened(d, r), frequencies) / freedom / ((1 - r) * (1 - r));
  return {mean_of(series), std::sqrt(long_run_variance / count + of_lines), static_cast<double>(freedom)};
}

Estimate mean_of_independent(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  return {mean_of(values), standard_deviation(values) / std::sqrt(n), n - 1};  // 0/0 where there are too few
}

Estimate mean_with_error(std::vector<double> values) {
  std::erase_if(values, [](double value) { return std::isnan(value); });
  return standard_error_of_mean(values);
}

Interval Estimate::interval95() const {
  const double half = t_quantile_95(degrees_of_freedom) * std_error;
  return {value - half, value + half};
}

}  // namespace tribofit
