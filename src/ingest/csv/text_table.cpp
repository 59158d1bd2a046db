#include "text_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "dialect.hpp"
#include "encoding.hpp"
#include "ingest/input_file.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

std::string text_of(const InputFile& file, const TextTableRules& rules) {
  if (file.size() > rules.largest) throw InputError(rules.too_large, rules.size_advice, {file.path(), 0, ""});
  const std::string bytes = file.read_text(0, file.size());
  if (bytes.empty()) throw InputError("is empty", rules.header_advice, {file.path(), 0, ""});
  refuse_unless_text(bytes, file.path());
  return to_utf8(std::string_view(bytes).substr(byte_order_mark(bytes)), guess_encoding(bytes));
}

char separator_of(std::string_view header) {
  const auto fewer = [&](char a, char b) { return std::ranges::count(header, a) < std::ranges::count(header, b); };
  return std::max({',', ';', '\t'}, fewer);
}

}  // namespace

std::vector<std::string> TextTable::cells_of(std::size_t row) const {
  std::vector<std::string> cells = rows[row].cells;
  while (cells.size() > names.size() && cells.back().empty()) cells.pop_back();
  if (cells.size() > names.size()) {
    throw InputError(
        fmt::format("the row has {} cells where the header has {} columns", cells.size(), names.size()),
        separator == ',' ? "remove the extra cells; write numbers with a decimal point" : "remove the extra cells",
        {path, rows[row].line, ""});
  }
  cells.resize(names.size());
  return cells;
}

std::string TextTable::with_decimal_point(const std::string& number) const {
  return separator == ',' ? number : replaced(number, ",", ".");
}

TextTable read_text_table(const std::string& path, const TextTableRules& rules) {
  const std::string text = text_of(InputFile(path), rules);
  TextTable table;
  table.path = path;
  std::size_t number = 0;
  for (const std::string& line : split(text, '\n')) {
    ++number;
    if (line.find_first_not_of(",;\t \r\"") == std::string::npos || trimmed(line).front() == '#') continue;
    if (table.names.empty()) {
      table.separator = separator_of(line);
      table.names = split_cells(line, table.separator);
      table.header_line = number;
    } else {
      table.rows.push_back({number, split_cells(line, table.separator)});
    }
  }
  if (table.names.empty()) throw InputError("has no header", rules.header_advice, {path, 0, ""});
  return table;
}

}  // namespace tribofit
