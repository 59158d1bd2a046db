#pragma once

#include <string>

#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// How good the best fit is, in one sentence an engineer would say.
std::string verdict(const Identification& result);

/// A command that exists, with the user's own options, and what it is for.
struct Suggestion {
  std::string reason;  ///< "to ..."
  std::string command;
};
Suggestion next_command(const Identification& result, const TerminalOptions& options);

}  // namespace tribofit
