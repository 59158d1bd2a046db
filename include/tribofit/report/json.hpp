#pragma once

#include <string>
#include <vector>

namespace tribofit {

struct Identification;  // pipeline.hpp

struct JsonOptions {
  std::vector<std::string> arguments;  ///< of the command line, echoed under tool.arguments
};

/// The result of one trace as JSON, for programs.
///
/// {"tool", "trace", "conditions", "health", "stick_slip", "fits", "best", "warnings"}; every number in the unit its
/// name or its "unit" says. What is not known is null. Both protocols are in "fits". Keys may be added in later
/// versions, none changes. Conditions that differ between the steps of a trace are null there and listed under "steps".
std::string to_json(const Identification& result, const JsonOptions& options = {});

}  // namespace tribofit
