#pragma once

#include <string>
#include <vector>

namespace tribofit {

struct DiagnosedTraces;  // diagnosis/diagnosis.hpp
struct Identification;
struct RigIdentification;
struct RunPlan;  // study/plan.hpp
struct TwinIdentification;

struct JsonOptions {
  std::vector<std::string> arguments;  ///< of the command line, echoed under tool.arguments
};

/// The result of one trace as JSON, for programs, as data/schema/tribofit.schema.json describes it. Keys may be added
/// in later versions, none changes.
std::string to_json(const Identification& result, const JsonOptions& options = {});

/// As above with "diagnosis"; the fits are those of the diagnosis: the bare laws, then the final model.
std::string to_json(const DiagnosedTraces& result, const JsonOptions& options = {});

/// {"tool", "trace", "conditions", "health", "stick_slip", "rig", "analysed", "warnings"}, where "rig" has mass_kg,
/// damping_N_s_per_mm, stiffness_N_per_mm (mass_kg_per_N, damping_s_per_mm, stiffness_per_mm where no normal force is
/// known), natural_frequency_hz, damping_ratio, stick_slope_stiffness_N_per_mm (or _per_mm), each {"value",
/// "std_error", "ci95", "systematic_error"} or null, their covariance, and messages.
std::string to_json(const RigIdentification& result, const JsonOptions& options = {});

/// {"tool", "trace", "conditions", "health", "stick_slip", "fits", "rig" (beside the bare law), "rigs" (one a column),
/// "twin", "analysed", "warnings"} with
/// "twin": {"columns", "measures": [{"name", "unit", "measured": {"value", "std_error"}, "simulated": [{"value",
/// "std_error", "difference_in_std_errors"}]}], "rms_difference", "failures", "simulations", "messages", "reason",
/// "next"}.
std::string to_json(const TwinIdentification& result, const JsonOptions& options = {});

/// As of the diagnosis, with "plan".
std::string plan_json(const DiagnosedTraces& diagnosed, const RunPlan& plan, const JsonOptions& options = {});

}  // namespace tribofit
