#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "limits.hpp"
#include "points.hpp"
#include "spectral_lines.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/execution/parallel.hpp"
#include "tribofit/execution/stop.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"
#include "tribofit/statistics/slow_noise.hpp"

namespace tribofit {

namespace {

/// What is left of samples [begin, end) about a parabola.
Remainder about_parabola(std::span<const double> x, std::size_t begin, std::size_t end) {
  const auto part = x.subspan(begin, end - begin);
  return remainder_about(fit_parabola(part), part);
}

/// Noise as the pooled spread, leaving out stretches that hold something else (an event, a transient, a drop-out).
CorrelatedNoise pooled_noise(const std::vector<Remainder>& parts) {
  if (parts.empty()) return {};
  std::vector<double> variances;
  for (const Remainder& part : parts) variances.push_back(part.squares / part.count);
  // The quiet quarter sets the scale: ringing after re-stick may fill most stretches of a short stick.
  const double limit = kLoudest * quantile(std::move(variances), 0.25);
  Remainder all;
  double used = 0;
  for (const Remainder& part : parts) {
    if (part.squares / part.count > limit) continue;
    all += part;
    used += 1;
  }
  return noise_about_parabolas(all, used);
}

bool is_spoilt(const Motion& motion, const SampleRange& samples, std::uint8_t channel = SampleFault::friction) {
  for (std::size_t i = samples.begin; i < samples.end; ++i) {
    if (motion.has_fault(i, channel)) return true;
  }
  return false;
}

constexpr std::size_t kStretches = 1000;  ///< enough to know a spread to 0.2 %

/// Every stick without its ends, where the transients of re-stick and break-away are.
std::vector<SampleRange> stick_stretches(const Motion& motion, const Segmentation& segmentation,
                                         std::uint8_t channel = SampleFault::friction) {
  std::vector<SampleRange> parts;
  for (const Cycle& cycle : segmentation.cycles) {
    const std::size_t margin = cycle.stick.size() / 8;
    if (cycle.stick.size() < kShortestStick || !segmentation.is_selected(cycle)) continue;
    const std::size_t begin = cycle.stick.begin + margin, length = cycle.stick.size() - 2 * margin;
    const std::size_t pieces = std::max<std::size_t>(1, length / kLongestNoiseStretch);
    for (std::size_t k = 0; k < pieces; ++k) {
      const SampleRange piece{begin + k * length / pieces, begin + (k + 1) * length / pieces};
      if (!is_spoilt(motion, piece, channel)) parts.push_back(piece);
    }
    if (parts.size() > kStretches) break;
  }
  return parts;
}

/// Stretches of the slips, as long as friction can be a parabola over them.
std::vector<SampleRange> slip_stretches(const Motion& motion, const Segmentation& segmentation) {
  std::vector<SampleRange> parts;
  const bool sticks = segmentation.kind == MotionKind::stick_slip;
  for (const Cycle& cycle : segmentation.cycles) {
    if (sticks && !segmentation.is_selected(cycle)) continue;
    const std::size_t stretch = noise_stretch(cycle.slip.size());
    for (std::size_t i = cycle.slip.begin; i + stretch <= cycle.slip.end; i += stretch) {
      const SampleRange piece{i, i + stretch};
      if (segmentation.is_selected(piece) && !is_spoilt(motion, piece)) parts.push_back(piece);
    }
  }
  return parts;
}

std::vector<Remainder> about_parabolas(const std::vector<double>& channel, const std::vector<SampleRange>& stretches) {
  std::vector<Remainder> out;
  for (const SampleRange& part : stretches) out.push_back(about_parabola(channel, part.begin, part.end));
  return out;
}

/// Stretches in which the speed is as near to a parabola as in the quiet ones: where it jumps or turns friction does.
std::vector<SampleRange> of_even_speed(const Motion& motion, std::vector<SampleRange> stretches) {
  std::vector<double> variances;
  for (const SampleRange& part : stretches) {
    const Remainder left = about_parabola(motion.relative_velocity, part.begin, part.end);
    variances.push_back(left.squares / left.count);
  }
  if (variances.empty()) return stretches;
  const double limit = kLoudest * quantile(variances, 0.25);
  std::vector<SampleRange> out;
  for (std::size_t k = 0; k < stretches.size(); ++k) {
    if (variances[k] <= limit) out.push_back(stretches[k]);
  }
  return out;
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
  const bool turns =
      known && std::abs(angle(motion.size() - 1) - angle(0)) > kinematics::kRevolutionsOfAngle * 2 * std::numbers::pi;
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
    // What all break-aways of a record are early or late by is no scatter; one alone is somewhere between two samples.
    const double time = cycle.break_away_time_std_error,
                 shared = std::max(0.0, time * time - motion.step * motion.step / 12);
    noise += std::pow(cycle.break_away_friction_std_error, 2) - std::pow(cycle.stick_slope, 2) * shared;
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

/// Variance of steps by their median.
double usual_square(std::vector<double> steps) {
  for (double& step : steps) step = std::abs(step);
  return std::pow(kSigmaPerMad * median(std::move(steps)), 2);
}

/// Mean |friction| of a cycle at speeds of its slip within a range [m/s]. NaN where it has none.
double friction_between(const Motion& motion, const Cycle& cycle, double slowest, double fastest) {
  double sum = 0, count = 0;
  for (std::size_t i = cycle.slip.begin; i < cycle.slip.end; ++i) {
    const double speed = cycle.direction * motion.relative_velocity[i];
    if (speed < slowest || speed > fastest) continue;
    sum += cycle.direction * motion.friction[i];
    count += 1;
  }
  return sum / count;
}

/// What friction between two samples is off a straight line, where noise does not show it.
double sampling_error(const Motion& motion, const Segmentation& segmentation) {
  const std::vector<double>& mu = motion.friction;
  double products = 0, count = 0;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.slip.size() < 2 * kApart || !segmentation.is_selected(cycle) || is_spoilt(motion, cycle.slip)) continue;
    const auto curvature = [&](std::size_t i) { return mu[i - 1] - 2 * mu[i] + mu[i + 1]; };
    for (std::size_t i = cycle.slip.begin + 1; i + kApart + 1 < cycle.slip.end; ++i, ++count)
      products += curvature(i) * curvature(i + kApart);
  }
  return count > 0 ? kOffStraightLine * std::sqrt(std::max(0.0, products / count)) : 0;
}

}  // namespace

