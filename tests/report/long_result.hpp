#pragma once

#include <cmath>
#include <random>

#include "made_up.hpp"

namespace tribofit {

/// A noisy record of many cycles, so that nothing is left out because it is smooth.
inline Identification long_result(std::size_t samples) {
  Identification result = made_up_result();
  Motion& motion = result.motion;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 1);
  motion.step = 5e-5;
  motion.time.resize(samples);
  motion.friction.resize(samples);
  motion.relative_velocity.resize(samples);
  for (std::size_t i = 0; i < samples; ++i) {
    motion.time[i] = motion.step * static_cast<double>(i);
    motion.friction[i] = 0.4 + 0.01 * noise(random);
    motion.relative_velocity[i] = 0.04 * std::abs(noise(random));
  }
  const Cycle cycle = result.segmentation.cycles[1];
  result.segmentation.cycles.clear();
  for (std::size_t begin = 0; begin + 400 <= samples; begin += 400) {
    Cycle c = cycle;
    c.stick = {begin, begin + 300};
    c.slip = {begin + 300, begin + 400};
    c.stick_complete = c.slip_complete = true;
    c.break_away_time = motion.time[begin + 300];
    c.restick_time = motion.time[begin + 399];
    result.segmentation.cycles.push_back(c);
  }
  return result;
}

}  // namespace tribofit
