#include "derivatives.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "limits.hpp"
#include "linear_algebra.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

constexpr int kDegreeAbout = 4, kDegreeBeside = 3;

/// Polynomials over a window: an orthonormal basis of their values, and how it gives the derivatives.
class PolynomialWindow {
 public:
  PolynomialWindow(std::size_t count, int degree) : count_(static_cast<Eigen::Index>(count)) {
    Eigen::MatrixXd powers(count_, degree + 1);
    for (Eigen::Index i = 0; i < count_; ++i) {
      double power = 1;
      for (Eigen::Index k = 0; k <= degree; ++k, power *= abscissa(static_cast<double>(i))) powers(i, k) = power;
    }
    const Eigen::MatrixXd factor = inverse_triangular_factor(powers);
    basis_ = powers * factor;
    inverse_ = factor * basis_.transpose();
  }

  /// Squares that the polynomial leaves of samples, over its degrees of freedom.
  double left(const double* samples) const {
    const Eigen::Map<const Eigen::VectorXd> y(samples, count_);
    const Eigen::VectorXd about = y.array() - y(count_ / 2);  // else rounding of a large offset remains
    const double squares = about.squaredNorm() - (basis_.transpose() * about).squaredNorm();
    return std::max(0.0, squares) / static_cast<double>(std::max<Eigen::Index>(1, count_ - basis_.cols()));
  }

  /// Weights of the samples that give the derivative of an order at sample `at`, per sample distance.
  Eigen::RowVectorXd weights(int order, std::size_t at) const {
    const double x = abscissa(static_cast<double>(at)), scale = std::pow(2 / static_cast<double>(count_ - 1), order);
    Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(inverse_.rows());
    for (Eigen::Index k = order; k < inverse_.rows(); ++k) {
      double factor = scale;
      for (Eigen::Index j = 0; j < order; ++j) factor *= static_cast<double>(k - j);
      row(k) = factor * std::pow(x, static_cast<double>(k - order));
    }
    return row * inverse_;
  }

 private:
  /// From -1 to 1.
  double abscissa(double i) const { return 2 * i / static_cast<double>(count_ - 1) - 1; }

  Eigen::Index count_;
  Eigen::MatrixXd basis_, inverse_;
};

/// A position of a sample in its window, with what gives the signal and its derivatives there.
struct Stencil {
  std::size_t at = 0;
  std::array<Eigen::RowVectorXd, 3> weights;  ///< by the order of the derivative
  std::array<double, 3> noise_gain{};         ///< norms of the weights

  Stencil(const PolynomialWindow& window, std::size_t where) : at(where) {
    for (std::size_t order = 0; order < 3; ++order) {
      weights[order] = window.weights(static_cast<int>(order), where);
      noise_gain[order] = weights[order].norm();
    }
  }
  double operator()(std::size_t order, std::span<const double> signal, std::size_t i) const {
    return weights[order].dot(Eigen::Map<const Eigen::RowVectorXd>(&signal[i - at], weights[order].size()));
  }
};

/// What windows leave, by their first sample.
std::vector<double> left_by_windows(std::span<const double> signal, const PolynomialWindow& window, std::size_t count) {
  std::vector<double> left;
  for (std::size_t begin = 0; begin + count <= signal.size(); ++begin) left.push_back(window.left(&signal[begin]));
  return left;
}

/// Samples between two known corners, [begin, end), of n in all.
struct Piece {
  std::size_t begin, end;
  bool holds(std::size_t first, std::size_t count) const { return first >= begin && first + count <= end; }
};

Piece piece_with(std::size_t i, std::span<const std::size_t> corners, std::size_t n) {
  const auto next = std::upper_bound(corners.begin(), corners.end(), i);
  return {next == corners.begin() ? 0 : *(next - 1), next == corners.end() ? n : std::min(*next, n)};
}

using Weights = std::vector<double>;

Weights bell(std::size_t half) {
  const double deviation = static_cast<double>(half) / 3;
  Weights weights;
  double sum = 0;
  for (std::size_t i = 0; i <= 2 * half; ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(half)) / deviation;
    weights.push_back(std::exp(-0.5 * x * x));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

/// Weights of a bell of the results of a stencil over three samples.
Weights over(const Weights& bell, const std::array<double, 3>& stencil) {
  Weights out(bell.size() + 2, 0.0);
  for (std::size_t i = 0; i < bell.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) out[i + k] += bell[i] * stencil[k];
  }
  return out;
}

}  // namespace