double level_scatter(const Motion& motion, const Segmentation& segmentation) {
  std::vector<Cycle> cycles;
  std::vector<double> peaks;
  for (const Cycle& cycle : segmentation.cycles) {
    if (!segmentation.is_selected(cycle) || !(cycle.stick.size() > 0) || !cycle.slip_complete) continue;
    cycles.push_back(cycle);
    peaks.push_back(cycle.peak_velocity);
  }
  if (cycles.size() <= kFewestLevelSteps) return 0;
  const double peak = median(std::move(peaks));
  std::vector<double> together, apart, of_slip;
  const Cycle* last = nullptr;
  double at_rest = 0, in_slip = 0;
  for (const Cycle& cycle : cycles) {
    const double now = std::log(cycle.break_away_friction);
    const double beside = std::log(friction_between(motion, cycle, kSpeedsOfLevel[0] * peak, kSpeedsOfLevel[1] * peak));
    if (!std::isfinite(now) || !std::isfinite(beside)) continue;
    if (last != nullptr && last->direction == cycle.direction) {
      together.push_back(now - at_rest + beside - in_slip);
      apart.push_back(now - at_rest - beside + in_slip);
      of_slip.push_back(beside - in_slip);
    }
    last = &cycle;
    at_rest = now;
    in_slip = beside;
  }
  if (together.size() < kFewestLevelSteps) return 0;
  const auto count = static_cast<double>(together.size());
  const double alike = usual_square(std::move(together)), opposite = usual_square(std::move(apart));
  if (!(alike > opposite * (1 + kClearOfZero * std::sqrt(3 / count)))) return 0;
  const double covariance = 0.25 * (alike - opposite);
  // Friction in slip follows break-away a little where levels do not scatter: by less than it would move then.
  const double variance = std::min(covariance, usual_square(std::move(of_slip)));
  return std::sqrt(std::max(0.0, 0.5 * variance));  // of a level, not of a step between two
}

