#pragma once

#include <array>

namespace tribofit {

/// Names in input files that other modules use too.

/// Channels of a trace, as the command line and manifests have them; in the order of ingest's enum Channel.
inline constexpr std::array kChannelNames = {"time", "mu",    "v_b",   "v_r",         "force",     "torque",
                                             "load", "speed", "angle", "temperature", "std_error", "spring",
                                             "x_b",  "x_d",   "v_lp",  "step"};
/// A column that says which step of a recipe a sample belongs to.
inline constexpr const char* kStepColumn = kChannelNames.back();

/// force_sensor.crosstalk of the instruments file.
inline constexpr const char* kCrosstalkKey = "crosstalk";

}  // namespace tribofit
