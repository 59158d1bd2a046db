#pragma once

#include <span>
#include <string>
#include <string_view>

namespace tribofit {

/// The known name closest to `text`, for messages that offer it. Empty when `known` is.
/// Closest by edits and swaps of neighbouring letters; a change of case counts half an edit.
std::string nearest_name(std::string_view text, std::span<const std::string> known);

/// As above, but only where no more than half of `text` would have to change, or where one name alone has it as a part;
/// empty otherwise.
std::string likely_name(std::string_view text, std::span<const std::string> known);

}  // namespace tribofit
