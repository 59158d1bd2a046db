#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "output/csv_table.hpp"
#include "output/json.hpp"
#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/run_result.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

/// "radius_source".
inline std::string source_key(const ConditionInfo& info) {
  return std::string(info.name) + "_source";
}

/// {"radius_mm", "speed_rpm", "load_N"}, null where not known.
inline Json condition_values(const Conditions& conditions) {
  Json values = Json::object();
  for (const ConditionInfo& info : condition_infos) {
    values[info.column] = number((conditions.*info.member).value / info.si);
  }
  return values;
}

/// The same with "radius_source", ..., null where nothing said it.
inline Json json_of(const Conditions& conditions) {
  Json json = condition_values(conditions);
  for (const ConditionInfo& info : condition_infos) {
    json[source_key(info)] = text_or_null((conditions.*info.member).source);
  }
  return json;
}
inline void read_json(const Json& json, Conditions& conditions) {
  for (const ConditionInfo& info : condition_infos) {
    Condition& one = conditions.*info.member;
    const auto value = json.find(info.column), source = json.find(source_key(info));
    one.value = value != json.end() && value->is_number() ? value->get<double>() * info.si : std::nan("");
    one.source = source != json.end() && source->is_string() ? source->get<std::string>() : "";
  }
}

/// The columns of conditions in tables of a campaign: radius_mm, speed_rpm, load_N and those that any run states.
class ConditionCells {
 public:
  explicit ConditionCells(std::span<const RunResult> runs) {
    for (const RunResult& run : runs) add(run.run.others);
  }
  explicit ConditionCells(std::span<const PooledGroup> groups) {
    for (const PooledGroup& group : groups) add(group.others);
  }

  std::string header() const {
    const std::string line = csv_line(Json(names_));
    return csv_names(condition_values({})) + (names_.empty() ? "" : "," + line.substr(0, line.size() - 1));
  }

  /// The cells of a row, as a list.
  Json of(const Conditions& c, const std::vector<OtherCondition>& others) const {
    Json row = {condition_values(c)};
    for (const std::string& name : names_) {
      const auto found =
          std::find_if(others.begin(), others.end(), [&](const OtherCondition& other) { return other.name == name; });
      row.push_back(found == others.end() ? Json(nullptr) : Json(found->value));
    }
    return row;
  }

 private:
  void add(const std::vector<OtherCondition>& others) {
    for (const OtherCondition& other : others) {
      if (std::find(names_.begin(), names_.end(), other.name) == names_.end()) names_.push_back(other.name);
    }
  }

  std::vector<std::string> names_;
};

}  // namespace tribofit