LocalDerivatives local_derivatives(std::span<const double> signal, double step, std::size_t half,
                                   std::span<const std::size_t> corners) {
  constexpr std::size_t kFewest = 7;
  const std::size_t n = signal.size();
  LocalDerivatives out;
  out.value.assign(signal.begin(), signal.end());
  for (auto* derivative : {&out.slope, &out.second_derivative, &out.slope_std_error, &out.second_derivative_std_error})
    derivative->assign(n, 0.0);
  if (n < kFewest) return out;
  half = std::clamp<std::size_t>(half, kFewest / 2, (n - 1) / 2);
  const std::size_t count = 2 * half + 1;
  const PolynomialWindow about(count, kDegreeAbout), beside(count, kDegreeBeside);
  const std::vector<double> left_about = left_by_windows(signal, about, count),
                            left_beside = left_by_windows(signal, beside, count);
  const Stencil middle(about, half);
  std::vector<Stencil> places;  // of every position at the ends of the signal; five of them beside corners
  for (std::size_t at = 0; at < count; ++at) places.emplace_back(beside, at);
  std::vector<Stencil> narrower;  // about samples beside known corners
  for (std::size_t h = kFewest / 2; h < half && !corners.empty(); ++h)
    narrower.emplace_back(PolynomialWindow(2 * h + 1, kDegreeAbout), h);
  const double usual = median(left_about);
  out.noise = std::sqrt(usual);
  const std::array<std::size_t, 4> tried = {0, half / 2, count - 1 - half / 2, count - 1};
  constexpr double kTooNear = 10;
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    Piece piece = piece_with(i, corners, n);
    const double widening = piece.end - piece.begin < count ? kTooNear : 1;
    if (widening > 1) piece = {0, n};
    const bool whole = i >= piece.begin + half && i + half < piece.end;
    const Stencil* best = whole ? &middle : &places[i < piece.begin + half ? i - piece.begin : i + count - piece.end];
    const std::size_t free =
        std::min(piece.begin > 0 ? i - piece.begin : half, piece.end < n ? piece.end - 1 - i : half);
    if (!whole && free < half && free >= kFewest / 2 && i >= free && i + free < n) best = &narrower[free - kFewest / 2];
    double least = whole ? left_about[i - half] : 0;
    std::array<double, 2> slopes = {};  // before the sample and behind it, where it may be the corner
    if (whole && least > kCornerSquares * usual) {
      const double about_sample = least;
      for (const std::size_t at : tried) {
        if (i < at || !piece.holds(i - at, count)) continue;
        const bool is_better = kBetterWindow * left_beside[i - at] <= about_sample;
        if (is_better && (at == 0 || at + 1 == count)) slopes[at == 0] = places[at](1, signal, i) / step;
        if (kBetterWindow * left_beside[i - at] > least) continue;
        best = &places[at];
        least = left_beside[i - at] / kBetterWindow;
      }
    }
    out.value[i] = (*best)(0, signal, i);
    out.slope[i] = (*best)(1, signal, i) / step;
    out.second_derivative[i] = (*best)(2, signal, i) / (step * step);
    const double unknown = slopes[0] != 0 && slopes[1] != 0 ? 0.5 * (slopes[1] - slopes[0]) : 0;
    out.slope_std_error[i] = std::hypot(widening * out.noise * best->noise_gain[1] / step, unknown);
    out.second_derivative_std_error[i] = widening * out.noise * best->noise_gain[2] / (step * step);
    const double of_itself = best->weights[0](static_cast<Eigen::Index>(best->at));
    if (of_itself < 1) squares += std::pow((signal[i] - out.value[i]) / (1 - of_itself), 2);
  }
  out.prediction_error = std::sqrt(squares / static_cast<double>(n));
  return out;
}

std::size_t window_by_prediction(std::span<const double> signal, double step, std::size_t narrowest,
                                 std::size_t widest) {
  std::vector<std::pair<std::size_t, double>> tried;
  for (std::size_t half = narrowest; half <= std::max(narrowest, widest); half += 1 + half / 4)
    tried.emplace_back(half, local_derivatives(signal, step, half).prediction_error);
  const double least = std::ranges::min_element(tried, {}, [](const auto& one) { return one.second; })->second;
  const double as_good = least * (1 + std::sqrt(0.5 / static_cast<double>(signal.size())));
  return std::find_if(tried.rbegin(), tried.rend(), [&](const auto& one) { return one.second <= as_good; })->first;
}

SmoothedDerivatives smoothed_derivatives(std::span<const double> signal, double step, std::size_t half) {
  SmoothedDerivatives out;
  out.reach = half + 1;
  const Weights weights = bell(half);
  const double squared = step * step;
  const std::array<std::array<double, 3>, 3> stencils = {
      {{1.0 / 12, 10.0 / 12, 1.0 / 12}, {-0.5 / step, 0, 0.5 / step}, {1 / squared, -2 / squared, 1 / squared}}};
  const std::array means = {&out.value, &out.slope, &out.second_derivative};
  const std::array gains = {&out.value_gain, &out.slope_gain, &out.second_derivative_gain};
  for (std::size_t k = 0; k < stencils.size(); ++k) {
    const Weights own = over(weights, stencils[k]);
    *gains[k] = std::sqrt(std::inner_product(own.begin(), own.end(), own.begin(), 0.0));
    means[k]->assign(signal.size(), 0.0);
    if (k == 0) means[k]->assign(signal.begin(), signal.end());
    for (std::size_t i = out.reach; i + out.reach < signal.size(); ++i)
      (*means[k])[i] = std::inner_product(own.begin(), own.end(), &signal[i - out.reach], 0.0);
  }
  out.variance = squared / 6;  // of the triangle
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(half)) * step;
    out.variance += weights[i] * x * x;
  }
  return out;
}

std::size_t remove_lone_samples(std::vector<double>& signal) {
  const std::size_t n = signal.size();
  if (n < 5) return 0;
  const std::vector<double> x = signal;
  const auto off = [&](std::size_t i) { return std::abs(x[i] - 0.5 * (x[i - 1] + x[i + 1])); };
  std::vector<double> distances;
  for (std::size_t i = 1; i + 1 < n; ++i) distances.push_back(off(i));
  constexpr double kUpperQuarter = 1.1503;  // of a normal distribution, in standard deviations
  const double limit = kLoneSample * quantile(std::move(distances), 0.75) / kUpperQuarter;
  std::size_t found = 0;
  for (std::size_t i = 2; i + 2 < n; ++i) {
    const double beside =
        std::max({std::abs(x[i + 1] - x[i - 1]), std::abs(x[i + 2] - x[i + 1]), std::abs(x[i - 1] - x[i - 2])});
    if (!(limit > 0) || off(i) <= limit || off(i) <= kLoneSteepness * beside) continue;
    signal[i] = 0.5 * (x[i - 1] + x[i + 1]);
    ++found;
  }
  return found;
}

}  // namespace tribofit
