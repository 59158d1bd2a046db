#include "ripple.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <limits>
#include <utility>
#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "statistics/reductions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/quantiles.hpp"

namespace tribofit::kinematics {
namespace {

struct Level {
  double begin = 0, end = 0;  // [s]
  double value = 0;           // [m/s]
  double fall = 0;            // of the plateau from the first to the second half of its middle [m/s]
  double mean = 0, last = 0;  // friction in the middle and towards its end
  bool used = true;
};

std::vector<Level> levels_of(const BlockMeans& velocity, const Plateaus& plateaus, std::span<const double> time,
                             std::span<const double> friction) {
  std::vector<double> sizes;
  for (const StickPlateau& run : plateaus.runs) sizes.push_back(static_cast<double>(run.size()));
  const double least = kShortestPlateau * median(std::move(sizes));
  std::vector<Level> levels;
  for (const StickPlateau& run : plateaus.runs) {
    const std::size_t begin = run.inner_begin() * velocity.length, end = run.inner_end() * velocity.length;
    if (static_cast<double>(run.size()) < least || end <= begin || end > time.size()) continue;
    Level level{time[begin], time[end - 1], run.level};
    const std::span<const double> v(velocity.mean);
    const std::size_t half = (run.inner_end() - run.inner_begin()) / 2;
    level.fall = mean_of(v.subspan(run.inner_begin(), half)) - mean_of(v.subspan(run.inner_end() - half, half));
    level.mean = mean_of(friction.subspan(begin, end - begin));
    level.last = mean_of(friction.subspan(end - (end - begin) / 4, (end - begin) / 4));
    levels.push_back(level);
  }
  return levels;
}

// The plateau of a contact that creeps falls towards break-away, a ripple's rises as often as it falls: the mean fall
// over the level, 0 where it is not clearly there.
double creep_of(const std::vector<Level>& levels) {
  std::vector<double> falls, sizes;
  for (const Level& level : levels) {
    falls.push_back(level.value > 0 ? level.fall : -level.fall);
    sizes.push_back(std::abs(level.value));
  }
  const double fall = mean_of(falls), size = median(std::move(sizes));
  double squares = 0;
  for (double f : falls) squares += (f - fall) * (f - fall);
  const auto n = static_cast<double>(falls.size());
  return fall > kLeastCreep * size && fall > kCreepErrors * std::sqrt(squares) / n ? fall / size : 0;
}

// Friction less its mean, over its spread.
void standardise(std::vector<Level>& levels, double Level::*member) {
  double sum = 0, squares = 0;
  for (const Level& level : levels) sum += level.*member;
  const double mean = sum / static_cast<double>(levels.size());
  for (const Level& level : levels) squares += std::pow(level.*member - mean, 2);
  const double spread = std::sqrt(squares / static_cast<double>(levels.size()));
  for (Level& level : levels) level.*member = spread > 0 ? (level.*member - mean) / spread : 0;
}

// Means of cos(w t) and sin(w t) over a plateau, as exp(i w t).
std::complex<double> mean_phasor(const Level& level, double w) {
  const double half = 0.5 * w * (level.end - level.begin);
  const double part = std::abs(half) > 1e-9 ? std::sin(half) / half : 1;
  return std::polar(part, 0.5 * w * (level.begin + level.end));
}

using Row = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1>;
using Normal = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 6, 6>;

/// What is fitted to the levels: 1, time from the middle over half the record, mean cos, mean sin, and where the
/// contact creeps, friction in the plateau and at its end. A creep that follows friction (a runout) then is no ripple.
struct Design {
  double w = 0;  // [rad/s]
  double middle = 0, half = 1;
  bool creeping = false;

