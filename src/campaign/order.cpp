#include "order.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <numeric>
#include <string_view>

#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

bool tells_order(const std::string& name) {
  const std::string plain = replaced(replaced(lower_case(name), "_", " "), "-", " ");
  constexpr std::array<std::string_view, 11> known = {"order",    "run order",  "sequence",  "date",
                                                      "datetime", "time",       "date time", "timestamp",
                                                      "started",  "start time", "start"};
  return std::find(known.begin(), known.end(), plain) != known.end();
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  const auto [last, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || last != end) return std::nullopt;
  return value;
}

namespace {

const std::string* value_of(const RunResult& run, const std::string& name) {
  for (const OtherCondition& other : run.run.others) {
    if (other.name == name && !other.value.empty()) return &other.value;
  }
  return nullptr;
}

void rank_by(const std::string& name, std::span<RunResult> runs) {
  std::vector<std::size_t> by_time(runs.size());
  std::iota(by_time.begin(), by_time.end(), 0u);
  const auto value = [&](std::size_t k) -> const std::string& { return *value_of(runs[k], name); };
  const bool numbers =
      std::all_of(by_time.begin(), by_time.end(), [&](std::size_t k) { return number_in(value(k)).has_value(); });
  const auto before = [&](std::size_t a, std::size_t b) {  // numbers by size, anything else by its letters
    return numbers ? *number_in(value(a)) < *number_in(value(b)) : value(a) < value(b);
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

void put_in_order(std::span<RunResult> runs) {
  if (runs.empty()) return;
  for (const OtherCondition& other : runs.front().run.others) {
    if (!tells_order(other.name)) continue;
    if (!std::all_of(runs.begin(), runs.end(), [&](const RunResult& r) { return value_of(r, other.name); })) continue;
    rank_by(other.name, runs);
    return;
  }
}

}  // namespace tribofit
