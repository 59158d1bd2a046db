#include "tribofit/fit/rig.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>

#include "cycle_evidence.hpp"
#include "force_balance.hpp"
#include "kinematics/corrections.hpp"
#include "limits.hpp"
#include "tribofit/statistics/distributions.hpp"
#include "tribofit/statistics/polynomials.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {
namespace {

RigValue rig_value(double value, double std_error, double freedom) {
  RigValue out;
  out.value = value;
  out.determined = std::isfinite(value) && std::isfinite(std_error);
  if (!out.determined) return {};
  const double half = t_quantile_95(freedom) * std_error;
  out.std_error = std_error;
  out.lower95 = value - half;
  out.upper95 = value + half;
  return out;
}

/// Force over the way of the disc, as a straight line. Nothing where the samples are too few or the disc stands.
std::optional<StraightLine> force_over_way(const Motion& motion, const NormalForce& load, const SampleRange& span) {
  if (span.end < span.begin + 8) return std::nullopt;
  std::vector<double> ways, forces;
  double way = 0;
  for (std::size_t i = span.begin; i < span.end; ++i) {
    ways.push_back(way);
    forces.push_back(load.at(i) * motion.friction[i]);
    way += motion.step * motion.disc_velocity_at(i);
  }
  const StraightLine line = fit_line(ways, forces);
  constexpr double kRounding = 1e-9;
  if (!(line.squares > kRounding * (line.squares + static_cast<double>(ways.size()) * line.middle * line.middle))) {
    return std::nullopt;
  }
  return line;
}

/// The same over the inner part of a stick: what follows re-stick and what precedes break-away are left out.
std::optional<StraightLine> within_stick(const Motion& motion, const NormalForce& load, const SampleRange& stick) {
  const std::size_t tenth = stick.size() / 10;
  return force_over_way(motion, load, {stick.begin + tenth, stick.end - tenth});
}

bool disc_is_known(const Motion& motion) {
  return !motion.disc_velocity.empty() || motion.constant_disc_velocity != 0;
}

/// Stiffness from the slope of stick, and what the balance's differs from it, cycle by cycle where both have the cycle.
void compare_stick_slope(const Motion& motion, const Segmentation& segmentation, const NormalForce& load,
                         const Balance* balance, const Eigen::VectorXd& influence, RigFit& fit) {
  if (!disc_is_known(motion)) return;
  // omega r that was read off the plateaus is off by some tenths of a per cent; each stick has its own.
  const bool from_plateau = motion.conditions.speed.source == "plateau";
  std::vector<double> slopes, differences;
  std::vector<std::size_t> middles;
  for (const Cycle& cycle : segmentation.cycles) {
    if (!cycle.stick_complete) continue;
    const std::optional<StraightLine> line = within_stick(motion, load, cycle.stick);
    if (!line) continue;
    const std::size_t middle = cycle.stick.begin + cycle.stick.size() / 2;
    const double disc = motion.disc_velocity_at(middle), block = disc - cycle.plateau_velocity;
    slopes.push_back(from_plateau && block / disc > 0 ? line->slope * disc / block : line->slope);
    middles.push_back(middle);
  }
  if (slopes.size() < 3) return;
  const Estimate mean = mean_with_error(slopes);
  fit.stick_slope_stiffness = rig_value(mean.value, mean.std_error, mean.degrees_of_freedom);
  if (!fit.stiffness.determined || balance == nullptr) return;
  for (std::size_t k = 0, b = 0; k < slopes.size(); ++k) {
    while (b < balance->spans.size() && balance->spans[b].end <= middles[k]) ++b;
    if (b == balance->spans.size()) break;
    if (balance->spans[b].begin <= middles[k]) differences.push_back(influence(Eigen::Index(b)) - slopes[k]);
  }
  const Estimate error = standard_error_of_mean(differences);
  if (error.std_error > 0) fit.stick_slope_difference = (fit.stiffness.value - mean.value) / error.std_error;
}

/// A record that only sticks: the spring is wound up evenly, and the slope of force over the way says how stiff it is.
/// Its error is that of the pieces of the record.
void from_stick_alone(const Motion& motion, const NormalForce& load, RigFit& fit) {
  fit.reason =
      "the block never slips: it moves with the disc and does not accelerate, so mass and damping cannot be found";
  const std::optional<StraightLine> line = force_over_way(motion, load, {0, motion.size()});
  if (!disc_is_known(motion) || !line) return;
  constexpr std::size_t kPieces = 24;
  std::vector<double> influence(kPieces, 0.0);
  double way = 0;
  for (std::size_t i = 0; i < motion.size(); ++i) {
    const double residual = load.at(i) * motion.friction[i] - line->at(way);
    influence[i * kPieces / motion.size()] += kPieces * (way - line->middle) * residual / line->squares;
    way += motion.step * motion.disc_velocity_at(i);
  }
  const Estimate error = standard_error_of_mean(influence);
  fit.stick_slope_stiffness = rig_value(line->slope, error.std_error, error.degrees_of_freedom);
  if (!(std::abs(line->slope) > kClearOfZero * error.std_error)) return;
  fit.stiffness = fit.stick_slope_stiffness;
}

void add_systematic(const Instruments& instruments, const NormalForce& load, const Eigen::VectorXd& per_delay,
                    RigFit& fit) {
  const auto uncertainty = [](const std::optional<Declared>& d) { return d ? d->uncertainty : 0.0; };
  const auto part = [](const std::optional<Declared>& d) {
    return d && d->value != 0 ? d->uncertainty / std::abs(d->value) : 0.0;
  };
  const double scale = std::hypot(load.nominal ? part(instruments.rig.load) : 0, part(instruments.force_sensor.gain),
                                  part(instruments.vibrometer.gain));
  const double delay = uncertainty(instruments.vibrometer.delay);
  const double below = fit.mass_below_declared ? uncertainty(instruments.force_sensor.mass_below) : 0;
  fit.mass.systematic = std::hypot(scale * fit.mass.value, delay * per_delay(0), below);
  fit.damping.systematic = std::hypot(scale * fit.damping.value, delay * per_delay(1));
  fit.stiffness.systematic = std::hypot(scale * fit.stiffness.value, delay * per_delay(2));
}

/// Natural frequency and damping ratio by the delta method.
void add_derived(RigFit& fit) {
  const double m = fit.mass.value, c = fit.damping.value, k = fit.stiffness.value;
  if (!(m > 0 && k > 0)) return;
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance(fit.covariance.data());
  const auto derived = [&](double value, const Eigen::Vector3d& gradient) {
    return rig_value(value, std::sqrt(std::max(0.0, gradient.dot(covariance * gradient))), fit.degrees_of_freedom);
  };
  const double f = std::sqrt(k / m) / (2 * std::numbers::pi), zeta = c / (2 * std::sqrt(k * m));
  fit.natural_frequency = derived(f, {-0.5 * f / m, 0, 0.5 * f / k});
  fit.damping_ratio = derived(zeta, {-0.5 * zeta / m, 0.5 / std::sqrt(k * m), -0.5 * zeta / k});
}

/// A declared ping frequency is that of the whole mass.
void add_mass_below(const Instruments& instruments, RigFit& fit) {
  const auto& ping = instruments.rig.ping_frequency;
  if (!ping || fit.per_unit_load || !(fit.stiffness.value > 0)) return;
  const double omega = (2 * std::numbers::pi) * ping->value, whole = fit.stiffness.value / (omega * omega);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> covariance(fit.covariance.data());
  const Eigen::Vector3d gradient(-1, 0, 1 / (omega * omega));
  fit.mass_below =
      rig_value(whole - fit.mass.value, std::sqrt(gradient.dot(covariance * gradient)), fit.degrees_of_freedom);
  fit.mass_below.systematic = 2 * whole * ping->uncertainty / ping->value;
}

void set_values(const BalanceSolution& solution, RigFit& fit) {
  const Spread spread = spread_of(solution.influence);
  fit.degrees_of_freedom = spread.degrees_of_freedom.head(3).minCoeff();
  const auto value = [&](Eigen::Index k) {
    return rig_value(solution.values(k), spread.std_error(k), spread.degrees_of_freedom(k));
  };
  fit.mass = value(0);
  fit.damping = value(1);
  fit.stiffness = value(2);
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) fit.covariance[std::size_t(3 * i + j)] = spread.covariance(i, j);
  }
  fit.residual_rmse = solution.rmse;
}