  Row row(const Level& level) const {
    const std::complex<double> p = mean_phasor(level, w);
    Row r(creeping ? 6 : 4);
    r.head<4>() << 1, (0.5 * (level.begin + level.end) - middle) / half, p.real(), p.imag();
    if (creeping) r.tail<2>() << level.mean, level.last;
    return r;
  }
};

struct LinearFit {
  Row x;
  Normal inverse;
  double rss = HUGE_VAL;
};

LinearFit fit_order(const std::vector<Level>& levels, const Design& design) {
  LinearFit fit;
  const Eigen::Index k = design.creeping ? 6 : 4;
  Normal normal = Normal::Zero(k, k);
  Row right = Row::Zero(k);
  const double origin = levels.front().value;  // keeps the sums small beside a large mean
  for (const Level& level : levels) {
    if (!level.used) continue;
    const Row row = design.row(level);
    normal += row * row.transpose();
    right += row * (level.value - origin);
  }
  const SymmetricSystem solved = solve_symmetric_system(normal, right);
  if (!(solved.reciprocal_condition >= kFittable)) return fit;
  fit.inverse = solved.inverse;
  fit.x = solved.x;
  fit.x(0) += origin;
  fit.rss = 0;
  for (const Level& level : levels) {
    if (level.used) fit.rss += std::pow(level.value - design.row(level).dot(fit.x), 2);
  }
  return fit;
}

// Amplitude and phase of half of the record, what else the whole showed taken off but for a constant.
std::complex<double> half_of(const std::vector<Level>& levels, const Design& design, Row other, bool second) {
  other(2) = other(3) = 0;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Level& level : levels) {
    const Row row = design.row(level);
    if (!level.used || (row(1) > 0) != second) continue;
    const Eigen::Vector3d r(1, row(2), row(3));
    normal += r * r.transpose();
    right += r * (level.value - other.dot(row));
  }
  const Eigen::Vector3d x = solve_symmetric(normal, right);
  return {x(1), x(2)};
}

// Eccentric from true anomaly, in an orbit of eccentricity a.
double eccentric(double a, double u) {
  const double b = a / (1 + std::sqrt(1 - a * a));
  return u - 2 * std::atan2(b * std::sin(u), 1 + b * std::cos(u));
}

// The other reading of the phase: level (1-A^2)/(1 - A cos e), e = e0 + n omega sqrt(1-A^2) t. `left`: what omega t
// leaves.
void try_true_angle(std::vector<Level> levels, Design design, double omega, double left, RippleEstimate& estimate) {
  DiscRipple ripple = estimate.ripple;
  for (Level& level : levels) level.value = 1 / level.value;
  LinearFit fit;
  for (int pass = 0; pass < 4; ++pass) {
    if (!(ripple.amplitude < 0.5)) return;
    design.w = ripple.order * omega * std::sqrt(1 - ripple.amplitude * ripple.amplitude);
    fit = fit_order(levels, design);
    if (fit.rss == HUGE_VAL || fit.x(0) == 0) return;
    ripple.amplitude = std::hypot(fit.x(2), fit.x(3)) / std::abs(fit.x(0));
  }
  const double mean = 1 / fit.x(0), rss = fit.rss * std::pow(mean, 4);
  if (!(rss < left)) return;
  const double e = std::atan2(fit.x(3) * mean, -fit.x(2) * mean);
  const double a = ripple.amplitude, b = a / (1 + std::sqrt(1 - a * a));
  ripple.phase = std::remainder(e + 2 * std::atan2(b * std::sin(e), 1 - b * std::cos(e)), 2 * std::numbers::pi);
  const double smaller = std::sqrt(rss / left);
  ripple.amplitude_std_error *= smaller, ripple.phase_std_error *= smaller;
  estimate.ripple = ripple;
  estimate.level = mean / (1 - a * a);
  estimate.drift = -estimate.level * fit.x(1) * mean / design.half;
  estimate.true_angle = true;
}

/// The time between the middles of the first and the last plateau.
struct TimeSpan {
  double middle = 0, half = 0;  // [s]
  double turns(double omega) const { return std::abs(omega) * 2 * half / (2 * std::numbers::pi); }
};

TimeSpan time_span_of(const std::vector<Level>& levels) {
  const double first = 0.5 * (levels.front().begin + levels.front().end);
  const double last = 0.5 * (levels.back().begin + levels.back().end);
  return {0.5 * (first + last), 0.5 * (last - first)};
}

/// A fit of the order that leaves least.
struct OrderFit {
  int order = 0;  // 0: none could be fitted
  Design design;
  LinearFit fit;
};

OrderFit fit_best_order(const std::vector<Level>& levels, Design design, double omega, double turns) {
  OrderFit best{0, design, {}};
  for (int n = 1; n <= kHighestOrder; ++n) {
    if (static_cast<double>(levels.size()) < kFewestPlateausAPeriod * n * turns) break;
    design.w = n * omega;
    LinearFit fit = fit_order(levels, design);
    if (fit.rss < best.fit.rss) best = {n, design, std::move(fit)};
  }
  return best;
}

// Levels far from the fit are not used in the next one.
void exclude_far(std::vector<Level>& levels, const OrderFit& best) {
  std::vector<double> deviation;
  for (const Level& level : levels) deviation.push_back(std::abs(level.value - best.design.row(level).dot(best.fit.x)));
  const double limit =
      std::max(kFarLevel * kSigmaPerMad * median(deviation), kRoundingOfLevel * std::abs(best.fit.x(0)));
  for (std::size_t r = 0; r < levels.size(); ++r) levels[r].used = deviation[r] <= limit;
}

/// What a fit leaves of the levels it used.
struct Residuals {
  Remainder left;
  double with_wave = 0;  // squares of the residuals where the wave is not taken off

