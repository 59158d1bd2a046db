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
  std::string bytes(static_cast<std::size_t>(file.size()), '\0');
  bytes.resize(file.read(0, bytes));
  if (bytes.empty()) throw InputError("is empty", rules.header_advice, {file.path(), 0, ""});
  refuse_unless_text(bytes, file.path());
  return to_utf8(std::string_view(bytes).substr(byte_order_mark(bytes)), guess_encoding(bytes));
}

char separator_of(std::string_view header) {
  char separator = ',';
  for (const char candidate : {',', ';', '\t'}) {
    if (std::count(header.begin(), header.end(), candidate) > std::count(header.begin(), header.end(), separator)) {
      separator = candidate;
    }
  }
  return separator;
}

RawColumn text_column(std::string name, bool named, std::size_t line) {
  RawColumn column;
  column.name = std::move(name);
  column.named = named;
  column.line = line;
  column.is_text = true;
  return column;
}

void add_row(std::vector<std::string> cells, std::size_t line, RawTable& table) {
  auto& columns = table.columns;
  const std::size_t row = columns.front().texts.size();
  for (std::size_t k = columns.size(); k < cells.size(); ++k) {
    if (cells[k].empty()) continue;
    for (std::size_t i = columns.size(); i <= k; ++i) {
      columns.push_back(text_column(fmt::format("#{}", i + 1), false, columns.front().line));
      columns.back().texts.resize(row);
    }
  }
  cells.resize(columns.size());
  for (std::size_t k = 0; k < cells.size(); ++k) columns[k].texts.push_back(std::move(cells[k]));
  table.rows.front().lines.set(row, line);
}

}  // namespace

std::vector<std::string> TextTable::cells_of(std::size_t row) const {
  std::vector<std::string> cells;
  std::size_t header = 0, filled = 0;
  for (const RawColumn& column : table.columns) {
    cells.push_back(column.texts[row]);
    if (column.named) header = cells.size();
    if (!cells.back().empty()) filled = cells.size();
  }
  if (filled > header) {
    throw InputError(
        fmt::format("the row has {} cells where the header has {} columns", filled, header),
        separator == ',' ? "remove the extra cells; write numbers with a decimal point" : "remove the extra cells",
        {table.path, line_of(row), ""});
  }
  cells.resize(header);
  return cells;
}

std::string TextTable::with_decimal_point(const std::string& number) const {
  return separator == ',' ? number : replaced(number, ",", ".");
}

TextTable read_text_table(const std::string& path, const TextTableRules& rules) {
  const std::string text = text_of(InputFile(path), rules);
  TextTable result;
  RawTable& table = result.table;
  table.path = path;
  std::size_t number = 0;
  for (const std::string& line : split(text, '\n')) {
    ++number;
    if (line.find_first_not_of(",;\t \r\"") == std::string::npos || trimmed(line).front() == '#') continue;
    if (!table.columns.empty()) {
      add_row(split_cells(line, result.separator), number, table);
      continue;
    }
    result.separator = separator_of(line);
    for (std::string& name : split_cells(line, result.separator)) {
      table.columns.push_back(text_column(std::move(name), true, number));
    }
  }
  if (table.columns.empty()) throw InputError("has no header", rules.header_advice, {path, 0, ""});
  return result;
}

}  // namespace tribofit