/// Terms that a sound record does not have, both at once: each alone would pass for the other.
void try_further_terms(const Balance& balance, const BalanceSolution& solution, RigFit& fit) {
  const bool corner_is_free = solution.columns.back() == kIntegral;
  std::vector<BalanceColumn> columns = {kAcceleration, kVelocity, kDisplacement, kIntegral, kJerk};
  const BalanceSolution all = solve_balance(balance, columns, solution.values.head(3));
  if (!all.solved || all.values(2) == 0) return;
  const Spread spread = spread_of(all.influence);
  const auto value = [&](Eigen::Index k, double factor) {
    return rig_value(factor * all.values(k), std::abs(factor) * spread.std_error(k), spread.degrees_of_freedom(k));
  };
  fit.delay = value(4, -1);
  if (!corner_is_free) fit.high_pass = value(3, 1 / ((2 * std::numbers::pi) * all.values(2)));
  // v_b = v_m + w integral(v_m): the coefficients of v_m and of its integral are c + m w and k + c w.
  const double w = corner_is_free ? 0 : (2 * std::numbers::pi) * fit.high_pass.value, m = all.values(0),
               c = all.values(1) - m * w;
  fit.without_both = {m, c, all.values(2) - c * w};
}

/// Whether the values are those of a rig, and if not, why.
void judge(const BalanceSolution& solution, RigFit& fit) {
  const auto clear = [](const RigValue& v) { return v.determined && std::abs(v.value) > kClearOfZero * v.std_error; };
  if (!(solution.noise_share.maxCoeff() < kMostNoiseOfRig) || !clear(fit.mass) || !clear(fit.stiffness)) {
    fit.reason = "the block moves too little, compared with the noise, to determine mass, damping and stiffness";
    return;
  }
  fit.reason = why_impossible(fit);
  fit.determined = fit.reason.empty();
}

