#pragma once

#include <string>

#include "commands.hpp"

namespace tribofit {

/// How good the best fit is, in one sentence an engineer would say.
std::string verdict(const Identification& result);

/// What to do next with a trace and its fits.
Suggestion next_command(const Identification& result, const ReportOptions& options);

}  // namespace tribofit
