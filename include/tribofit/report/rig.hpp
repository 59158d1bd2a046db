#pragma once

#include <string>

#include "tribofit/report/json.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

struct RigIdentification;  // fit/identification.hpp

/// What a person reads after `identify rig`: trace, conditions, health, the rig with its uncertainties and the check by
/// the slope of stick, what limits it, and the next command.
std::string render_rig(const RigIdentification& result, const TerminalOptions& options = {});

/// The same for programs: {"tool", "trace", "conditions", "health", "stick_slip", "rig", "analysed", "warnings"}, where
/// "rig" has mass_kg, damping_N_s_per_mm, stiffness_N_per_mm (mass_kg_per_N, damping_s_per_mm, stiffness_per_mm where
/// no normal force is known), natural_frequency_hz, damping_ratio, stick_slope_stiffness_N_per_mm (or _per_mm), each
/// {"value", "std_error", "ci95", "systematic_error"} or null, their covariance, and messages.
std::string to_json(const RigIdentification& result, const JsonOptions& options = {});

}  // namespace tribofit
