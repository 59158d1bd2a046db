#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

/// Calls line(text, number) for each line of a small table that says something: not for blank ones, those of separators
/// only and comments (#). Numbers count from 1, all lines counted.
template <class Line>
void for_each_table_line(std::string_view text, Line&& line) {
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view one = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (one.find_first_not_of(",;\t \r\"") == std::string_view::npos || trimmed(one).front() == '#') continue;
    line(one, number);
  }
}

}  // namespace tribofit
