#include "tribofit/campaign/over_conditions.hpp"

#include <algorithm>
#include <cmath>

#include "limits.hpp"
#include "statistics/thinning.hpp"
#include "tribofit/campaign/compare.hpp"

namespace tribofit {
namespace {

/// Values of a condition that differ by more than what a reading off a plateau does.
std::size_t count_of_values(std::span<const PooledGroup> groups, Condition Conditions::*which) {
  std::vector<double> values;
  for (const PooledGroup& group : groups) {
    const double value = (group.conditions.*which).value;
    if (!std::isfinite(value)) return 0;
    values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  std::size_t count = values.empty() ? 0 : 1;
  for (std::size_t k = 1; k < values.size(); ++k)
    count += static_cast<std::size_t>(values[k] > (1 + kSameReading) * values[k - 1]);
  return count;
}

/// The conditions of a group without one; nor those that were read off the record.
std::string without(const PooledGroup& group, Condition Conditions::*which) {
  Conditions rest = group.conditions;
  rest.*which = {};
  if (rest.speed.source == "plateau") rest.speed = {};
  const bool any = rest.radius.known() || rest.speed.known() || rest.load.known() || !group.others.empty();
  return any ? conditions_text(rest, group.others) : "";
}

}  // namespace

OverConditions::OverConditions(std::span<const PooledGroup> groups) {
  std::size_t most = 1;
  const ConditionInfo* most_varied = nullptr;
  for (const ConditionInfo& condition : condition_infos) {
    const std::size_t count = count_of_values(groups, condition.member);
    if (count > most) most = count, most_varied = &condition;
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    x.push_back(most_varied != nullptr ? (groups[g].conditions.*(most_varied->member)).value / most_varied->si
                                       : static_cast<double>(g));
    const std::string name = most_varied != nullptr ? without(groups[g], most_varied->member) : "";
    auto found = std::find_if(series.begin(), series.end(), [&](const Series& s) { return s.name == name; });
    if (found == series.end()) found = series.insert(series.end(), {name, {}, {}});
    found->groups.push_back(g);
  }
  for (Series& one : series) {
    std::stable_sort(one.groups.begin(), one.groups.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
    for (const std::size_t g : one.groups) one.x.push_back(x[g]);
  }
  if (most_varied != nullptr) {
    quantity = most_varied->meaning;
    unit = most_varied->unit;
    return;
  }
  for (const PooledGroup& group : groups) names.push_back(conditions_text(group));
}

std::vector<std::size_t> OverConditions::some(std::size_t most) const {
  std::vector<std::size_t> all, out;
  for (const Series& one : series) all.insert(all.end(), one.groups.begin(), one.groups.end());
  for (const std::size_t k : thinned(all.size(), most)) out.push_back(all[k]);
  return out;
}

}  // namespace tribofit
