#include "tribofit/study/identified.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>

#include "kinematics/corrections.hpp"

namespace tribofit {
namespace {

/// Correlation of break-away from cycle to cycle, of what is scatter in it; 0 where too few cycles tell.
double wander_of(const Segmentation& segmentation, double scatter) {
  constexpr double kMost = 0.9;
  std::vector<double> levels;
  for (const Cycle& cycle : segmentation.cycles) {
    if (cycle.stick.size() > 0 && std::isfinite(cycle.break_away_friction)) levels.push_back(cycle.break_away_friction);
  }
  const std::size_t n = levels.size();
  if (n < 10 || !(scatter > 0)) return 0;
  double mean = 0, products = 0;
  for (const double x : levels) mean += x / static_cast<double>(n);
  for (std::size_t i = 1; i < n; ++i) products += (levels[i] - mean) * (levels[i - 1] - mean);
  return std::clamp(products / static_cast<double>(n - 1) / (scatter * scatter), 0.0, kMost);
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

bool has(const Fit& fit, std::string_view key) {
  return fit.model.offset_of(key) < fit.model.parameters().size();
}

/// How much later than v_b the fit has friction [s].
double lateness(const Fit& fit) {
  const std::vector<double> p = fit.values();
  double late = 0;
  if (has(fit, "channel-delay")) late += p[fit.model.offset_of("channel-delay")];
  if (has(fit, "force-bandwidth")) {  // group delay of a second-order low-pass, corner and damping ratio
    const std::size_t k = fit.model.offset_of("force-bandwidth");
    late += 2 * p[k + 1] / (2 * std::numbers::pi * p[k]);
  }
  return late;
}

}  // namespace

RigFit rig_beside(const Fit& fit, const Motion& motion, const Segmentation& segmentation,
                  const Instruments& instruments) {
  const double late = fit.parameters.empty() ? 0 : lateness(fit);
  if (late == 0) return identify_rig(motion, segmentation, instruments);
  Motion aligned = motion;
  kinematics::shift_earlier(aligned.friction, late, motion.step);
  return identify_rig(aligned, segmentation, instruments);
}

IdentifiedMachine identified_machine(const Fit& fit, const RigFit& rig, const Motion& motion,
                                     const Segmentation& segmentation) {
  IdentifiedMachine out;
  const Condition& radius = motion.conditions.radius;
  if (!rig.determined) out.reason = "the rig could not be identified: " + rig.reason;
  if (out.reason.empty() && (!fit.converged || fit.parameters.empty())) {
    out.reason = "no law could be fitted" + (fit.messages.empty() ? "" : ": " + fit.messages.front());
  }
  if (out.reason.empty() && !radius.known())
    out.reason = "the friction radius is not known: give it with --radius 15mm";
  const double speed = radius.known() ? mean_speed(motion, radius.value) : 0;
  if (out.reason.empty() && !(speed > 0)) {
    out.reason = "the speed of the disc is not known: give it with --speed 4rpm";
  }
  if (!out.reason.empty()) return out;
  const bool by_load = motion.friction_kind == FrictionKind::coefficient && !rig.per_unit_load;
  out.machine = {rig.to_rig(), fit.model, fit.values(), by_load ? rig.load : 1, radius.value, speed};
  out.covariance.friction = fit.covariance;
  out.covariance.rig.assign(rig.covariance.begin(), rig.covariance.end());
  const bool finite =
      std::all_of(fit.covariance.begin(), fit.covariance.end(), [](double x) { return std::isfinite(x); });
  if (!finite || fit.covariance.size() != fit.parameters.size() * fit.parameters.size()) {
    out.covariance.friction.clear();
    out.notes.push_back("the errors of the law are not known: it is taken as exact");
  }
  if (has(fit, "sensor-inertia")) {
    const double below = out.machine.parameters[fit.model.offset_of("sensor-inertia")];
    out.machine.rig.mass += rig.per_unit_load ? below / rig.load : below;
    out.notes.push_back("the mass that the law finds below the force sensor is added to that of the rig");
  }
  out.scatter = {fit.floor.scatter, wander_of(segmentation, fit.floor.scatter)};
  return out;
}

}  // namespace tribofit
