#pragma once

#include <string>

#include "style.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// The fits as a person reads them: one table each, then protocols and laws side by side.
std::string fit_lines(const Identification& result, const TerminalOptions& options, const Style& style);

}  // namespace tribofit
