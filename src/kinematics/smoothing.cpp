#include "smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "limits.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit::kinematics {

namespace {

/// The steepest fall of the pull as a half period of a sine [rad/s], which it is in a slip and in free oscillation: a
/// pull that falls by 2 A falls at A omega at the most.
double frequency_of_steepest_fall(std::span<const double> pull, double step, std::size_t half) {
  const std::vector<double> slope = savitzky_golay_slope(pull, step, half);
  const auto steepest = static_cast<std::size_t>(std::min_element(slope.begin(), slope.end()) - slope.begin());
  std::size_t begin = steepest, end = steepest;
  while (begin > 0 && slope[begin - 1] < 0) --begin;
  while (end + 1 < slope.size() && slope[end + 1] < 0) ++end;
  const double amplitude = 0.5 * (pull[begin] - pull[end]);
  return amplitude > 0 ? std::max(0.0, -slope[steepest] / amplitude) : 0;
}

}  // namespace

std::size_t half_window(double frequency, double step) {
  const double samples = kPartOfPeriod * 2 * std::numbers::pi / (frequency * step);
  return std::max(kShortestHalf, static_cast<std::size_t>(std::round(samples)));
}

double frequency_of_falls(std::span<const double> pull, double step) {
  constexpr double kWider = 1.15;
  constexpr std::size_t kTooWide = 2;
  const std::size_t widest = std::min(kWidestHalf, pull.size() / 20);
  std::vector<double> frequencies;
  std::vector<std::size_t> halves;
  for (std::size_t half = kShortestHalf; half <= widest;
       half = std::max(half + 1, static_cast<std::size_t>(kWider * static_cast<double>(half)))) {
    frequencies.push_back(frequency_of_steepest_fall(pull, step, half));
    halves.push_back(half);
    if (!(frequencies.back() > 0)) break;
  }
  double found = frequencies.empty() ? 0 : frequencies.front(), least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k + 1 < frequencies.size(); ++k) {
    if (!(frequencies[k + 1] > 0) || halves[k] > kTooWide * half_window(frequencies[k], step)) continue;
    const double change = std::abs(std::log(frequencies[k + 1] / frequencies[k])) +
                          std::abs(std::log(frequencies[k] / frequencies[k - 1]));
    if (change >= least) continue;
    least = change;
    found = frequencies[k];
  }
  return found;
}

}  // namespace tribofit::kinematics
