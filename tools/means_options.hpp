#pragma once

#include <string>

#include "command.hpp"
#include "tribofit/study/plan.hpp"

/// What can be done at the rig, as typed.
struct MeansOptions {
  std::string speeds, radii, loads, springs, rates, minutes, pauses, mass_below;
  bool reversing = false, tap = false, lift = false, accelerometer = false;
};

void add_means_options(const Command& app, MeansOptions& options);

/// In SI and checked. radius: that of the record as typed, for speeds such as 6mm/s; may be empty.
/// Throws tribofit::InputError that names the option.
tribofit::Means means_from(const MeansOptions& options, const std::string& radius);
