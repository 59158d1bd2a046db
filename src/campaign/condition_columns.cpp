#include "condition_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "order.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

ConditionColumn column_of(std::span<const RunResult> runs, const char* name, const char* unit, double si,
                          Condition Conditions::*which) {
  ConditionColumn out{name, unit, {}, {}};
  for (const RunResult& run : runs) {
    const Condition& said = run.run.conditions.*which;
    const Condition& used = said.known() ? said : run.conditions.*which;
    out.number.push_back(used.known() ? std::optional(used.value / si) : std::nullopt);
    out.text.push_back(used.known() ? fmt::format("{:.6g} {}", used.value / si, unit) : "");
  }
  return out;
}

}  // namespace

std::vector<ConditionColumn> condition_columns(std::span<const RunResult> runs) {
  std::vector<ConditionColumn> out = {
      column_of(runs, "radius", "mm", 1e-3, &Conditions::radius),
      column_of(runs, "speed", "rpm", kRpm, &Conditions::speed),
      column_of(runs, "load", "N", 1, &Conditions::load),
  };
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const OtherCondition& other : runs[r].run.others) {
      if (tells_order(other.name)) continue;
      auto at = std::find_if(out.begin() + 3, out.end(), [&](const auto& column) { return column.name == other.name; });
      if (at == out.end()) {
        out.push_back(
            {other.name, "", std::vector<std::string>(runs.size()), std::vector<std::optional<double>>(runs.size())});
        at = out.end() - 1;
      }
      at->text[r] = other.value;
      at->number[r] = number_in(other.value);
    }
  }
  std::erase_if(out, [](const ConditionColumn& column) {
    return std::all_of(column.text.begin(), column.text.end(), [](const std::string& t) { return t.empty(); });
  });
  return out;
}

}  // namespace tribofit
