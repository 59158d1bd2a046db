#pragma once

#include <string>
#include <vector>

#include "tribofit/oscillator/drive.hpp"

namespace tribofit {

/// Speeds of the disc from "0s:2rpm,10s:4rpm" (empty: `speed` [rad/s] throughout) and pauses "10s,5s".
/// Throws InputError that says how to write them.
SpeedProfile stepped_speed_from(const std::string& steps, const std::vector<std::string>& pauses, double speed);

/// "10N,7s": a sine of that amplitude and period on the load; the mean load becomes that of the record of `duration`
/// [s]. Empty: nothing.
void swing_load(const std::string& text, double duration, Drive& drive);

/// "20degC..60degC": a ramp over the record; with ",15s" behind it a swing between the two of that period; the mean
/// temperature becomes that of the record. Empty: nothing.
void vary_temperature(const std::string& text, double duration, Drive& drive);

}  // namespace tribofit
