#pragma once

#include <span>
#include <vector>

#include "trial.hpp"

namespace tribofit::diagnosis {

/// Smooths v_r, parabolas over a part of the time of a slip (narrower at its ends), and returns the noise that is left
/// of it at every value: that of the stick before each slip, smoothed alike; zero where there is none. Linear in
/// values.
std::vector<double> quieten_velocity(std::span<const Record> records, Observations& observations);

/// Squares that this noise adds to those of a trial. What it does to friction at single values is an error of every
/// model but those that smooth what they predict, as a filter does: they would be ahead by it.
double squares_of_velocity_noise(const Level& level, const Trial& trial);

}  // namespace tribofit::diagnosis
