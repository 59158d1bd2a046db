#pragma once

/// What the tables of the benchmark have in common.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "hidden_effects.hpp"
#include "rates.hpp"

namespace recovery {

using Outcomes = std::vector<const Outcome*>;

inline Outcomes of_kind(const std::vector<Outcome>& all, Kind kind) {
  Outcomes found;
  for (const Outcome& o : all) {
    if (o.tested.kind == kind) found.push_back(&o);
  }
  return found;
}

/// Groups in the order of their first case.
inline std::vector<Outcomes> by_group(const Outcomes& outcomes) {
  std::vector<Outcomes> groups;
  std::map<std::string, std::size_t> at;
  for (const Outcome* o : outcomes) {
    const auto [entry, is_new] = at.emplace(o->tested.group, groups.size());
    if (is_new) groups.emplace_back();
    groups[entry->second].push_back(o);
  }
  return groups;
}

template <class Predicate>
std::size_t count(const Outcomes& outcomes, Predicate predicate) {
  return static_cast<std::size_t>(std::count_if(outcomes.begin(), outcomes.end(), predicate));
}

inline std::size_t count(const Outcomes& outcomes, Naming naming) {
  return count(outcomes, [&](const Outcome* o) { return o->failure.empty() && o->naming == naming; });
}

inline bool is_right(const Outcome* o) {
  return o->right;
}

struct Parameters {
  std::size_t n = 0, close = 0, intervals = 0, covered = 0;
};

inline Parameters parameters(const Outcomes& outcomes) {
  Parameters out;
  for (const Outcome* o : outcomes) {
    if (!o->right) continue;
    for (const Recovered& p : o->parameters) {
      ++out.n;
      out.close += std::abs(p.value - p.truth) <= 0.1 * std::abs(p.truth) ? 1u : 0u;
      out.intervals += p.has_interval() ? 1u : 0u;
      out.covered += p.has_interval() && p.is_covered() ? 1u : 0u;
    }
  }
  return out;
}

/// "drift 2, runout 1", most frequent first.
inline std::string list(const std::map<std::string, std::size_t>& counts) {
  std::vector<std::pair<std::string, std::size_t>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [key, n] : sorted) {
    fmt::format_to(std::back_inserter(text), "{}{} {}", text.empty() ? "" : ", ", key, n);
  }
  return text;
}

/// What was named, and what else was said, where nothing is hidden, as Markdown.
std::string empties_table(const Outcomes& empties);

/// How often each group of cases was named, as Markdown.
std::string groups_table(const Outcomes& all);

}  // namespace recovery
