#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// Bytes of the character at the beginning of a text, where that controls a terminal, has no width, or turns round what
/// stands after it; 0 for any other.
std::size_t unseen_bytes(std::string_view text);

/// `text` with control characters spelt out ("\\n", "\\x1b"), and with those of no width or of the direction of writing
/// ("\\u200b", "\\u202e"): a terminal shows and does not obey them, and no name looks like another.
std::string printable(std::string_view text);

/// "slope [mm/s]", or the name alone where the unit is "1" or empty.
std::string with_unit(const std::string& name, const std::string& unit);

/// " mm/s" behind a number; nothing where the unit is "1".
std::string unit_behind(const std::string& unit);

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& names, std::string_view last = "and");

/// "Most"; the rest of the text as it is.
std::string capitalised(std::string text);

/// Whether brackets and braces of a JSON text, comments allowed, are nested deeper than that. Far deeper ones are
/// copied by a recursion that no stack holds, so this is asked before parsing; no file of this program has as many
/// levels as the default. Cost: one pass.
bool is_nested_deeper(std::string_view json, int levels = 64);

}  // namespace tribofit
