#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "ingest/stated_conditions.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

/// The value of a further condition; empty where it is not stated.
inline std::string value_of(const std::vector<OtherCondition>& others, const std::string& name) {
  const auto found = std::ranges::find(others, name, &OtherCondition::name);
  return found == others.end() ? "" : found->value;
}

/// The place of a text in a list, to which it is added where it is not there yet.
inline std::size_t place_in(std::vector<std::string>& list, const std::string& text) {
  const auto at = static_cast<std::size_t>(std::ranges::find(list, text) - list.begin());
  if (at == list.size()) list.push_back(text);
  return at;
}

/// Adds the names of further conditions that are not known yet.
inline void add_names(const std::vector<OtherCondition>& others, std::vector<std::string>& names) {
  for (const OtherCondition& other : others) place_in(names, other.name);
}

/// A condition over the runs of a campaign.
struct ConditionColumn {
  std::string name, unit;         ///< "radius", "mm"; a further one without a unit
  std::vector<std::string> text;  ///< of each run, as stated; empty: not stated
  std::vector<double> number;     ///< the same in `unit`; NaN where it is none
};

/// Radius, speed and load as stated beforehand (else as used), further columns, all that any run states.
std::vector<ConditionColumn> condition_columns(std::span<const RunResult> runs);

/// Whether a column of that name can mean nothing but when a run was made.
bool tells_order(const std::string& name);

/// Sets the order in time of runs whose conditions state it, see read_results().
void put_in_order(std::span<RunResult> runs);

}  // namespace tribofit
