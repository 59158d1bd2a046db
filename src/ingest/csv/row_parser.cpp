#include "row_parser.hpp"

#include <fast_float/fast_float.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "clock_time.hpp"
#include "dialect.hpp"
#include "heading.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

namespace {

/// What most numbers of a trace are: digits and perhaps a mark, fifteen digits at most. Integer and power of ten are
/// then exact, and so their quotient is rightly rounded (Clinger 1990). Null leaves the number to fast_float, which
/// takes a third longer (7.2 million numbers: 46 ms for 62).
const char* read_short(const char* at, char decimal, double& value) {
  static constexpr double kPowers[] = {1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                       1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool negative = *at == '-';
  std::uint64_t digits = 0;
  const auto read_digits = [&] {
    const char* begin = at;
    for (; *at >= '0' && *at <= '9'; ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
    return static_cast<std::size_t>(at - begin);
  };
  at += negative ? 1 : 0;
  const std::size_t whole = read_digits();
  std::size_t fraction = 0;
  if (*at == decimal) ++at, fraction = read_digits();
  if (whole == 0 || whole + fraction >= std::size(kPowers) || *at == 'e' || *at == 'E') return nullptr;
  const double size = static_cast<double>(digits) / kPowers[fraction];
  value = negative ? -size : size;
  return at;
}

}  // namespace

RowParser::RowParser(const std::vector<WantedCell>& wanted, std::size_t cells, char separator, char decimal,
                     bool may_be_short)
    : wanted_(wanted), cells_(cells), separator_(separator), decimal_(decimal), may_be_short_(may_be_short) {}

const char* RowParser::parse_plain(const char* at, const char* end, const std::vector<double*>& column,
                                   std::size_t row) const {
  const fast_float::parse_options form(fast_float::chars_format::general, decimal_);
  const bool by_blanks = separator_ == blanks;
  const auto is_blank = [&](char c) { return c == ' ' || (by_blanks && c == '\t'); };
  const auto ends_cell = [&](char c) { return by_blanks ? is_blank(c) : c == separator_; };
  const auto ends_line = [](char c) { return c == '\n' || c == '\r'; };
  const char* begin = at;
  std::size_t cell = 0, next = 0;
  for (;; ++cell) {
    while (is_blank(*at)) ++at;
    if (by_blanks && ends_line(*at)) break;
    begin = at;
    if (next < wanted_.size() && cell == wanted_[next].index) {
      double& value = column[next++][row];
      const char* after = read_short(at, decimal_, value);
      if (after == nullptr) {
        const auto [last, error] = fast_float::from_chars_advanced(at, end, value, form);
        if (error != std::errc{} || !(std::abs(value) < kLargestValue)) return nullptr;
        after = last;
      }
      at = after;
    } else {
      while (!ends_cell(*at) && !ends_line(*at) && *at != '"' && *at != '\0') ++at;
    }
    while (!by_blanks && *at == ' ') ++at;
    if (!ends_cell(*at)) {
      ++cell;
      break;
    }
    ++at;
  }
  const bool is_whole = cell == cells_ || (!by_blanks && cell == cells_ + 1 && at == begin);
  if (*at == '\r') ++at;
  return is_whole && next == wanted_.size() && *at == '\n' ? at + 1 : nullptr;
}

RowParser::Outcome RowParser::parse(std::string_view line, std::vector<double>& out) {
  gappy_ = false;
  const std::string_view text = trimmed(line);
  if (text.empty() || text.front() == '\x1A') return Outcome::blank;
  if (is_comment(text)) return Outcome::text;
  if (line.find('\0') != std::string_view::npos)
    return refuse("the line holds a NUL byte", "the file is damaged here or binary; export it again");
  if (std::count(line.begin(), line.end(), '"') % 2 != 0)
    return refuse("a quote is opened and not closed", "close or remove it");
  return judge(split_cells(line, separator_), out);
}

RowParser::Outcome RowParser::judge(const std::vector<std::string>& cells, std::vector<double>& out) {
  std::size_t count = 0, filled = 0, numbers = 0;  // cells without empty ones at the end
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    count = i + 1;
    ++filled;
    if (number_in(cells[i], decimal_)) ++numbers;
  }
  if (count == 0) return Outcome::blank;
  const bool whole = count == cells_ && separator_ != blanks;  // words of a sentence are many cells
  if (numbers == 0 || !(whole || 2 * numbers >= filled)) return Outcome::text;
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
  for (std::size_t k = 0; k < wanted_.size(); ++k) {
    const auto& [index, column] = wanted_[k];
    out[k] = number_of(index < cells.size() ? cells[index] : std::string(), column);
  }
  return Outcome::numbers;
}

double RowParser::number_of(const std::string& cell, const std::string& column) {
  const std::optional<double> clock = clock_time(cell), number = clock ? clock : number_in(cell, decimal_);
  if (number && std::abs(*number) < kLargestValue) return *number;
  const std::string shown = fmt::format("'{}'", std::string_view(cell).substr(0, 40));
  if (gappy_) {  // the first one is said
  } else if (cell.empty()) {
    refuse("the cell is empty", "fill it in or remove the row", column);
  } else if (!number) {
    refuse(shown + " is not a number", "correct it, remove the row, or name another column with --columns", column);
  } else {
    refuse(shown + " is not a finite number of a usable size", "fill it in or remove the row", column);
  }
  gappy_ = true;
  return std::numeric_limits<double>::quiet_NaN();
}

RowParser::Outcome RowParser::refuse(std::string problem, std::string advice, std::string column) {
  defect_ = {0, std::move(problem), std::move(advice), std::move(column)};
  return Outcome::wrong;
}

}  // namespace tribofit
