#pragma once

#include <string>
#include <vector>

namespace tribofit {

struct DiagnosedTraces;  // diagnosis/diagnosis.hpp
struct Identification;

struct JsonOptions {
  std::vector<std::string> arguments;  ///< of the command line, echoed under tool.arguments
};

/// The result of one trace as JSON, for programs.
///
/// {"tool", "trace", "conditions", "health", "stick_slip", "fits", "best", "warnings"}; every number in the unit its
/// name or its "unit" says. What is not known is null. Both protocols are in "fits". Keys may be added in later
/// versions, none changes. Conditions that differ between the steps of a trace are null there and listed under "steps".
std::string to_json(const Identification& result, const JsonOptions& options = {});

/// As above with "diagnosis"; the fits are those of the diagnosis: the bare laws, then the final model.
///
/// Of several traces diagnosed together "trace" becomes "traces", a list as "conditions" and "stick_slip" are, items of
/// "health" carry the index of their trace, and parameters, all shared, carry "trace": null.
std::string to_json(const DiagnosedTraces& result, const JsonOptions& options = {});

}  // namespace tribofit