  double variance_explained() const { return with_wave > 0 ? 1 - left.squares / with_wave : 0; }
  /// Of one level, enlarged by the correlation from plateau to plateau.
  double variance(Eigen::Index parameters) const {
    const double freedom = left.count - static_cast<double>(parameters);
    return left.squares / freedom * variance_inflation(left.correlation(kMostCorrelation));
  }
};

Residuals residuals_of(const std::vector<Level>& levels, const OrderFit& best) {
  Residuals residuals;
  const Row& x = best.fit.x;
  for (const Level& level : levels) {
    if (!level.used) continue;
    const Row row = best.design.row(level);
    const double residual = level.value - row.dot(x);
    residuals.with_wave += std::pow(residual + x(2) * row(2) + x(3) * row(3), 2);
    residuals.left.add(residual);
  }
  return residuals;
}

DiscRipple ripple_of(const OrderFit& best, double variance) {
  const double level = best.fit.x(0), sign = level > 0 ? 1 : -1;
  const Eigen::Vector2d wave = best.fit.x.segment<2>(2);
  const double size = wave.norm();
  const Eigen::Matrix2d covariance = variance * best.fit.inverse.block<2, 2>(2, 2);
  const Eigen::Vector2d along = wave / size, across(-along(1), along(0));
  return {.amplitude = size / std::abs(level),
          .order = best.order,
          .phase = std::atan2(-sign * wave(1), sign * wave(0)),
          .amplitude_std_error = std::sqrt(along.dot(covariance * along)) / std::abs(level),
          .phase_std_error = std::sqrt(across.dot(covariance * across)) / size};
}

bool is_same_in_both_halves(const std::vector<Level>& levels, const OrderFit& best, double std_error) {
  const std::complex<double> early = half_of(levels, best.design, best.fit.x, false);
  const std::complex<double> late = half_of(levels, best.design, best.fit.x, true);
  return std::abs(early - late) < kHalvesOfRipple * best.fit.x.segment<2>(2).norm() + kSignificance * std_error;
}

}  // namespace

RippleEstimate estimate_ripple(const BlockMeans& velocity, const Plateaus& plateaus, double omega,
                               std::span<const double> time, std::span<const double> friction) {
  RippleEstimate estimate;
  std::vector<Level> levels = levels_of(velocity, plateaus, time, friction);
  estimate.plateaus = levels.size();
  if (levels.size() < kFewestPlateaus || omega == 0) return estimate;
  const TimeSpan span = time_span_of(levels);
  if (span.turns(omega) < kFewestRevolutions) return estimate;
  estimate.middle = span.middle;

  standardise(levels, &Level::mean);
  standardise(levels, &Level::last);
  const double creep = creep_of(levels);
  OrderFit best;
  for (int pass = 0; pass < 4; ++pass) {
    best = fit_best_order(levels, {0, span.middle, span.half, creep > 0}, omega, span.turns(omega));
    if (best.order == 0) return estimate;
    exclude_far(levels, best);
  }
  const Residuals residuals = residuals_of(levels, best);
  const double fewest =
      std::max(static_cast<double>(kFewestPlateaus), kLevelsKept * static_cast<double>(levels.size()));
  if (residuals.left.count < fewest) return estimate;
  estimate.plateaus = static_cast<std::size_t>(residuals.left.count);
  estimate.level = best.fit.x(0);
  estimate.drift = best.fit.x(1) / span.half;
  if (best.fit.x.segment<2>(2).isZero(0) || estimate.level == 0) return estimate;
  estimate.ripple = ripple_of(best, residuals.variance(best.fit.x.size()));
  estimate.explained = residuals.variance_explained();

  const DiscRipple& ripple = estimate.ripple;
  estimate.significant = is_same_in_both_halves(levels, best, ripple.amplitude_std_error * std::abs(estimate.level)) &&
                         ripple.amplitude >= std::max(kLeastRipple, creep) && ripple.amplitude <= kLargestRipple &&
                         ripple.amplitude > kSignificance * ripple.amplitude_std_error &&
                         estimate.explained > kLeastExplained;
  if (estimate.significant) try_true_angle(levels, best.design, omega, residuals.left.squares, estimate);
  return estimate;
}

