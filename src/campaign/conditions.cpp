#include "conditions.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numeric>

#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

/// The number that a cell holds, and nothing else; NaN: none.
double number_in(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  return error == std::errc{} && last == end ? value : std::nan("");
}

ConditionColumn column_of(std::span<const RunResult> runs, const ConditionInfo& which) {
  ConditionColumn out{std::string(which.name), std::string(which.unit), {}, {}};
  for (const RunResult& run : runs) {
    const Condition& said = run.run.conditions.*which.member;
    const Condition& used = said.known() ? said : run.conditions.*which.member;
    out.number.push_back(used.value / which.si);
    out.text.push_back(used.known() ? fmt::format("{} {}", general(used.value / which.si), which.unit) : "");
  }
  return out;
}

void rank_by(const std::string& name, std::span<RunResult> runs) {
  std::vector<std::size_t> by_time(runs.size());
  std::iota(by_time.begin(), by_time.end(), 0u);
  std::vector<std::string> text;
  for (const RunResult& run : runs) text.push_back(value_of(run.run.others, name));
  const bool numbers = std::ranges::none_of(text, [](const auto& one) { return std::isnan(number_in(one)); });
  const auto before = [&](std::size_t a, std::size_t b) {  // numbers by size, anything else by its letters
    return numbers ? number_in(text[a]) < number_in(text[b]) : text[a] < text[b];
  };
  std::stable_sort(by_time.begin(), by_time.end(), before);
  for (std::size_t first = 0; first < by_time.size();) {
    std::size_t last = first;
    while (last + 1 < by_time.size() && !before(by_time[first], by_time[last + 1])) ++last;
    for (std::size_t k = first; k <= last; ++k) runs[by_time[k]].order = 0.5 * static_cast<double>(first + last);
    first = last + 1;
  }
}

}  // namespace

std::vector<ConditionColumn> condition_columns(std::span<const RunResult> runs) {
  std::vector<ConditionColumn> out;
  for (const ConditionInfo& condition : condition_infos) out.push_back(column_of(runs, condition));
  std::vector<std::string> others;
  for (const RunResult& run : runs) add_names(run.run.others, others);
  std::erase_if(others, tells_order);
  for (const std::string& name : others) {
    ConditionColumn& column = out.emplace_back(ConditionColumn{name, "", {}, {}});
    for (const RunResult& run : runs) {
      column.text.push_back(value_of(run.run.others, name));
      column.number.push_back(number_in(column.text.back()));
    }
  }
  std::erase_if(out, [](const ConditionColumn& column) {
    return std::ranges::all_of(column.text, [](const std::string& text) { return text.empty(); });
  });
  return out;
}

bool tells_order(const std::string& name) {
  const std::string plain = replaced(replaced(lower_case(name), "_", " "), "-", " ");
  return is_one_of(plain, {"order", "run order", "sequence", "date", "datetime", "time", "date time", "timestamp",
                           "started", "start time", "start"});
}

void put_in_order(std::span<RunResult> runs) {
  if (runs.empty()) return;
  for (const OtherCondition& other : runs.front().run.others) {
    const auto states = [&](const RunResult& run) { return !value_of(run.run.others, other.name).empty(); };
    if (!tells_order(other.name) || !std::ranges::all_of(runs, states)) continue;
    rank_by(other.name, runs);
    return;
  }
}

}  // namespace tribofit
