#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "columns.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

std::size_t named_column(const RawTable& table, const std::string& wanted, Channel channel) {
  const InputLocation heading = {table.path, table.columns.empty() ? 0 : table.columns.front().line, ""};
  const auto& columns = table.columns;
  const auto exact =
      std::find_if(columns.begin(), columns.end(), [&](const RawColumn& c) { return c.named && c.name == wanted; });
  if (exact != columns.end()) return static_cast<std::size_t>(exact - columns.begin());
  if (wanted.size() > 1 && wanted[0] == '#') {
    std::size_t number = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [last, error] = std::from_chars(wanted.data() + 1, end, number);
    if (error == std::errc{} && last == end && number >= 1 && number <= columns.size()) return number - 1;
    throw InputError(fmt::format("there is no column {} for {}", wanted, to_string(channel)),
                     fmt::format("the file has {} columns, #1 to #{}; {}", columns.size(), columns.size(),
                                 lists_columns(table.path)),
                     heading);
  }
  std::vector<std::size_t> similar;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const bool same_name = lower_case(columns[i].name) == lower_case(wanted);
    if (same_name || parse_column_name(columns[i].name).base == parse_column_name(wanted).base) similar.push_back(i);
  }
  if (similar.size() == 1) return similar.front();
  const std::vector<std::string> names = table.names();
  throw InputError(
      fmt::format("there is no column '{}' for {}{}", wanted, to_string(channel), did_you_mean(wanted, names)),
      "the columns are: " + listed(names) + "; " + lists_columns(table.path), heading);
}

}  // namespace tribofit
