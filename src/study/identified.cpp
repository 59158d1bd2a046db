#include "tribofit/study/identified.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

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

/// What of the law belongs to the rig.
void settle_rig(const Fit& fit, const RigFit& rig, IdentifiedMachine& out) {
  const std::vector<std::string> keys = fit.model.effect_keys();
  const auto has = [&](const char* key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); };
  if ((has("channel-delay") || has("force-bandwidth")) && rig.without_both.mass > 0 && rig.without_both.stiffness > 0) {
    out.machine.rig = rig.without_both;
    out.machine.rig.damping = std::max(0.0, out.machine.rig.damping);
    out.notes.push_back("the rig is that with the delay between the channels taken out");
  }
  if (!has("sensor-inertia")) return;
  const double below = out.machine.parameters[fit.model.offset_of("sensor-inertia")];
  out.machine.rig.mass += rig.per_unit_load ? below / rig.load : below;
  out.notes.push_back("the mass that the law finds below the force sensor is added to that of the rig");
}

}  // namespace

IdentifiedMachine identified_machine(const Fit& fit, const RigFit& rig, const Motion& motion,
                                     const Segmentation& segmentation) {
  IdentifiedMachine out;
  const Condition& radius = motion.conditions.radius;
  if (!rig.determined) out.reason = "no rig can be had: " + rig.reason;
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
  settle_rig(fit, rig, out);
  out.scatter = {fit.floor.scatter, wander_of(segmentation, fit.floor.scatter)};
  return out;
}

}  // namespace tribofit
