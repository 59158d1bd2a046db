#include "tribofit/study/identified.hpp"

#include <Eigen/Core>
#include <boost/random/normal_distribution.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <stdexcept>

#include "fit/assessment.hpp"
#include "fit/errors.hpp"
#include "kinematics/corrections.hpp"
#include "limits.hpp"
#include "statistics/linear_algebra.hpp"
#include "tribofit/fit/identification.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/fit/rig.hpp"
#include "tribofit/friction/evaluate.hpp"
#include "tribofit/study/block_motion.hpp"
#include "tribofit/study/critical_speed.hpp"
#include "tribofit/study/vary.hpp"

namespace tribofit {
namespace {

/// Correlation of break-away from cycle to cycle, of what is scatter in it: about the levels that the fit expects,
/// since a trend that it explains is none. 0 where there are too few cycles.
double wander_of(const Fit& fit, const Motion& motion, const Segmentation& segmentation) {
  const double scatter = fit.floor.scatter;
  if (!(scatter > 0)) return 0;
  Observations observations = observe(motion, segmentation, fit.model.needs(), kFewestOfSlip);
  refer_to_conditions_of(fit, observations);
  const std::vector<double> p = fit.values();
  std::vector<double> off;
  for (const auto& slip : observations.slips) {
    const double level = slip.read_at_break_away(fit.model.acts_in_stick());
    if (!slip.from_stick || !std::isfinite(level)) continue;
    off.push_back(level - break_away_level(fit.model, p.data(), observations.slip(slip)));
  }
  const std::size_t n = off.size();
  if (n < kFewestLevels) return 0;
  double mean = 0, products = 0;
  for (const double x : off) mean += x / static_cast<double>(n);
  for (std::size_t i = 1; i < n; ++i) products += (off[i] - mean) * (off[i - 1] - mean);
  return std::clamp(products / static_cast<double>(n - 1) / (scatter * scatter), 0.0, kMostScatterCorrelation);
}

/// Mean speed of the disc [rad/s], NaN where it is not known.
double mean_speed(const Motion& motion, double radius) {
  if (motion.disc_velocity.empty()) {
    return motion.constant_disc_velocity != 0 ? motion.constant_disc_velocity / radius : motion.conditions.speed.value;
  }
  double sum = 0;
  for (const double v : motion.disc_velocity) sum += std::abs(v);
  return sum / static_cast<double>(motion.disc_velocity.size()) / radius;
}

/// What effects of a fit say of the rig.
struct SaidOfRig {
  double lateness = 0;           ///< how much later than v_b the fit has friction [s]
  double mass_below_sensor = 0;  ///< [kg]
};

SaidOfRig said_of_rig(const Fit& fit) {
  SaidOfRig out;
  if (fit.parameters.empty()) return out;
  const std::vector<double> p = fit.values();
  for_each_effect(fit.model, p.data(), [&]<class E>(const E&, const double* q) {
    if constexpr (requires { E::reading_delay(q); }) out.lateness += E::reading_delay(q);
    if constexpr (requires { E::mass_below_sensor(q); }) out.mass_below_sensor += E::mass_below_sensor(q);
  });
  return out;
}

/// Why law and rig make no machine; empty where they do.
std::string obstacle_of(const Fit& fit, const RigFit& rig, const Condition& radius, double speed) {
  if (!rig.determined) return "the rig could not be identified: " + rig.reason;
  if (!fit.converged || fit.parameters.empty()) {
    return "no law could be fitted" + (fit.messages.empty() ? "" : ": " + fit.messages.front());
  }
  if (!radius.known()) return "the friction radius is not known: give it with --radius 15mm";
  return speed > 0 ? "" : "the speed of the disc is not known: give it with --speed 4rpm";
}

/// A square root of a covariance, which need not have full rank.
Eigen::MatrixXd root_of(const std::vector<double>& covariance, std::size_t count) {
  const auto n = static_cast<Eigen::Index>(count);
  if (covariance.empty()) return Eigen::MatrixXd::Zero(n, n);
  if (covariance.size() != count * count) throw std::invalid_argument("draws_of: wrong size of a covariance");
  const Eigen::MatrixXd full = Eigen::Map<const Eigen::MatrixXd>(covariance.data(), n, n);
  // Parameters differ by powers of ten: scaled to a correlation first.
  const Eigen::VectorXd scale =
      full.diagonal().cwiseMax(0).cwiseSqrt().unaryExpr([](double s) { return s > 0 ? s : 1; });
  const Eigen::MatrixXd correlation = scale.cwiseInverse().asDiagonal() * full * scale.cwiseInverse().asDiagonal();
  const SymmetricEigen eigen = symmetric_eigen(0.5 * (correlation + correlation.transpose()));
  return scale.asDiagonal() * eigen.vectors * eigen.values.cwiseMax(0).cwiseSqrt().asDiagonal();
}

bool can_be(const Machine& m) {
  const auto law = std::span(m.parameters).first(m.model.base_count());
  return m.rig.mass > 0 && m.rig.stiffness > 0 && m.rig.damping >= 0 && is_possible(m.model.law(), law);
}

}  // namespace

RigFit rig_beside(const Fit& fit, const Motion& motion, const Segmentation& segmentation,
                  const Instruments& instruments) {
  const double late = said_of_rig(fit).lateness;
  if (late == 0) return identify_rig(motion, segmentation, instruments);
  Motion aligned = motion;
  kinematics::shift_earlier(aligned.friction, late, motion.step);
  return identify_rig(aligned, segmentation, instruments);
}

IdentifiedMachine identified_machine(const Fit& fit, const RigFit& rig, const Motion& motion,
                                     const Segmentation& segmentation) {
  IdentifiedMachine out;
  const Condition& radius = motion.conditions.radius;
  const double speed = radius.known() ? mean_speed(motion, radius.value) : 0;
  out.reason = obstacle_of(fit, rig, radius, speed);
  if (!out.reason.empty()) return out;
  const bool by_load = motion.friction_kind == FrictionKind::coefficient && !rig.per_unit_load;
  out.machine = {rig.to_rig(), fit.model, fit.values(), by_load ? rig.load : 1, radius.value, speed};
  if (is_conditional(fit)) out.law_over_floor = over_floor(fit);
  out.covariance.friction = fit.covariance;
  out.covariance.rig.assign(rig.covariance.begin(), rig.covariance.end());
  const bool finite =
      std::all_of(fit.covariance.begin(), fit.covariance.end(), [](double x) { return std::isfinite(x); });
  if (!finite || fit.covariance.size() != fit.parameters.size() * fit.parameters.size()) {
    out.covariance.friction.clear();
    out.notes.push_back("the errors of the law are not known: it is taken as exact");
  }
  if (const double below = said_of_rig(fit).mass_below_sensor; below != 0) {
    out.machine.rig.mass += rig.per_unit_load ? below / rig.load : below;
    out.notes.push_back("the mass that the law finds below the force sensor is added to that of the rig");
  }
  out.scatter = {fit.floor.scatter, wander_of(fit, motion, segmentation)};
  return out;
}

std::vector<Machine> draws_of(const Machine& machine, const MachineCovariance& covariance, std::size_t count,
                              std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  boost::random::normal_distribution<double> normal;
  const Eigen::MatrixXd friction = root_of(covariance.friction, machine.parameters.size());
  const Eigen::MatrixXd rig = root_of(covariance.rig, 3);
  const auto draw = [&](const Eigen::MatrixXd& root) {
    Eigen::VectorXd z(root.cols());
    for (double& x : z) x = normal(engine);
    return Eigen::VectorXd(root * z);
  };
  std::vector<Machine> out;
  for (std::size_t tries = 0; out.size() < count && tries < kMostTries * count; ++tries) {
    Machine drawn = machine;
    const Eigen::VectorXd change = draw(friction), of_rig = draw(rig);
    for (std::size_t k = 0; k < drawn.parameters.size(); ++k) {
      drawn.parameters[k] += change[static_cast<Eigen::Index>(k)];
      const Parameter& q = drawn.model.parameters()[k].parameter;
      if (!drawn.model.parameters()[k].effect.empty()) {
        drawn.parameters[k] = std::clamp(drawn.parameters[k], q.lower * q.si, q.upper * q.si);
      }
    }
    drawn.rig.mass += of_rig[0];
    drawn.rig.damping += of_rig[1];
    drawn.rig.stiffness += of_rig[2];
    if (can_be(drawn)) out.push_back(std::move(drawn));
  }
  return out;
}

double std_error_of(const StudiedMachine& studied, std::string_view variable) {
  const auto from = [](const std::vector<double>& covariance, std::size_t k) {
    const auto n = static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(covariance.size()))));
    const bool known = k < n && covariance[k * n + k] > 0;
    return known ? std::sqrt(covariance[k * n + k]) : std::nan("");
  };
  constexpr std::array<std::string_view, 3> kRig = {"mass", "damping", "stiffness"};
  for (std::size_t k = 0; k < kRig.size(); ++k) {
    if (variable == kRig[k]) return from(studied.covariance.rig, k);
  }
  const auto& slots = studied.machine.model.parameters();
  for (std::size_t k = 0; k < slots.size(); ++k) {
    if (variable == slots[k].full_name()) return from(studied.covariance.friction, k);
  }
  return std::nan("");
}

BlockMotion measured_motion(const StudiedMachine& studied, double disc_velocity) {
  if (!studied.record || !is_same_speed(disc_velocity, studied.machine.disc_velocity())) return {};
  return block_motion(studied.record->motion, studied.record->segmentation,
                      studied.machine.load / studied.machine.rig.stiffness);
}

const Estimate* measured_value(const StudiedMachine& studied, const MeasureInfo& measure) {
  if (!studied.record) return nullptr;
  const Segmentation& s = studied.record->segmentation;
  const Estimate* value = measure.name == "frequency"    ? &s.frequency
                          : measure.name == "stick-time" ? &s.stick_time
                          : measure.name == "peak-speed" ? &s.amplitude
                                                         : nullptr;
  return value != nullptr && std::isfinite(value->value) ? value : nullptr;
}

}  // namespace tribofit
