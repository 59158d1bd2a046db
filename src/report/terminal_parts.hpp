#pragma once

#include <string>
#include <string_view>

#include "style.hpp"

namespace tribofit {

struct Identification;

/// Lines that several of the terminal's pages have.

/// "  name      text", the text broken to the width and indented behind the name.
std::string item(const Style& style, std::string_view name, std::string_view text);
/// Name and size of the trace, and how it was read.
std::string trace_lines(const Identification& trace, const Style& style);
std::string condition_lines(const Identification& trace, const Style& style);
std::string health_lines(const Identification& trace, const Style& style);

}  // namespace tribofit
