#pragma once

#include <string>

#include "command.hpp"
#include "tribofit/study/plan.hpp"

/// What can be done at the rig, as typed.
struct MeansOptions {
  tribofit::Means means;  ///< without the speeds
  std::string speeds;     ///< which may be at the radius of the record
};

void add_means_options(const Command& app, MeansOptions& options);

/// In SI and checked. radius: that of the record as typed, for speeds such as 6mm/s; may be empty.
/// Throws UsageError, or tribofit::InputError that names the option.
tribofit::Means means_from(const MeansOptions& options, const std::string& radius);
