#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "csv_text.hpp"
#include "numbers.hpp"
#include "tribofit/campaign/pool.hpp"
#include "tribofit/campaign/run_result.hpp"

namespace tribofit {

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
    std::string text = "radius_mm,speed_rpm,load_N";
    for (const std::string& name : names_) text += "," + cell(name);
    return text;
  }

  std::string of(const Conditions& c, const std::vector<OtherCondition>& others) const {
    std::string text = cell(c.radius.value / kMillimetre) + "," + cell(c.speed.value / kRpm) + "," + cell(c.load.value);
    for (const std::string& name : names_) {
      const auto found =
          std::find_if(others.begin(), others.end(), [&](const OtherCondition& other) { return other.name == name; });
      text += "," + (found == others.end() ? std::string() : cell(found->value));
    }
    return text;
  }

 private:
  void add(const std::vector<OtherCondition>& others) {
    for (const OtherCondition& other : others) {
      if (std::find(names_.begin(), names_.end(), other.name) == names_.end()) names_.push_back(other.name);
    }
  }

  std::vector<std::string> names_;
};

/// A list of names and values.
inline Json others_json(const std::vector<OtherCondition>& others) {
  return list_of(others, [](const OtherCondition& o) { return object("name", o.name, "value", o.value); });
}

}  // namespace tribofit
