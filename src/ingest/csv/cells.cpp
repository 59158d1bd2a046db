#include "dialect.hpp"

#include <fast_float/fast_float.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

/// Seconds of the days before a date, from 2020 on; nothing where there is no such day.
std::optional<double> seconds_of_date(int year, int month, int day) {
  const std::chrono::year_month_day date(std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day)));
  if (!date.ok()) return std::nullopt;
  using namespace std::chrono_literals;
  return std::chrono::duration<double>(std::chrono::sys_days(date) - std::chrono::sys_days(2020y / 1 / 1)).count();
}

}  // namespace

std::vector<std::string> split_cells(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  if (separator == blanks) line = trimmed(line);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        cells.back() += line[++i];
      else
        quoted = !quoted;
    } else if (separator == blanks && is_blank(line[i]) && !quoted) {
      if (!is_blank(line[i - 1])) cells.emplace_back();
    } else if (line[i] == separator && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  for (std::string& cell : cells) cell = std::string(trimmed(cell));
  return cells;
}

std::optional<double> number_in(std::string_view cell, char decimal) {
  if (cell.size() > 1 && cell.front() == '+' && cell[1] != '-') cell.remove_prefix(1);
  const char *begin = cell.data(), *end = begin + cell.size();
  for (const char mark : {decimal, '.'}) {
    double value = 0;
    const fast_float::parse_options form(fast_float::chars_format::general, mark);
    const auto [last, error] = fast_float::from_chars_advanced(begin, end, value, form);
    if (error != std::errc::invalid_argument && last == end) return value;
  }
  return std::nullopt;
}

bool is_number(std::string_view cell, char decimal) {
  cell = trimmed(cell);
  return (decimal == '.' || cell.find('.') == std::string_view::npos) && number_in(cell, decimal);
}

std::optional<double> clock_time(std::string_view cell) {
  if (cell.find(':') == std::string_view::npos) return std::nullopt;
  const std::string text(cell);
  char a[5] = "", b[3] = "", c[5] = "";
  int end = 0;
  double date = 0;
  const char* digits = text.c_str();
  const bool year_first = std::sscanf(digits, "%4[0-9]-%2[0-9]-%2[0-9]%*1[ T]%n", a, b, c, &end) == 3 && end > 0;
  const bool day_first =
      !year_first && std::sscanf(digits, "%2[0-9].%2[0-9].%4[0-9]%*1[ T]%n", a, b, c, &end) == 3 && end > 0;
  if (year_first || day_first) {
    const int first = std::atoi(a), last = std::atoi(c);
    const auto seconds = seconds_of_date(year_first ? first : last, std::atoi(b), year_first ? last : first);
    if (!seconds) return std::nullopt;
    date = *seconds;
    digits += end;
  }
  char hour[3] = "", minute[3] = "", second[3] = "", fraction[32] = "";
  end = 0;
  const int parts =
      std::sscanf(digits, "%2[0-9]:%2[0-9]:%2[0-9]%n%*1[.,]%30[0-9]%n", hour, minute, second, &end, fraction, &end);
  if (parts < 3 || digits[end] != '\0') return std::nullopt;
  const int hours = std::atoi(hour), minutes = std::atoi(minute), seconds = std::atoi(second);
  if (hours > 23 || minutes > 59 || seconds > 60) return std::nullopt;
  return date + 3600 * hours + 60 * minutes + seconds + *number_in("0." + std::string(fraction), '.');
}

}  // namespace tribofit
