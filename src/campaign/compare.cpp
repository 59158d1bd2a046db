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
    return std::any_of(group.others.begin(), group.others.end(),
                       [&](const OtherCondition& own) { return own.name == stated.name && own.value == stated.value; });
  };
  return fits(row.conditions.radius, group.conditions.radius) && fits(row.conditions.speed, group.conditions.speed) &&
         fits(row.conditions.load, group.conditions.load) && std::all_of(row.others.begin(), row.others.end(), same);
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

const PooledValue* find(std::span<const PooledValue> values, const EarlierValue& earlier) {
  const auto found = std::find_if(values.begin(), values.end(), [&](const PooledValue& v) {
    return full_name(v.name, v.effect) == earlier.name && v.unit == earlier.unit && std::isfinite(v.value);
  });
  return found == values.end() ? nullptr : &*found;
}

/// Every value of a group that an earlier one can be put beside: law by law, each by both protocols.
void add_partners(const EarlierValue& earlier, const PooledGroup& group, std::size_t index,
                  std::vector<ComparedValue>& out) {
  const auto add = [&](const PooledValue* ours, const std::string& law, const std::string& protocol) {
    if (ours == nullptr) return;
    out.push_back(compared(earlier, *ours));
    out.back().group = index;
    out.back().law = law;
    out.back().protocol = protocol;
  };
  std::vector<std::string> laws;
  for (const auto& fit : group.fits) {
    if (std::find(laws.begin(), laws.end(), fit.law) == laws.end()) laws.push_back(fit.law);
  }
  for (const std::string& law : laws) {
    if (!earlier.law.empty() && earlier.law != law) continue;
    for (const auto& fit : group.fits) {
      const bool protocol_fits = earlier.protocol.empty() || earlier.protocol == fit.protocol;
      if (fit.law == law && protocol_fits) add(find(fit.parameters, earlier), fit.law, fit.protocol);
    }
  }
  if (earlier.law.empty() && earlier.protocol.empty()) add(find(group.measures, earlier), "", "");
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
