#include <algorithm>
#include <cmath>
#include <vector>

#include "tribofit/fit/fit.hpp"

namespace tribofit {

namespace {

/// Sum of squares about a parabola through samples [begin, end), with its degrees of freedom.
struct Residual {
  double squares = 0, freedom = 0;
  double variance() const { return squares / freedom; }
};

Residual about_parabola(const std::vector<double>& x, std::size_t begin, std::size_t end) {
  const std::size_t n = end - begin;
  const auto count = static_cast<double>(n);
  // Moments of the data about the first sample, over u in [-1, 1].
  double y0 = 0, y1 = 0, y2 = 0, yy = 0;
  const double scale = 2 / (count - 1);
  for (std::size_t i = 0; i < n; ++i) {
    const double u = scale * static_cast<double>(i) - 1, y = x[begin + i] - x[begin];
    y0 += y;
    y1 += u * y;
    y2 += u * u * y;
    yy += y * y;
  }
  // Sums of u^2 and u^4 over the grid; odd ones vanish.
  const double u2 = count * (count + 1) / (3 * (count - 1));
  const double u4 = u2 * (3 * count * count - 7) / (5 * (count - 1) * (count - 1));
  const double line = y1 * y1 / u2;
  const double curve = y2 - y0 * u2 / count;
  const double squares = yy - y0 * y0 / count - line - curve * curve / (u4 - u2 * u2 / count);
  return {std::max(0.0, squares), count - 3};
}

/// Noise as the pooled spread, leaving out stretches that hold something else (an event, a drop-out).
double pooled_noise(std::vector<Residual> parts) {
  if (parts.empty()) return 0;
  std::vector<double> variances;
  for (const Residual& part : parts) variances.push_back(part.variance());
  const auto middle = variances.begin() + static_cast<std::ptrdiff_t>(variances.size() / 2);
  std::nth_element(variances.begin(), middle, variances.end());
  const double limit = 3 * *middle;
  double squares = 0, freedom = 0;
  for (const Residual& part : parts) {
    if (part.variance() > limit) continue;
    squares += part.squares;
    freedom += part.freedom;
  }
  return freedom > 0 ? std::sqrt(squares / freedom) : 0;
}

constexpr std::size_t kShortestStick = 40;    ///< samples that can show a spread
constexpr std::size_t kLongestStretch = 2000;  ///< samples over which a ramp is a parabola

/// Middle of every stick: away from the transients of re-stick and break-away.
std::vector<Residual> stick_residuals(const Motion& motion, const Segmentation& segmentation) {
  std::vector<Residual> parts;
  for (const Cycle& cycle : segmentation.cycles) {
    const std::size_t margin = cycle.stick.size() / 8;
    if (cycle.stick.size() < kShortestStick) continue;
    const std::size_t begin = cycle.stick.begin + margin;
    const std::size_t end = std::min(cycle.stick.end - margin, begin + kLongestStretch);
    parts.push_back(about_parabola(motion.friction, begin, end));
  }
  return parts;
}

/// Stretches of the slips, as long as friction can be a parabola over them.
std::vector<Residual> slip_residuals(const Motion& motion, const Segmentation& segmentation) {
  std::vector<Residual> parts;
  for (const Cycle& cycle : segmentation.cycles) {
    const std::size_t stretch = std::clamp<std::size_t>(cycle.slip.size() / 4, 12, 400);
    for (std::size_t i = cycle.slip.begin; i + stretch <= cycle.slip.end; i += stretch) {
      parts.push_back(about_parabola(motion.friction, i, i + stretch));
    }
  }
  return parts;
}

/// Standard deviation of the break-away level, the part beyond what sensor noise does to it.
double break_away_scatter(const Segmentation& segmentation) {
  double sum = 0, squares = 0, noise = 0, n = 0;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.stick.size() == 0 || !std::isfinite(cycle.break_away_friction)) continue;
    sum += cycle.break_away_friction;
    squares += cycle.break_away_friction * cycle.break_away_friction;
    noise += std::pow(cycle.break_away_friction_std_error, 2);
    n += 1;
  }
  if (n < 3) return 0;
  const double variance = (squares - sum * sum / n) / (n - 1) - noise / n;
  return std::sqrt(std::max(0.0, variance));
}

}  // namespace

Floor estimate_floor(const Motion& motion, const Segmentation& segmentation) {
  Floor floor;
  std::vector<Residual> parts = stick_residuals(motion, segmentation);
  floor.source = "stick";
  if (parts.size() < 3) {
    parts = slip_residuals(motion, segmentation);
    floor.source = "slip";
  }
  floor.noise = pooled_noise(std::move(parts));
  floor.scatter = break_away_scatter(segmentation);
  floor.rmse = floor.noise;
  return floor;
}

}  // namespace tribofit
