#include "tribofit/segmentation/stick_motion.hpp"

#include <span>

#include "statistics/reductions.hpp"

namespace tribofit {
namespace {

constexpr std::size_t tenths = 10, first_part = 2, least_samples = 5;

}  // namespace

std::vector<StickCreep> stick_motion(const Motion& motion, const Segmentation& segmentation) {
  std::vector<StickCreep> sticks;
  const std::span<const double> time(motion.time), velocity(motion.relative_velocity), friction(motion.friction);
  for (std::size_t c = 0; c < segmentation.cycles.size(); ++c) {
    const Cycle& cycle = segmentation.cycles[c];
    const std::size_t length = cycle.stick.size() / tenths;
    if (length < least_samples || !segmentation.is_selected(cycle)) continue;
    const double sign = cycle.direction;
    StickCreep stick;
    stick.cycle = c;
    for (std::size_t k = 0; k < stick.parts.size(); ++k) {
      const std::size_t begin = cycle.stick.begin + (first_part + k) * length;
      StickPart& part = stick.parts[k];
      part.time = 0.5 * (time[begin] + time[begin + length - 1]);
      part.relative_velocity = sign * mean_of(velocity.subspan(begin, length));
      part.disc_velocity = sign * (motion.disc_velocity.empty()
                                       ? motion.constant_disc_velocity
                                       : mean_of(std::span<const double>(motion.disc_velocity).subspan(begin, length)));
      part.friction = sign * mean_of(friction.subspan(begin, length));
      const double before = mean_of(friction.subspan(begin - length, length));
      const double after = mean_of(friction.subspan(begin + length, length));
      part.friction_rate = sign * (after - before) / (2 * static_cast<double>(length) * motion.step);
    }
    sticks.push_back(stick);
  }
  return sticks;
}

}  // namespace tribofit