FlickerNoise flicker_noise(const Motion& motion, const Segmentation& segmentation) {
  const bool sticks = segmentation.kind != MotionKind::always_slipping;
  const auto parts =
      sticks ? stick_stretches(motion, segmentation) : of_even_speed(motion, slip_stretches(motion, segmentation));
  std::vector<double> lengths;
  for (const SampleRange& part : parts) lengths.push_back(static_cast<double>(part.size()));
  if (lengths.empty()) return {};
  const auto length = static_cast<std::size_t>(quantile(std::move(lengths), 0.25));  // of all but the shortest
  std::vector<std::span<const double>> stretches;
  for (const SampleRange& part : parts) {
    if (part.size() >= length) stretches.push_back(std::span(motion.friction).subspan(part.begin, length));
  }
  return {flicker_power(stretches), static_cast<double>(length)};
}

void add_noise(const RecordNoise& noise, Observations& out) {
  out.noise = {noise};
  const double power = noise.flicker.power;
  if (!(power > 0)) return;
  double squares = 0, weights = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    squares += out.weight[i] * out.friction[i] * out.friction[i];
    weights += out.weight[i];
  }
  if (squares > 0) out.flicker = power * weights / squares;
}

SensorNoise sensor_noise(const Motion& motion, const Segmentation& segmentation) {
  if (motion.is_points()) return noise_of_points(motion, segmentation);
  std::vector<Remainder> parts = about_parabolas(motion.friction, stick_stretches(motion, segmentation));
  const bool in_stick = parts.size() >= 3;
  if (!in_stick) parts = about_parabolas(motion.friction, slip_stretches(motion, segmentation));
  return {pooled_noise(parts).deviation, sampling_error(motion, segmentation), in_stick ? "stick" : "slip"};
}

CorrelatedNoise noise_in_sticks(std::uint8_t channel, const Motion& motion, const Segmentation& segmentation) {
  const std::vector<double>& values = channel == SampleFault::velocity ? motion.relative_velocity : motion.friction;
  return pooled_noise(about_parabolas(values, stick_stretches(motion, segmentation, channel)));
}

RecordNoise noise_of(const Motion& motion, const Segmentation& segmentation, int threads) {
  RecordNoise noise;
  const bool points = motion.is_points();
  run_tasks(points ? 1 : 2, threads, [&](std::size_t k) {
    if (k == 0) {
      noise.sensor = sensor_noise(motion, segmentation);
      stop_point();
      if (!points) noise.scatter = break_away_scatter(motion, segmentation);
      if (!points) noise.level_scatter = level_scatter(motion, segmentation);
    } else {
      noise.flicker = flicker_noise(motion, segmentation);
    }
    stop_point();
  });
  noise.lines = std::make_shared<LinesOfRecord>();
  return noise;
}

Floor floor_of(const RecordNoise& noise) {
  Floor floor;
  floor.source = noise.sensor.source;
  floor.noise = noise.sensor.rmse;
  floor.scatter = noise.scatter;
  if (noise.sensor.between > noise.sensor.rmse) {
    floor.noise = floor.sampling = noise.sensor.between;
    floor.source = "sampling";
  }
  floor.rmse = floor.noise;
  return floor;
}

Floor estimate_floor(const Motion& motion, const Segmentation& segmentation) {
  RecordNoise noise;
  noise.sensor = sensor_noise(motion, segmentation);
  stop_point();
  if (!motion.is_points()) noise.scatter = break_away_scatter(motion, segmentation);
  stop_point();
  return floor_of(noise);
}

}  // namespace tribofit
