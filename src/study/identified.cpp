#include "tribofit/study/identified.hpp"
#include "limits.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fit/assessment.hpp"
#include "fit/errors.hpp"
#include "kinematics/corrections.hpp"
#include "tribofit/fit/observations.hpp"
#include "tribofit/friction/evaluate.hpp"

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

/// What the effects of a fit say through one of their hooks, summed; 0 where none has it.
template <class Say>
double sum_over_effects(const Fit& fit, Say say) {
  const std::vector<double> p = fit.values();
  double sum = 0;
  for_each_effect(fit.model, p.data(), [&](const auto& effect, const double* q) { sum += say(effect, q); });
  return sum;
}

/// How much later than v_b the fit has friction [s].
double lateness(const Fit& fit) {
  return sum_over_effects(fit, []<class E>(const E&, const double* q) {
    if constexpr (requires { E::reading_delay(q); }) return E::reading_delay(q);
    return 0.0;
  });
}

/// Mass that the fit finds below the force sensor [kg].
double mass_below_sensor(const Fit& fit) {
  return sum_over_effects(fit, []<class E>(const E&, const double* q) {
    if constexpr (requires { E::mass_below_sensor(q); }) return E::mass_below_sensor(q);
    return 0.0;
  });
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
  if (is_conditional(fit)) out.law_over_floor = over_floor(fit);
  out.covariance.friction = fit.covariance;
  out.covariance.rig.assign(rig.covariance.begin(), rig.covariance.end());
  const bool finite =
      std::all_of(fit.covariance.begin(), fit.covariance.end(), [](double x) { return std::isfinite(x); });
  if (!finite || fit.covariance.size() != fit.parameters.size() * fit.parameters.size()) {
    out.covariance.friction.clear();
    out.notes.push_back("the errors of the law are not known: it is taken as exact");
  }
  if (const double below = mass_below_sensor(fit); below != 0) {
    out.machine.rig.mass += rig.per_unit_load ? below / rig.load : below;
    out.notes.push_back("the mass that the law finds below the force sensor is added to that of the rig");
  }
  out.scatter = {fit.floor.scatter, wander_of(fit, motion, segmentation)};
  return out;
}

}  // namespace tribofit
