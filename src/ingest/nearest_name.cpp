#include "tribofit/ingest/nearest_name.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "tribofit/ingest/spelling.hpp"

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
  std::string best;
  std::size_t least = std::numeric_limits<std::size_t>::max();
  for (const std::string& name : known) {
    const std::size_t d = distance(text, name);
    if (d < least) {
      least = d;
      best = name;
    }
  }
  return best;
}

std::string likely_name(std::string_view text, std::span<const std::string> known) {
  constexpr std::size_t kFewestLetters = 3;  // a name may be meant by its part: lag, frictional-lag
  const auto has_part = [&](const std::string& name) { return name.find(text) != std::string::npos; };
  if (text.size() >= kFewestLetters && std::ranges::count_if(known, has_part) == 1)
    return *std::ranges::find_if(known, has_part);
  const std::string nearest = nearest_name(text, known);
  return distance(text, nearest) <= std::max<std::size_t>(2, text.size()) ? nearest : std::string();
}

}  // namespace tribofit
