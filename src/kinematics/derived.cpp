// What follows from a Motion sample by sample: acceleration, disc angle, sliding distance.
#include <cmath>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/statistics/polynomials.hpp"

namespace tribofit {

std::vector<double> block_acceleration(const Motion& motion, std::size_t half_window) {
  std::vector<double> acceleration = savitzky_golay_slope(motion.relative_velocity, motion.step, half_window);
  for (double& a : acceleration) a = -a;
  if (!motion.disc_velocity.empty()) {
    const std::vector<double> disc = savitzky_golay_slope(motion.disc_velocity, motion.step, half_window);
    for (std::size_t i = 0; i < acceleration.size(); ++i) acceleration[i] += disc[i];
  }
  return acceleration;
}

std::vector<double> disc_angle(const Motion& motion) {
  if (!motion.disc_angle.empty()) return motion.disc_angle;
  const std::size_t n = motion.size();
  std::vector<double> angle(n);
  if (n == 0) return angle;
  if (!motion.disc_speed.empty()) {
    angle[0] = motion.disc_speed[0] * motion.time[0];
    for (std::size_t i = 1; i < n; ++i) {
      angle[i] = angle[i - 1] +
                 0.5 * (motion.disc_speed[i - 1] + motion.disc_speed[i]) * (motion.time[i] - motion.time[i - 1]);
    }
    return angle;
  }
  // Steps with speeds of their own follow one another; elsewhere the speed of the record holds.
  double start = 0, started = 0;
  for (const Step& step : motion.steps) {
    const Condition& speed = step.conditions.speed.known() ? step.conditions.speed : motion.conditions.speed;
    if (!speed.known()) return {};
    for (std::size_t i = step.begin; i < step.end; ++i) angle[i] = start + speed.value * (motion.time[i] - started);
    if (step.end > 0 && step.end < n) {
      start += speed.value * (motion.time[step.end] - started);
      started = motion.time[step.end];
    }
  }
  return angle;
}

std::vector<double> sliding_distance(const Motion& motion) {
  std::vector<double> distance(motion.size(), 0.0);
  const double rest = 3 * motion.velocity_noise;
  const auto slides = [&](double v) {
    return motion.sticks && std::abs(v - motion.plateau_velocity) <= rest ? 0 : std::abs(v);
  };
  for (std::size_t i = 1; i < motion.size(); ++i) {
    distance[i] = distance[i - 1] + 0.5 * (motion.time[i] - motion.time[i - 1]) *
                                        (slides(motion.relative_velocity[i - 1]) + slides(motion.relative_velocity[i]));
  }
  return distance;
}

}  // namespace tribofit
