#include "disc_ripple.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace tribofit::kinematics {

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