/// The balance, once more with test functions that suit the natural period found.
std::pair<Balance, BalanceSolution> solve(const Motion& motion, const Segmentation& segmentation,
                                          const NormalForce& load, double period) {
  std::vector<BalanceColumn> columns = {kAcceleration, kVelocity, kDisplacement};
  if (motion.high_pass > 0) columns.push_back(kIntegral);
  Balance balance = force_balance(motion, segmentation, load, period);
  BalanceSolution solution = solve_balance(balance, columns);
  if (solution.solved && solution.values(0) > 0 && solution.values(2) > 0) {
    const double found = (2 * std::numbers::pi) * std::sqrt(solution.values(0) / solution.values(2));
    balance = force_balance(motion, segmentation, load, std::clamp(found, period / 4, 4 * period));
    solution = solve_balance(balance, columns);
  }
  return {std::move(balance), std::move(solution)};
}

/// A delay is a further term only as long as it is short against the smoothing: a longer one is found by moving
/// friction back by what was found and looking again.
void refine_delay(const Motion& motion, const Segmentation& segmentation, double period, RigFit& fit) {
  const auto is_clear = [&](const RigValue& delay) {
    return delay.determined && std::abs(delay.value) > kClearOfZero * delay.std_error &&
           std::abs(delay.value) > motion.step;
  };
  constexpr int kMostTimes = 4;
  double total = fit.delay.value;
  RigFit moved;
  moved.delay = fit.delay;
  for (int i = 0; i < kMostTimes && is_clear(moved.delay); ++i) {
    Motion aligned = motion;
    kinematics::shift_earlier(aligned.friction, total, motion.step);
    const auto [balance, solution] = solve(aligned, segmentation, normal_force(aligned), period);
    if (!solution.solved) return;
    moved.delay = {};
    try_further_terms(balance, solution, moved);
    if (!moved.delay.determined) return;
    total += moved.delay.value;
    fit.delay = rig_value(total, moved.delay.std_error, fit.degrees_of_freedom);
    fit.high_pass = moved.high_pass;
    fit.without_both = moved.without_both;
  }
}

}  // namespace

Rig RigFit::to_rig() const {
  if (!determined) throw std::logic_error("RigFit::to_rig(): the rig could not be identified: " + reason);
  return {mass.value, std::max(0.0, damping.value), stiffness.value};
}

RigFit identify_rig(const Motion& motion, const Segmentation& segmentation, const Instruments& instruments) {
  RigFit fit;
  const NormalForce load = normal_force(motion);
  fit.per_unit_load = !load.known;
  fit.load = load.mean;
  if (motion.velocity_kind == VelocityKind::fixed_block) {
    fit.reason = "the block stands still: its motion was not measured";
    return fit;
  }
  fit.mass_below_declared =
      instruments.force_sensor.mass_below.has_value() && load.known && motion.velocity_kind == VelocityKind::block;
  if (segmentation.kind == MotionKind::always_sticking) {
    from_stick_alone(motion, load, fit);
    add_messages(motion, segmentation, instruments, fit);
    return fit;
  }
  const double period = period_guess(motion, segmentation);
  if (!(period > kShortestPeriod * motion.step)) {
    fit.reason = period > 0 ? "the record has fewer than eight samples per oscillation of the block"
                            : "no slip is complete and nothing oscillates: there is no motion for the force balance";
    return fit;
  }
  auto [balance, solution] = solve(motion, segmentation, load, period);
  fit.cycles = balance.blocks.size();
  fit.smoothing = balance.width;
  if (!solution.solved) {
    fit.reason = fit.cycles < 3 ? "there are fewer than three whole cycles: no uncertainty can be given"
                                : "the block moves too little to separate mass, damping and stiffness";
    return fit;
  }
  set_values(solution, fit);
  compare_stick_slope(motion, segmentation, load, &balance, solution.influence.col(2), fit);
  try_further_terms(balance, solution, fit);
  refine_delay(motion, segmentation, period, fit);
  judge(solution, fit);
  add_derived(fit);
  add_mass_below(instruments, fit);
  add_systematic(instruments, load, solution.per_delay, fit);
  add_messages(motion, segmentation, instruments, fit);
  return fit;
}

}  // namespace tribofit
