#pragma once

#include <string>

#include "tribofit/report/json.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

struct TwinIdentification;  // study/twin.hpp

/// What a person reads after `identify twin`: the laws and the rig in a line each, measured and simulated motion side
/// by side with their difference in standard errors, where the twin fails, and the next command.
std::string render_twin(const TwinIdentification& result, const TerminalOptions& options = {});

/// The same for programs: {"tool", "trace", "conditions", "health", "stick_slip", "fits", "rig" (beside the bare law),
/// "rigs" (one a column), "twin", "analysed", "warnings"} with
/// "twin": {"columns", "measures": [{"name", "unit", "measured": {"value", "std_error"}, "simulated": [{"value",
/// "std_error", "difference_in_std_errors"}]}], "rms_difference", "failures", "simulations", "messages", "reason",
/// "next"}.
std::string to_json(const TwinIdentification& result, const JsonOptions& options = {});

/// The same as pictures: measures in standard errors, three cycles of friction and velocity measured and simulated, the
/// portraits, and the block on its disc, measured and simulated side by side.
Report report_of(const TwinIdentification& result, const ReportOptions& options = {});

}  // namespace tribofit
