#include "raw_table.hpp"

#include <algorithm>
#include <array>
#include <cstring>

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

std::uint64_t hash_bytes(const char* bytes, std::size_t count, std::uint64_t hash) {
  constexpr std::uint64_t prime = 1099511628211ULL;
  std::size_t i = 0;
  if (count >= 32) {
    std::array<std::uint64_t, 4> lanes = {hash, hash + 1, hash + 2,
                                          hash + 3};  // a multiplication need not wait for the last
    for (; i + 32 <= count; i += 32) {
      std::array<std::uint64_t, 4> words;
      std::memcpy(words.data(), bytes + i, 32);
      for (std::size_t k = 0; k < 4; ++k) lanes[k] = (lanes[k] ^ words[k]) * prime;
    }
    for (const std::uint64_t lane : lanes) hash = (hash ^ lane) * prime;
  }
  for (; i < count; ++i) hash = (hash ^ static_cast<unsigned char>(bytes[i])) * prime;
  return hash;
}

}  // namespace tribofit
