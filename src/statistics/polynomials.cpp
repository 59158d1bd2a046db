#include "tribofit/statistics/polynomials.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

#include "limits.hpp"

namespace tribofit {

StraightLine fit_line(std::span<const double> samples) {
  if (samples.empty()) return {};
  const Parabola through = fit_parabola(samples);
  return {through.centre(), through.mean, through.slope, through.line_norm()};
}

StraightLine fit_line(std::span<const double> x, std::span<const double> y, std::span<const double> weights) {
  if (x.empty()) return {};
  const auto weight = [&](std::size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  double all = 0, sum_x = 0, sum_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    all += weight(i);
    sum_x += weight(i) * x[i];
    sum_y += weight(i) * y[i];
  }
  StraightLine line{sum_x / all, sum_y / all};
  double moment = 0, norm = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double u = x[i] - line.middle;
    line.squares += weight(i) * u * u;
    moment += weight(i) * u * (y[i] - line.value);
    norm += weight(i) * x[i] * x[i];
  }
  // The mean of equal abscissas may differ from them by rounding.
  if (line.squares > kRounding * norm) {
    line.slope = moment / line.squares;
  } else {
    line.squares = 0;
  }
  return line;
}

Parabola fit_parabola(std::span<const double> samples) {
  Parabola out;
  out.count = static_cast<double>(samples.size());
  if (samples.empty()) return out;
  const double centre = out.centre(), shift = out.shift(), origin = samples[0];  // keeps sums small beside a large mean
  double s0 = 0, s1 = 0, s2 = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double x = static_cast<double>(i) - centre, y = samples[i] - origin;
    s0 += y;
    s1 += x * y;
    s2 += (x * x - shift) * y;
  }
  out.mean = origin + s0 / out.count;
  if (samples.size() > 1) out.slope = s1 / out.line_norm();
  if (samples.size() > 2) out.curvature = s2 / out.curvature_norm();
  return out;
}

Remainder remainder_about(const Parabola& parabola, std::span<const double> samples) {
  Remainder out;
  const double centre = parabola.centre();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    out.add(samples[i] - parabola.at(static_cast<double>(i) - centre));
  }
  return out;
}

namespace {

/// Expected residuals about the parabola of noise of variance one: mean of their squares, and of the products of
/// neighbours. With the orthonormal columns Q of the parabola and the covariance C, of (I - QQ') C (I - QQ').
struct ExpectedRemainder {
  double squares = 1, products = 0;
};

ExpectedRemainder expected_about_parabola(std::size_t samples, double correlation) {
  using Row = Eigen::RowVector3d;
  Parabola through;
  through.count = static_cast<double>(samples);
  if (samples < 4) return {0, 0};
  const Row norms(through.count, through.line_norm(), through.curvature_norm());
  std::vector<Row> q(samples), cq(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double x = static_cast<double>(i) - through.centre();
    q[i] = Row(1, x, x * x - through.shift()).cwiseQuotient(norms.cwiseSqrt());
  }
  Row before = Row::Zero(), behind = Row::Zero();
  for (std::size_t i = 0; i < samples; ++i) cq[i] = before = correlation * before + q[i];
  for (std::size_t i = samples; i-- > 0;) cq[i] += correlation * behind, behind = correlation * behind + q[i];
  Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < samples; ++i) inner += q[i].transpose() * cq[i];
  double products = 0;
  for (std::size_t i = 1; i < samples; ++i) {
    products += correlation - q[i].dot(cq[i - 1]) - q[i - 1].dot(cq[i]) + (q[i] * inner).dot(q[i - 1]);
  }
  return {std::max(0.0, 1 - inner.trace() / through.count), products / (through.count - 1)};
}

}  // namespace

CorrelatedNoise noise_about_parabolas(const Remainder& all, double stretches) {
  const double pairs = all.count - stretches;
  if (!(all.squares > 0) || !(pairs > 0)) return {};
  const auto length = static_cast<std::size_t>(std::lround(all.count / stretches));
  const double variance = all.squares / all.count, left = all.products / pairs / variance;
  double low = 0, high = kMostCorrelation;
  while (high - low > kSameCorrelation) {
    const double middle = 0.5 * (low + high);
    const ExpectedRemainder expected = expected_about_parabola(length, middle);
    (expected.products < left * expected.squares ? low : high) = middle;
  }
  CorrelatedNoise noise;
  noise.correlation = low;
  noise.deviation = std::sqrt(variance / std::max(expected_about_parabola(length, low).squares, 1 - kLargestShare));
  return noise;
}

double peak_between(double before, double middle, double after) {
  const double curvature = before - 2 * middle + after;
  return curvature < 0 ? std::clamp(0.5 * (before - after) / curvature, -0.5, 0.5) : 0;
}

ParabolaWeights parabola_weights(std::size_t left, std::size_t right) {
  Parabola through;
  through.count = static_cast<double>(left + right + 1);
  const double place = static_cast<double>(left) - through.centre();
  ParabolaWeights weights;
  for (std::size_t i = 0; i <= left + right; ++i) {
    const double x = static_cast<double>(i) - through.centre();
    const double slope = x / through.line_norm(), curvature = (x * x - through.shift()) / through.curvature_norm();
    weights.value.push_back(1 / through.count + place * slope + (place * place - through.shift()) * curvature);
    weights.slope.push_back(slope + 2 * place * curvature);
  }
  return weights;
}

std::vector<double> savitzky_golay_slope(std::span<const double> signal, double step, std::size_t half_window) {
  const std::size_t n = signal.size();
  std::vector<double> slope(n, 0.0);
  if (n < 2) return slope;
  if (n < 3) {
    slope[0] = slope[1] = (signal[1] - signal[0]) / step;
    return slope;
  }
  const std::size_t half = std::max<std::size_t>(1, std::min(half_window, (n - 1) / 2));
  const double w = static_cast<double>(half);
  const double squares = w * (w + 1) * (2 * w + 1) / 3;
  constexpr std::size_t kRenew = 4096;  // running sums are computed afresh before rounding can gather
  double sum = 0, moment = 0;
  for (std::size_t i = half; i + half < n; ++i) {
    if ((i - half) % kRenew == 0) {
      sum = moment = 0;
      for (std::size_t k = 0; k <= 2 * half; ++k) {
        sum += signal[i - half + k];
        moment += (static_cast<double>(k) - w) * signal[i - half + k];
      }
    } else {
      const double in = signal[i + half], out = signal[i - half - 1];
      moment += (w + 1) * in + w * out - (sum + in - out);
      sum += in - out;
    }
    slope[i] = moment / (squares * step);
  }
  const Parabola first = fit_parabola(signal.first(2 * half + 1)), last = fit_parabola(signal.last(2 * half + 1));
  for (std::size_t k = 0; k < half; ++k) {
    slope[k] = first.slope_at(static_cast<double>(k) - w) / step;
    slope[n - 1 - k] = last.slope_at(w - static_cast<double>(k)) / step;
  }
  return slope;
}

}  // namespace tribofit