RippledDisc rippled_disc(const RippleEstimate& estimate, double omega, std::span<const double> time) {
  const DiscRipple& ripple = estimate.ripple;
  RippledDisc disc{std::vector<double>(time.size()), std::vector<double>(time.size())};
  const double n = ripple.order, a = ripple.amplitude, phase = ripple.phase;
  if (estimate.true_angle) {
    const double root = std::sqrt(1 - a * a), b = a / (1 + root), begin = eccentric(a, phase);
    for (std::size_t i = 0; i < time.size(); ++i) {
      const double e = begin + n * root * omega * time[i], c = std::cos(e), s = std::sin(e);
      disc.factor[i] = root * root / (1 - a * c);
      disc.angle[i] = (e + 2 * std::atan2(b * s, 1 - b * c) - phase) / n;
    }
    return disc;
  }
  const double w = n * omega, start = std::sin(phase);
  double anchor = 0, cosine = std::cos(phase), sine = start;
  for (std::size_t i = 0; i < time.size(); ++i) {
    // Sums of angles from the last anchor, small ones by their series: exact to 1e-13.
    double d = w * (time[i] - anchor);
    if (std::abs(d) > 0.01) {
      anchor = time[i], d = 0;
      cosine = std::cos(w * anchor + phase), sine = std::sin(w * anchor + phase);
    }
    const double c = 1 - 0.5 * d * d * (1 - d * d / 12), s = d * (1 - d * d / 6 * (1 - d * d / 20));
    disc.factor[i] = 1 + a * (cosine * c - sine * s);
    disc.angle[i] = omega * time[i] + a / n * (sine * c + cosine * s - start);
  }
  return disc;
}

double steady_speed(const Trace& trace) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  if (!trace.disc_speed.empty() || !trace.disc_angle.empty()) return none;
  double speed = none;
  for (const Step& step : trace.steps) {
    const double here = first_known(step.conditions.speed, trace.conditions.speed).value;
    if (speed == speed && here != speed) return none;
    speed = here;
  }
  return speed;
}

RippleEstimate find_ripple(Trace& trace, const PlateauSearch& search, Disc& disc, bool stated) {
  if (!search.sticks || !disc.varying.empty() || trace.velocity_kind != VelocityKind::block) return {};
  const double omega = steady_speed(trace);
  if (!(std::abs(omega) > 0)) return {};
  RippleEstimate ripple = estimate_ripple(search.blocks, search.plateaus, omega, trace.time, trace.friction);
  const bool from_plateau = trace.conditions.speed.source == "plateau" && trace.conditions.radius.known();
  if (stated) return ripple;
  Condition speed = trace.conditions.speed;
  for (int pass = 0; pass < 3 && from_plateau && ripple.level != 0; ++pass) {
    speed.value = ripple.level / trace.conditions.radius.value;
    ripple = estimate_ripple(search.blocks, search.plateaus, speed.value, trace.time, trace.friction);
  }
  if (!ripple.significant) return ripple;
  disc.constant = ripple.level;
  if (from_plateau) trace.conditions.speed = speed;
  return ripple;
}

void flatten(PlateauSearch& search, const RippleEstimate& ripple, double omega, std::span<const double> time) {
  std::vector<double> middles(search.blocks.mean.size());
  for (std::size_t b = 0; b < middles.size(); ++b)
    middles[b] = time[b * search.blocks.length + search.blocks.length / 2];
  const RippledDisc rippled = rippled_disc(ripple, omega, middles);
  for (std::size_t b = 0; b < middles.size(); ++b) search.blocks.mean[b] /= rippled.factor[b];
  const double near = 0.5 * search.plateaus.level, far = 1.5 * search.plateaus.level;
  Plateaus plateaus = find_plateaus(search.blocks.mean, LevelRange{std::min(near, far), std::max(near, far)});
  if (!plateaus.empty()) search.plateaus = std::move(plateaus);
}

void impose_ripple(Trace& trace, Disc& disc, const RippleEstimate& ripple, double omega) {
  RippledDisc rippled = rippled_disc(ripple, omega, trace.time);
  trace.disc_angle = std::move(rippled.angle);
  trace.disc_speed = rippled.factor;
  disc.varying = std::move(rippled.factor);
  for (double& v : trace.disc_speed) v *= omega;
  for (double& v : disc.varying) v *= disc.constant;
  disc.largest = std::abs(disc.constant) * (1 + ripple.ripple.amplitude);
}

}  // namespace tribofit::kinematics
