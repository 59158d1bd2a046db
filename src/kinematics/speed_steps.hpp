#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "channel_samples.hpp"
#include "plateau_search.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit::kinematics {

/// Blocks from the middle of the first plateau at a level to that of the last.
struct SpeedLevel {
  std::size_t begin = 0, end = 0;
  double level = 0;  ///< omega r there [m/s]
};

/// Levels of the plateaus of a disc whose speed changes at once, in the order of time; empty where it does not. A
/// ripple, a drift and a run-up are no such steps.
std::vector<SpeedLevel> find_speed_levels(const PlateauSearch& search);

/// omega r of every sample; it changes half way between two levels. length: samples of a block.
std::vector<double> stepped_speed(const std::vector<SpeedLevel>& levels, std::size_t length, std::size_t samples);

/// Samples from the last plateau at one level to the first at the next, from middle to middle: the speed changed
/// somewhere between, perhaps in stick.
std::vector<SampleSpan> changes_between(const std::vector<SpeedLevel>& levels, std::size_t length);

/// What the steps are, against the stated omega r [m/s]; 0: none was stated.
HealthItem check_speed_steps(const Motion& motion, const std::vector<SpeedLevel>& levels, const BlockMeans& blocks,
                             double stated);

}  // namespace tribofit::kinematics
