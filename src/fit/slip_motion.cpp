#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "limits.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// Standard deviation of what a velocity does from sample to sample, by its third differences; what turns quickly
/// counts as noise here.
double roughness(std::span<const double> velocity) {
  std::vector<double> sizes;
  for (std::size_t i = 3; i < velocity.size(); ++i)
    sizes.push_back(std::abs(velocity[i] - 3 * velocity[i - 1] + 3 * velocity[i - 2] - velocity[i - 3]));
  return sizes.empty() ? 0 : kSigmaPerMad * median(sizes) / std::sqrt(20.0);
}

/// Variance of the slope of a line through 2 half + 1 values of noise of variance one.
double slope_variance(std::size_t half) {
  const auto w = static_cast<double>(half);
  return 3 / (w * (w + 1) * (2 * w + 1));
}

/// Whether slopes of a window differ from those of each shorter one by no more than noise makes them differ: windows
/// within each other share their noise, and their difference has the difference of their variances (Lepski 1991).
bool follows(std::span<const double> velocity, std::size_t half, double noise) {
  const std::vector<double> wide = savitzky_golay_slope(velocity, 1, half);
  for (const std::size_t shorter : kHalfWindows) {
    if (shorter >= half) continue;
    const std::vector<double> narrow = savitzky_golay_slope(velocity, 1, shorter);
    double squares = 0;
    for (std::size_t i = half; i + half < velocity.size(); ++i) squares += std::pow(wide[i] - narrow[i], 2);
    const double expected = noise * noise * (slope_variance(shorter) - slope_variance(half));
    if (squares > kFlattened * expected * static_cast<double>(velocity.size() - 2 * half)) return false;
  }
  return true;
}

/// Velocity of the block in a slip, of a long one in its first samples: what windows are compared over.
std::vector<double> block_velocity(const Motion& motion, const SampleRange& samples) {
  std::vector<double> velocity;
  const std::size_t end = std::min(samples.end, samples.begin + kMostLookedAt);
  for (std::size_t i = samples.begin; i < end; ++i)
    velocity.push_back(motion.disc_velocity_at(i) - motion.relative_velocity[i]);
  return velocity;
}

/// The widest half window, up to `most` samples, that does not flatten what the velocity of a slip of `length` samples
/// does above its noise. Fewer than four of them are not compared.
std::size_t half_window(std::span<const double> velocity, std::size_t length, std::size_t most, double noise) {
  // The same part of a slip at any rate leaves about the same noise.
  const double stretch = kWindowOfSlip * static_cast<double>(length * most);
  auto half = static_cast<std::size_t>(std::clamp(std::round(stretch), 2.0, static_cast<double>(most)));
  if (velocity.size() < 4 * half) return half;
  for (const std::size_t next : kHalfWindows) {
    if (next >= half) continue;
    if (follows(velocity, half, noise)) return half;
    half = next;
  }
  return half;
}

/// Sums of the samples about each one of a slip, by weights of their parabola there; the window stops at the slip's
/// end. Empty where there are too few samples.
template <class Sample>
std::vector<double> sums_about(const SampleRange& samples, std::size_t widest,
                               std::vector<double> ParabolaWeights::*kind, Sample&& sample) {
  const std::size_t begin = samples.begin - std::min(samples.begin, 2 * widest);
  if (samples.end - begin < 3) return {};
  const std::size_t half = std::min(widest, (samples.end - begin - 1) / 2);
  std::vector<double> sums, weights;
  std::size_t last_left = 0, last_right = 0;
  for (std::size_t i = samples.begin; i < samples.end; ++i) {
    const std::size_t before = std::min(half, i - begin);  // less at the beginning of a record
    const std::size_t right = std::min(2 * half - before, samples.end - 1 - i);
    const std::size_t left = std::min(i - begin, 2 * half - right);
    if (weights.empty() || left != last_left || right != last_right) weights = parabola_weights(left, right).*kind;
    last_left = left;
    last_right = right;
    double sum = 0;
    for (std::size_t k = 0; k <= left + right; ++k) sum += weights[k] * sample(i - left + k);
    sums.push_back(sum);
  }
  return sums;
}

}  // namespace

SlipMotion slip_motion(const Motion& motion, const SampleRange& samples) {
  const auto own = [&](const std::vector<double>& channel) {
    const std::span<const double> part = part_of(channel, samples.begin, samples.end);
    return std::vector<double>(part.begin(), part.end());
  };
  SlipMotion moves{own(motion.relative_velocity), own(motion.acceleration)};
  if (motion.is_points()) moves.acceleration.resize(samples.size(), 0.0);  // they have no time
  const std::vector<double> velocity = block_velocity(motion, samples);
  // A velocity that was made of another channel is as smooth as its noise demands, and that of a drive may jump.
  const bool was_made = !motion.velocity_std_error.empty() || !motion.acceleration.empty();
  const std::size_t half = half_window(velocity, samples.size(), kHalfWindows.front(), motion.velocity_noise);
  if (motion.sticks && !was_made && samples.size() >= 4 * half) {
    const auto read = [&](std::size_t i) { return motion.relative_velocity[i]; };
    moves.velocity = sums_about(samples, half, &ParabolaWeights::value, read);
  }
  if (!moves.acceleration.empty()) return moves;
  const auto scaled = [&](std::size_t i) {
    return (motion.disc_velocity_at(i) - motion.relative_velocity[i]) / motion.step;
  };
  const double noise = std::max(motion.velocity_noise, roughness(velocity));
  moves.acceleration = sums_about(samples, half_window(velocity, samples.size(), kWidestOfSlope, noise),
                                  &ParabolaWeights::slope, scaled);
  moves.acceleration.resize(samples.size(), 0.0);
  return moves;
}

}  // namespace tribofit
