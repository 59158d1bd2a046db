#include "condition_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "order.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

ConditionColumn column_of(std::span<const RunResult> runs, const ConditionInfo& which) {
  ConditionColumn out{std::string(which.name), std::string(which.unit), {}, {}};
  for (const RunResult& run : runs) {
    const Condition& said = run.run.conditions.*which.member;
    const Condition& used = said.known() ? said : run.conditions.*which.member;
    out.number.push_back(used.known() ? std::optional(used.value / which.si) : std::nullopt);
    out.text.push_back(used.known() ? fmt::format("{} {}", general(used.value / which.si), which.unit) : "");
  }
  return out;
}

}  // namespace

std::vector<ConditionColumn> condition_columns(std::span<const RunResult> runs) {
  std::vector<ConditionColumn> out;
  for (const ConditionInfo& condition : condition_infos) out.push_back(column_of(runs, condition));
  for (std::size_t r = 0; r < runs.size(); ++r) {
    for (const OtherCondition& other : runs[r].run.others) {
      if (tells_order(other.name)) continue;
      auto at = std::find_if(out.begin() + condition_infos.size(), out.end(),
                             [&](const auto& column) { return column.name == other.name; });
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
