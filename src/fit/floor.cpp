#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit {

namespace {

/// What is left of samples [begin, end) about a parabola.
Remainder about_parabola(std::span<const double> x, std::size_t begin, std::size_t end) {
  const auto part = x.subspan(begin, end - begin);
  return remainder_about(fit_parabola(part), part);
}

/// Noise as the pooled spread, leaving out stretches that hold something else (an event, a transient, a drop-out).
/// A parabola takes three degrees of freedom from white noise, and (1+rho)/(1-rho) times as many from noise whose
/// neighbours are correlated by rho.
double pooled_noise(const std::vector<Remainder>& parts) {
  if (parts.empty()) return 0;
  std::vector<double> variances;
  for (const Remainder& part : parts) variances.push_back(part.squares / part.count);
  // The quiet quarter sets the scale: ringing after re-stick may fill most stretches of a short stick.
  const double limit = 3 * quantile(std::move(variances), 0.25);
  Remainder all;
  double used = 0;
  for (const Remainder& part : parts) {
    if (part.squares / part.count > limit) continue;
    all += part;
    used += 1;
  }
  if (!(all.squares > 0)) return 0;
  const double freedom = all.count - 3 * used * variance_inflation(all.correlation(0.97));
  return std::sqrt(all.squares / std::max(freedom, 0.25 * all.count));
}

double mean_count(const std::vector<Remainder>& parts) {
  double count = 0;
  for (const Remainder& part : parts) count += part.count / static_cast<double>(parts.size());
  return count;
}

bool is_spoilt(const Motion& motion, const SampleRange& samples) {
  for (std::size_t i = samples.begin; i < samples.end; ++i) {
    if (motion.has_fault(i, SampleFault::friction)) return true;
  }
  return false;
}

constexpr std::size_t kStretches = 1000;  ///< enough to know a spread to 0.2 %

/// Every stick without its ends, where the transients of re-stick and break-away are, in stretches of so many samples.
std::vector<Remainder> stick_residuals(const Motion& motion, const Segmentation& segmentation,
                                       std::size_t stretch = kLongestNoiseStretch) {
  std::vector<Remainder> parts;
  for (const Cycle& cycle : segmentation.cycles) {
    const std::size_t margin = cycle.stick.size() / 8;
    if (cycle.stick.size() < kShortestStick || !segmentation.is_selected(cycle)) continue;
    const std::size_t begin = cycle.stick.begin + margin, length = cycle.stick.size() - 2 * margin;
    const std::size_t pieces = std::max<std::size_t>(1, length / stretch);
    for (std::size_t k = 0; k < pieces; ++k) {
      const SampleRange piece{begin + k * length / pieces, begin + (k + 1) * length / pieces};
      if (!is_spoilt(motion, piece)) parts.push_back(about_parabola(motion.friction, piece.begin, piece.end));
    }
    if (parts.size() * stretch > kStretches * kLongestNoiseStretch) break;
  }
  return parts;
}

/// Stretches of the slips, as long as friction can be a parabola over them.
std::vector<Remainder> slip_residuals(const Motion& motion, const Segmentation& segmentation) {
  std::vector<Remainder> parts;
  const bool sticks = segmentation.kind == MotionKind::stick_slip;
  for (const Cycle& cycle : segmentation.cycles) {
    if (sticks && !segmentation.is_selected(cycle)) continue;
    const std::size_t stretch = noise_stretch(cycle.slip.size());
    for (std::size_t i = cycle.slip.begin; i + stretch <= cycle.slip.end; i += stretch) {
      if (segmentation.is_selected(SampleRange{i, i + stretch}) && !is_spoilt(motion, {i, i + stretch})) {
        parts.push_back(about_parabola(motion.friction, i, i + stretch));
      }
    }
  }
  return parts;
}

/// Standard deviation of the break-away level from cycle to cycle: what is left when its dependence on time, direction,
/// load, temperature and disc angle is taken out (such a dependence is not scatter), less what sensor noise does to
/// each level.
double break_away_scatter(const Motion& motion, const Segmentation& segmentation) {
  // At constant speed the angle is that of the clock; a long record need not be integrated for it.
  const bool steady = motion.disc_angle.empty() && motion.disc_speed.empty() && motion.conditions.speed.known();
  const std::vector<double> recorded = steady ? std::vector<double>() : disc_angle(motion);
  const auto angle = [&](std::size_t i) {
    return steady ? motion.conditions.speed.value * motion.time[i] : recorded[i];
  };
  const bool known = motion.size() > 0 && (steady || !recorded.empty());
  const bool turns = known && std::abs(angle(motion.size() - 1) - angle(0)) > 4 * std::numbers::pi;  // two revolutions
  std::vector<double> levels;
  std::vector<Eigen::VectorXd> rows;
  double noise = 0;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.stick.size() == 0 || !std::isfinite(cycle.break_away_friction)) continue;
    if (!segmentation.is_selected(cycle)) continue;
    const std::size_t i = cycle.slip.begin;
    const double u = motion.time[i] / motion.time.back();
    std::vector<double> row = {1, u, u * u, static_cast<double>(cycle.direction)};
    if (!motion.load.empty()) row.push_back(motion.load[i]);
    if (!motion.temperature.empty()) row.push_back(motion.temperature[i]);
    for (int h = 1; turns && h <= 3; ++h) {
      row.push_back(std::cos(h * angle(i)));
      row.push_back(std::sin(h * angle(i)));
    }
    rows.push_back(Eigen::Map<Eigen::VectorXd>(row.data(), static_cast<Eigen::Index>(row.size())));
    levels.push_back(cycle.break_away_friction);
    noise += std::pow(cycle.break_away_friction_std_error, 2);
  }
  const auto n = static_cast<Eigen::Index>(levels.size());
  if (n < 3) return 0;
  // Few cycles cannot carry many regressors.
  const Eigen::Index columns = std::min(rows[0].size(), std::max<Eigen::Index>(1, n / 8));
  Eigen::MatrixXd design(n, columns);
  for (Eigen::Index i = 0; i < n; ++i) design.row(i) = rows[static_cast<std::size_t>(i)].head(columns).transpose();
  const Eigen::Map<const Eigen::VectorXd> level(levels.data(), n);
  const RankedSolution fitted = least_squares_of_any_rank(design, level);
  const Eigen::VectorXd left = level - design * fitted.x;
  const double variance = left.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(1, n - fitted.rank)) -
                          noise / static_cast<double>(n);
  return std::sqrt(std::max(0.0, variance));
}

}  // namespace

FlickerInStick flicker_in_stick(const Motion& motion, const Segmentation& segmentation) {
  const auto longer = stick_residuals(motion, segmentation);
  const auto shorter = stick_residuals(motion, segmentation, kLongestNoiseStretch / kShorterNoiseStretch);
  FlickerInStick flicker;
  flicker.samples = mean_count(longer);
  const double ratio = flicker.samples / mean_count(shorter);
  if (!(ratio >= kLeastStretchRatio)) return flicker;
  const double growth = std::pow(pooled_noise(longer), 2) - std::pow(pooled_noise(shorter), 2);
  flicker.variance = std::max(0.0, growth) / std::log(ratio);
  return flicker;
}

Floor estimate_floor(const Motion& motion, const Segmentation& segmentation) {
  if (motion.is_points()) return noise_of_points(motion, segmentation);
  Floor floor;
  std::vector<Remainder> parts = stick_residuals(motion, segmentation);
  floor.source = "stick";
  if (parts.size() < 3) {
    parts = slip_residuals(motion, segmentation);
    floor.source = "slip";
  }
  floor.noise = pooled_noise(parts);
  floor.scatter = break_away_scatter(motion, segmentation);
  floor.rmse = floor.noise;
  return floor;
}

}  // namespace tribofit
