#include "smoothed_derivatives.hpp"

#include <array>
#include <cmath>

namespace tribofit {

namespace {

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

double norm(const Weights& weights) {
  double squares = 0;
  for (const double w : weights) squares += w * w;
  return std::sqrt(squares);
}

}  // namespace

SmoothedDerivatives smoothed_derivatives(std::span<const double> signal, double step, std::size_t half) {
  const Weights weights = bell(half);
  const Weights value = over(weights, {1.0 / 12, 10.0 / 12, 1.0 / 12});
  const Weights slope = over(weights, {-0.5 / step, 0, 0.5 / step});
  const Weights second_derivative = over(weights, {1 / (step * step), -2 / (step * step), 1 / (step * step)});
  const std::size_t n = signal.size();
  SmoothedDerivatives out;
  out.value.assign(signal.begin(), signal.end());
  out.slope.assign(n, 0.0);
  out.second_derivative.assign(n, 0.0);
  out.reach = half + 1;
  out.value_gain = norm(value);
  out.slope_gain = norm(slope);
  out.second_derivative_gain = norm(second_derivative);
  constexpr double kOfTriangle = 1.0 / 6;
  out.variance = kOfTriangle * step * step;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double x = (static_cast<double>(i) - static_cast<double>(half)) * step;
    out.variance += weights[i] * x * x;
  }
  for (std::size_t i = out.reach; i + out.reach < n; ++i) {
    double v = 0, s = 0, b = 0;
    for (std::size_t k = 0; k < value.size(); ++k) {
      const double x = signal[i - out.reach + k];
      v += value[k] * x;
      s += slope[k] * x;
      b += second_derivative[k] * x;
    }
    out.value[i] = v;
    out.slope[i] = s;
    out.second_derivative[i] = b;
  }
  return out;
}

}  // namespace tribofit
