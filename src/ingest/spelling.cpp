#include "tribofit/ingest/spelling.hpp"

#include <algorithm>

#include "tribofit/ingest/nearest_name.hpp"

namespace tribofit {
namespace {

/// Edit distance in half steps: 2 for an edit or a swap of neighbours, 1 for a change of case.
std::size_t distance(std::string_view a, std::string_view b) {
  const std::string lower_a = lower_case(a), lower_b = lower_case(b);
  std::vector<std::vector<std::size_t>> cost(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i) cost[i][0] = 2 * i;
  for (std::size_t j = 0; j <= b.size(); ++j) cost[0][j] = 2 * j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const char x = a[i - 1], y = b[j - 1];
      const std::size_t change = x == y ? 0U : lower_a[i - 1] == lower_b[j - 1] ? 1U : 2U;
      cost[i][j] = std::min({cost[i - 1][j - 1] + change, cost[i - 1][j] + 2, cost[i][j - 1] + 2});
      if (i > 1 && j > 1 && x == b[j - 2] && y == a[i - 2]) cost[i][j] = std::min(cost[i][j], cost[i - 2][j - 2] + 2);
    }
  }
  return cost[a.size()][b.size()];
}

}  // namespace

std::string nearest_name(std::string_view text, std::span<const std::string> known) {
  if (known.empty()) return {};
  return *std::ranges::min_element(known, {}, [&](const std::string& name) { return distance(text, name); });
}

std::string likely_name(std::string_view text, std::span<const std::string> known) {
  constexpr std::size_t kFewestLetters = 3;  // a name may be meant by its part: lag, frictional-lag
  const auto has_part = [&](const std::string& name) { return name.find(text) != std::string::npos; };
  if (text.size() >= kFewestLetters && std::ranges::count_if(known, has_part) == 1)
    return *std::ranges::find_if(known, has_part);
  const std::string nearest = nearest_name(text, known);
  return distance(text, nearest) <= std::max<std::size_t>(2, text.size()) ? nearest : std::string();
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = likely_name(word, candidates);
  return nearest.empty() ? std::string() : " (did you mean " + nearest + "?)";
}

std::string with_article(std::string_view noun) {
  const bool vowel = !noun.empty() && std::string_view("aeiou").find(noun.front()) != std::string_view::npos;
  return (vowel ? "an " : "a ") + std::string(noun);
}

std::string_view trimmed(std::string_view text) {
  const auto is_space = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t at = text.find(separator); at != std::string_view::npos; at = text.find(separator, begin)) {
    parts.emplace_back(text.substr(begin, at - begin));
    begin = at + separator.size();
  }
  parts.emplace_back(text.substr(begin));
  return parts;
}

std::vector<std::string> split(std::string_view text, char separator) {
  return split(text, std::string_view(&separator, 1));
}

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::size_t place_among(std::string_view word, std::string_view words) {
  for (std::size_t place = 0; !words.empty(); ++place) {
    const std::size_t end = std::min(words.find(' '), words.size());
    if (words.substr(0, end) == word) return place;
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return std::string_view::npos;
}

std::string listed(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), most); ++i) text += (text.empty() ? "" : ", ") + names[i];
  return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more" : text;
}

}  // namespace tribofit
