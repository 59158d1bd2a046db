#include "row_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "fccp.hpp"

#include "clock_time.hpp"
#include "decimal.hpp"
#include "dialect.hpp"
#include "ingest/limits.hpp"
#include "ingest/raw_table.hpp"

namespace tribofit {

RowParser::RowParser(const std::vector<WantedCell>& wanted, std::size_t cells, char separator, char decimal,
                     bool may_be_short)
    : wanted_(wanted), cells_(cells), separator_(separator), decimal_(decimal), may_be_short_(may_be_short) {
  forms_.resize(wanted.size());
  std::size_t next = 0;
  for (const WantedCell& cell : wanted) {
    skips_.push_back(cell.index - next);
    next = cell.index + 1;
  }
}

RowParser::Outcome RowParser::parse(char* line, double* out) {
  gappy_ = false;
  switch (separator_) {
    case blanks:
      return parse_blanks(line, out) ? Outcome::numbers : parse_carefully<blanks>(line, out);
    case ';':
      return parse_carefully<';'>(line, out);
    case '\t':
      return parse_carefully<'\t'>(line, out);
    default:
      return parse_carefully<','>(line, out);
  }
}

char* RowParser::parse_plain_rows(char* at, const char* end, const std::vector<double*>& column, std::size_t& row) {
  const auto read = [&](const auto& parse_row) {
    while (at < end) {
      char* next = parse_row();
      if (next == nullptr) break;
      at = next;
      ++row;
    }
    return at;
  };
  switch (separator_) {
    case blanks:
      return at;
    case ';':
      return read([&] { return parse_plain_row<';'>(at, end, column, row); });
    case '\t':
      return read([&] { return parse_plain_row<'\t'>(at, end, column, row); });
    default:
      return read([&] { return parse_plain_row<','>(at, end, column, row); });
  }
}

/// The line after the one at `at`; null leaves that to the long way.
template <char separator>
char* RowParser::parse_plain_row(char* at, const char* end, const std::vector<double*>& column, std::size_t row) {
  std::size_t cell = 0, k = 0;
  for (const std::size_t skip : skips_) {
    for (std::size_t i = 0; i < skip; ++i, ++cell) {
      while (*at != separator && *at != '\n' && *at != '"' && *at != '\0') ++at;
      if (*at != separator) return nullptr;
      ++at;
    }
    while (*at == ' ') ++at;
    const char* after = read_decimal(at, decimal_, column[k][row], forms_[k]);
    ++k;
    if (after == nullptr) return nullptr;
    at += after - at;
    while (*at == ' ') ++at;
    ++cell;
    if (*at != separator) {
      if (*at == '\r') ++at;
      return *at == '\n' && cell == cells_ && k == skips_.size() ? at + 1 : nullptr;
    }
    ++at;
  }
  char before = separator;  // of the character before the end of the line
  for (; *at != '\n'; ++at) {
    if (*at == '"' || at >= end) return nullptr;
    if (*at == separator) ++cell;
    if (*at != '\r' || at[1] != '\n') before = *at;
  }
  return cell + 1 == cells_ || (cell == cells_ && before == separator) ? at + 1 : nullptr;
}

/// The short way for columns that blanks and tabs divide. False leaves the line to the long way.
bool RowParser::parse_blanks(const char* line, double* out) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  const char* at = line;
  std::size_t cell = 0, next = 0;
  for (;; ++cell) {
    while (is_blank(*at)) ++at;
    if (*at == '\0') break;
    if (next < wanted_.size() && wanted_[next].index == cell) {
      at = read_decimal(at, decimal_, out[next], forms_[next]);
      ++next;
      if (at == nullptr || (*at != '\0' && !is_blank(*at))) return false;
    } else {
      for (; *at != '\0' && !is_blank(*at); ++at) {
        if (*at == '"') return false;
      }
    }
  }
  return cell == cells_;
}

template <char separator>
RowParser::Outcome RowParser::parse_carefully(char* line, double* out) {
  const char* first = line;
  while (*first == ' ' || *first == '\t') ++first;
  if (*first == '\0' || *first == '\x1A') return Outcome::blank;
  text_.assign(first, std::min<std::size_t>(std::strlen(first), kLongestText));
  if (*first == '#' || *first == '%' || (first[0] == '/' && first[1] == '/')) return Outcome::text;
  split_.clear();
  try {
    separator == blanks ? split_at_blanks(line) : split<separator>(line);
  } catch (const io::error::escaped_string_not_closed&) {
    return refuse("a quote is opened and not closed", "close or remove it");
  }
  return judge(split_, out);
}

template <char separator>
void RowParser::split(char* line) {
  using Quotes = io::double_quote_escape<separator, '"'>;
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
}

void RowParser::split_at_blanks(char* line) {
  for (char* at = line; *at != '\0';) {
    while (*at == ' ' || *at == '\t') *at++ = '\0';
    if (*at == '\0') return;
    const bool quoted = *at == '"';
    if (quoted) ++at;
    split_.push_back(at);
    while (*at != '\0' && (quoted ? *at != '"' : *at != ' ' && *at != '\t')) ++at;
    if (!quoted) continue;
    if (*at == '\0') throw io::error::escaped_string_not_closed();
    *at++ = '\0';
  }
}

/// Whether the line is a row, not text; counts the cells without empty ones at the end.
bool RowParser::is_data(const std::vector<char*>& cells, std::size_t& count) const {
  std::size_t filled = 0, numbers = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    double value = 0;
    if (*cells[i] == '\0') continue;
    count = i + 1;
    ++filled;
    if (to_number(cells[i], value)) ++numbers;
  }
  const bool whole = count == cells_ && separator_ != blanks;  // words of a sentence are many cells
  return numbers > 0 && (whole || 2 * numbers >= filled);
}

RowParser::Outcome RowParser::judge(const std::vector<char*>& cells, double* out) {
  std::size_t count = 0;
  const bool is_row = is_data(cells, count);
  if (count == 0) return Outcome::blank;
  if (!is_row) return Outcome::text;
  if (count > cells_) {
    return refuse(fmt::format("the row has {} cells where the file has {} columns", count, cells_),
                  decimal_ == '.' && count == 2 * cells_
                      ? "with a decimal comma, separate the columns by semicolons or tabs"
                      : "remove the extra cells or export the trace again");
  }
  if (cells.size() < cells_ && !may_be_short_) {
    return refuse(fmt::format("the row has {} cell{} where the file has {} columns", cells.size(),
                              cells.size() == 1 ? "" : "s", cells_),
                  "complete or remove the row");
  }
  char none = '\0';
  for (const auto& [index, column] : wanted_) take(index < cells.size() ? cells[index] : &none, column, *out++);
  return Outcome::numbers;
}

void RowParser::take(char* cell, const std::string& column, double& out) {
  if (const std::optional<double> clock = clock_time(cell)) {
    out = *clock;
    return;
  }
  const bool is_number = *cell != '\0' && to_number(cell, out);
  if (is_number && std::abs(out) < kLargestValue) return;
  const std::string shown = fmt::format("'{}'", std::string_view(cell).substr(0, 40));
  out = std::numeric_limits<double>::quiet_NaN();
  if (gappy_) return;
  gappy_ = true;
  if (*cell == '\0') {
    refuse("the cell is empty", "fill it in or remove the row", column);
  } else if (!is_number) {
    refuse(shown + " is not a number", "correct it, remove the row, or name another column with --columns", column);
  } else {
    refuse(shown + " is not a finite number of a usable size", "fill it in or remove the row", column);
  }
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
