#include <algorithm>
#include <cmath>
#include <vector>

#include "tribofit/fit/observations.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {

std::vector<double> slip_acceleration(const Motion& motion, const SampleRange& samples) {
  // The same part of a slip at any rate leaves about the same noise; a longer one would flatten what turns quickly.
  constexpr double kPart = 0.015;
  const double stretch = kPart * static_cast<double>(samples.size());
  const std::size_t half = static_cast<std::size_t>(std::clamp(std::round(stretch), 2.0, 10.0));
  if (!motion.acceleration.empty()) {
    const std::span<const double> own = part_of(motion.acceleration, samples.begin, samples.end);
    return {own.begin(), own.end()};
  }
  const std::size_t begin = samples.begin - std::min(samples.begin, 2 * half);
  const std::size_t length = samples.end - begin;
  std::vector<double> acceleration(samples.size(), 0.0);
  if (length < 3) return acceleration;
  std::vector<double> weights;
  std::size_t last_left = 0, last_right = 0;
  for (std::size_t i = samples.begin; i < samples.end; ++i) {
    const std::size_t right = std::min(half, samples.end - 1 - i);
    const std::size_t left = std::min(i - begin, 2 * half - right);
    if (weights.empty() || left != last_left || right != last_right) weights = slope_weights(left, right);
    last_left = left;
    last_right = right;
    double slope = 0;
    for (std::size_t k = 0; k <= left + right; ++k) {
      const std::size_t at = i - left + k;
      slope += weights[k] * (motion.disc_velocity_at(at) - motion.relative_velocity[at]);
    }
    acceleration[i - samples.begin] = slope / motion.step;
  }
  return acceleration;
}

}  // namespace tribofit
