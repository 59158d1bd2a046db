#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/output/text.hpp"

namespace tribofit {

/// " (did you mean X?)" or nothing.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// "a force", "an angle".
std::string with_article(std::string_view noun);

/// `text` without white space at both ends.
std::string_view trimmed(std::string_view text);

/// `text` with A-Z in lower case; other bytes as they are.
std::string lower_case(std::string_view text);

/// `text` with every `from` replaced.
std::string replaced(std::string text, std::string_view from, std::string_view to);

/// The parts of `text` between separators; as many as there are separators, and one more.
std::vector<std::string> split(std::string_view text, std::string_view separator);
std::vector<std::string> split(std::string_view text, char separator);

/// Whether `name` is exactly one of `names`.
bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names);

/// Which of `words`, divided by blanks, is `word`; npos: none.
std::size_t place_among(std::string_view word, std::string_view words);
inline bool is_among(std::string_view word, std::string_view words) {
  return place_among(word, words) != std::string_view::npos;
}

/// "a, b, c"; of more than `most` the first ones, "and 12 more".
std::string listed(const std::vector<std::string>& names, std::size_t most = static_cast<std::size_t>(-1));

}  // namespace tribofit
