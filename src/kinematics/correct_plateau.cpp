#include <fmt/format.h>

#include "tribofit/kinematics/motion.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

void correct_plateau(Motion& motion, PlateauCorrection correction) {
  const double ratio = motion.plateau_ratio, in_motion = motion.plateau_ratio_in_motion;
  if (correction == PlateauCorrection::none || !(ratio > 0)) return;  // NaN: not known
  motion.plateau_correction = correction;
  motion.corrected_ratio = ratio;
  const auto at = [&](std::size_t i) { return motion.disc_velocity_at(i); };
  const double constant = motion.constant_disc_velocity;
  if (correction == PlateauCorrection::radius) {
    // Behind a high-pass the integration constant was set to omega r as stated: it moves along.
    const double shift = in_motion - 1;
    for (std::size_t i = 0; i < motion.size(); ++i) motion.relative_velocity[i] += shift * at(i);
    motion.plateau_velocity += shift * constant;
    for (double& v : motion.disc_velocity) v *= ratio;
    motion.constant_disc_velocity *= ratio;
    motion.notes.push_back(fmt::format("disc: omega r times {} +/- {}, as the plateau of v_b says (radius)",
                                       fixed(ratio, 4), fixed(motion.plateau_ratio_std_error, 4)));
    return;
  }
  const double lost = ratio - in_motion, part = 1 / ratio;
  const auto corrected = [&](double v, double disc) { return disc - part * (disc - v + lost * constant); };
  for (std::size_t i = 0; i < motion.size(); ++i) {
    motion.relative_velocity[i] = corrected(motion.relative_velocity[i], at(i));
  }
  motion.plateau_velocity = corrected(motion.plateau_velocity, constant);
  motion.velocity_noise *= part;
  motion.notes.push_back(fmt::format("velocity: divided by {} +/- {}, as the plateau of v_b says (gain)",
                                     fixed(ratio, 4), fixed(motion.plateau_ratio_std_error, 4)));
}

}  // namespace tribofit
