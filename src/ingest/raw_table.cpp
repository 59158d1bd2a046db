#include "raw_table.hpp"

#include <algorithm>

#include "column_names.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

void LineMap::set(std::size_t row, std::size_t line) {
  if (!starts_.empty() && line_of(row) == line) return;
  if (!starts_.empty() && starts_.back().first == row) {
    starts_.back().second = line;
  } else {
    starts_.emplace_back(row, line);
  }
}

std::size_t LineMap::line_of(std::size_t row) const {
  if (starts_.empty()) return 0;
  auto at =
      std::upper_bound(starts_.begin(), starts_.end(), row, [](std::size_t r, const auto& s) { return r < s.first; });
  if (at != starts_.begin()) --at;
  return at->second + (row - at->first);
}

std::optional<double> value_of(const RawFact& fact, Quantity quantity, std::string_view bare_unit) {
  const std::string value = replaced(fact.value, ",", ".");
  const std::string in_name = parse_column_name(fact.name).unit.value_or("");
  try {
    return parse_quantity(value, quantity, fact.name, in_name.empty() ? bare_unit : in_name);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool RawTable::has_names() const {
  return std::any_of(columns.begin(), columns.end(), [](const RawColumn& column) { return column.named; });
}

std::vector<std::string> RawTable::names() const {
  std::vector<std::string> result;
  for (const RawColumn& column : columns) result.push_back(column.name);
  return result;
}

InputLocation RawTable::heading(std::size_t column) const {
  return {path, columns[column].line, columns[column].shown_name()};
}

}  // namespace tribofit
