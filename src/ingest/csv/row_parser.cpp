#include "row_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <utility>

#include "fccp.hpp"

#include "decimal.hpp"
#include "ingest/raw_table.hpp"

namespace tribofit {

RowParser::RowParser(const std::vector<WantedCell>& wanted, std::size_t cells, char separator, char decimal)
    : wanted_(wanted), cells_(cells), separator_(separator), decimal_(decimal) {
  std::size_t next = 0;
  for (const WantedCell& cell : wanted) {
    skips_.push_back(cell.index - next);
    next = cell.index + 1;
  }
}

RowParser::Outcome RowParser::parse(char* line, double* out) {
  switch (separator_) {
    case ';':
      return parse_plain<';'>(line, out) ? Outcome::numbers : parse_carefully<';'>(line, out);
    case '\t':
      return parse_plain<'\t'>(line, out) ? Outcome::numbers : parse_carefully<'\t'>(line, out);
    default:
      return parse_plain<','>(line, out) ? Outcome::numbers : parse_carefully<','>(line, out);
  }
}

/// The short way, in one pass: plain decimals without quotes or spaces, the right number of cells. False leaves the
/// line to the long way.
template <char separator>
bool RowParser::parse_plain(const char* line, double* out) const {
  const char* at = line;
  std::size_t cell = 0;
  for (const std::size_t skip : skips_) {
    for (std::size_t i = 0; i < skip; ++i, ++cell) {
      while (*at != separator && *at != '\0' && *at != '"') ++at;
      if (*at != separator) return false;
      ++at;
    }
    at = read_decimal(at, decimal_, *out++);
    if (at == nullptr) return false;
    ++cell;
    if (*at != separator) return *at == '\0' && cell == cells_ && cell == wanted_.back().index + 1;
    ++at;
  }
  for (; *at != '\0'; ++at) {
    if (*at == '"') return false;
    if (*at == separator) ++cell;
  }
  return cell + 1 == cells_ || (cell == cells_ && at[-1] == separator);
}

template <char separator>
RowParser::Outcome RowParser::parse_carefully(char* line, double* out) {
  using Quotes = io::double_quote_escape<separator, '"'>;
  const char* first = line;
  while (*first == ' ' || *first == '\t') ++first;
  if (*first == '\0' || *first == '\x1A') return Outcome::blank;
  if (*first == '#' || *first == '%' || (first[0] == '/' && first[1] == '/')) return Outcome::text;
  split_.clear();
  try {
    for (char* begin = line; begin != nullptr;) {
      char* end = begin + (Quotes::find_next_column_end(begin) - begin);
      char* next = *end == '\0' ? nullptr : end + 1;
      *end = '\0';
      char* cell = begin;
      io::trim_chars<' ', '\t'>::trim(cell, end);
      Quotes::unescape(cell, end);
      split_.push_back(cell);
      begin = next;
    }
  } catch (const io::error::escaped_string_not_closed&) {
    return refuse("a quote is opened and not closed", "close or remove it");
  }
  return judge(split_, out);
}

RowParser::Outcome RowParser::judge(const std::vector<char*>& cells, double* out) {
  std::size_t count = 0, filled = 0, numbers = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double value = 0;
    if (*cells[i] == '\0') continue;
    count = i + 1;
    ++filled;
    if (to_number(cells[i], value)) ++numbers;
  }
  if (filled == 0) return Outcome::blank;
  if (count == cells_ ? numbers == 0 : 2 * numbers < filled || numbers == 0) return Outcome::text;
  if (count > cells_) {
    return refuse(fmt::format("the row has {} cells where the file has {} columns", count, cells_),
                  decimal_ == '.' && count == 2 * cells_
                      ? "with a decimal comma, separate the columns by semicolons or tabs"
                      : "remove the extra cells or export the trace again");
  }
  if (cells.size() < cells_) {
    return refuse(fmt::format("the row has {} cell{} where the file has {} columns", cells.size(),
                              cells.size() == 1 ? "" : "s", cells_),
                  "complete or remove the row");
  }
  for (const auto& [index, column] : wanted_) {
    const std::string cell(cells[index]);
    const std::string shown = fmt::format("'{}'", cell.substr(0, 40));
    if (cell.empty()) return refuse("the cell is empty", "fill it in or remove the row", column);
    if (!to_number(cells[index], *out)) {
      return refuse(shown + " is not a number", "correct it, remove the row, or name another column with --columns",
                    column);
    }
    if (!(std::abs(*out) < largest_value)) {
      return refuse(shown + " is not a finite number of a usable size", "fill it in or remove the row", column);
    }
    ++out;
  }
  return Outcome::numbers;
}

RowParser::Outcome RowParser::refuse(std::string problem, std::string advice, std::string column) {
  defect_ = {std::move(problem), std::move(advice), std::move(column)};
  return Outcome::wrong;
}

/// Whether the whole cell is a number; one beyond the range of doubles counts as infinite.
bool RowParser::to_number(char* cell, double& value) const {
  if (decimal_ != '.') {
    char* comma = std::strchr(cell, decimal_);
    if (comma != nullptr && std::strchr(cell, '.') == nullptr) *comma = '.';
  }
  const char* begin = *cell == '+' && cell[1] != '-' ? cell + 1 : cell;
  const char* end = begin + std::strlen(begin);
  const auto [last, error] = std::from_chars(begin, end, value);
  if (last != end || begin == end) return false;
  if (error == std::errc::result_out_of_range) value = HUGE_VAL;
  return error != std::errc::invalid_argument;
}

}  // namespace tribofit
