#include "tribofit/campaign/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

/// Whether what a row states fits; what it does not state does.
bool fits(const Condition& stated, const Condition& own) {
  if (!stated.known()) return true;
  if (!own.known()) return false;
  // 4 rpm and 0.41888 rad/s are the same; a speed from the plateau carries its noise.
  const double tolerance = own.source == "plateau" ? 1e-2 : 1e-4;
  return std::abs(stated.value - own.value) <= tolerance * std::abs(stated.value);
}

bool fits(const EarlierValue& row, const PooledGroup& group) {
  const auto same = [&](const OtherCondition& stated) {
    return std::ranges::any_of(
        group.others, [&](const OtherCondition& own) { return own.name == stated.name && own.value == stated.value; });
  };
  const auto fit = [&](const ConditionInfo& info) {
    return fits(row.conditions.*info.member, group.conditions.*info.member);
  };
  return std::ranges::all_of(condition_infos, fit) && std::ranges::all_of(row.others, same);
}

ComparedValue compared(const EarlierValue& earlier, const PooledValue& ours) {
  ComparedValue out;
  out.earlier = earlier;
  out.ours = ours;
  const double difference = ours.value - earlier.value;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  out.percent = earlier.value != 0 ? 100 * difference / std::abs(earlier.value) : nan;
  const double theirs = std::isfinite(earlier.std_error) ? earlier.std_error : 0;
  const double total = std::hypot(ours.std_error, ours.systematic, theirs);
  out.in_std_errors = total > 0 ? difference / total : nan;
  out.inside95 = ours.lower95 <= earlier.value && earlier.value <= ours.upper95;
  return out;
}

/// Every value of a group that an earlier one can be put beside: law by law, each by both protocols.
void add_partners(const EarlierValue& earlier, const PooledGroup& group, std::size_t index,
                  std::vector<ComparedValue>& out) {
  const auto add = [&](const std::vector<PooledValue>& values, const std::string& law, const std::string& protocol) {
    const auto ours = std::ranges::find_if(values, [&](const PooledValue& v) {
      return full_name(v.name, v.effect) == earlier.name && v.unit == earlier.unit && std::isfinite(v.value);
    });
    if (ours == values.end()) return;
    ComparedValue& one = out.emplace_back(compared(earlier, *ours));
    one.group = index;
    one.law = law;
    one.protocol = protocol;
  };
  std::set<std::string> laws;
  for (const auto& first : group.fits) {
    if (!laws.insert(first.law).second || (!earlier.law.empty() && earlier.law != first.law)) continue;
    for (const auto& fit : group.fits) {
      const bool is_meant = earlier.protocol.empty() || earlier.protocol == fit.protocol;
      if (fit.law == first.law && is_meant) add(fit.parameters, fit.law, fit.protocol);
    }
  }
  if (earlier.law.empty() && earlier.protocol.empty()) add(group.measures, "", "");
}

}  // namespace

std::string conditions_text(const Conditions& conditions, const std::vector<OtherCondition>& others) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  for (const ConditionInfo& info : condition_infos) {
    const Condition& condition = conditions.*info.member;
    if (condition.known()) add(fmt::format("{} {}", general(condition.value / info.si, 4), info.unit));
  }
  for (const OtherCondition& other : others) {
    if (!other.value.empty()) add(other.name + " " + other.value);
  }
  return text.empty() ? "conditions not known" : text;
}

EarlierComparison compare_with(const EarlierTable& table, std::span<const PooledGroup> groups) {
  EarlierComparison out;
  out.path = table.path;
  out.unmatched = table.notes;
  std::vector<bool> met(groups.size(), false);
  std::set<std::size_t> lines_without;
  std::set<std::string> columns_without;
  for (const EarlierValue& earlier : table.values) {
    bool some_group = false;
    const std::size_t before = out.values.size();
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (!fits(earlier, groups[g])) continue;
      some_group = met[g] = true;
      add_partners(earlier, groups[g], g, out.values);
    }
    if (!some_group && lines_without.insert(earlier.line).second) {
      out.unmatched.push_back(fmt::format("line {}: there are no runs of {}", earlier.line,
                                          conditions_text(earlier.conditions, earlier.others)));
    }
    const std::string what = earlier.column + (earlier.law.empty() ? "" : " of the " + earlier.law + " law");
    if (some_group && out.values.size() == before && columns_without.insert(what).second) {
      out.unmatched.push_back(fmt::format("line {}: column {}: no fit holds it", earlier.line, what));
    }
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (met[g]) continue;
    out.unmatched.push_back("the table has no row for the runs of " + conditions_text(groups[g]));
  }
  return out;
}

EarlierComparison::Agreement EarlierComparison::agreement() const {
  Agreement out;
  for (const ComparedValue& v : values) {
    if (v.protocol == to_string(Protocol::published)) continue;
    ++out.values;
    out.inside += v.inside95 ? 1 : 0;
  }
  return out;
}

}  // namespace tribofit
