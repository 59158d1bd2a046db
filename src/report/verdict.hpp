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

/// `identify` with the user's own options, `more` behind them, and the trace. options.arguments begins with the verb
/// where there is one.
std::string command_line(const TerminalOptions& options, const std::string& more, const std::string& path);

}  // namespace tribofit
