#include "dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <map>
#include <optional>

#include "encoding.hpp"
#include "ingest/column_names.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

struct Line {
  std::string_view text;  // without the line end
  std::uint64_t begin = 0;
};

std::vector<Line> split_lines(std::string_view head, std::size_t most) {
  std::vector<Line> lines;
  for (std::size_t at = 0; at < head.size() && lines.size() < most;) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    std::string_view text = head.substr(at, end - at);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    lines.push_back({text, at});
    at = end + 1;
  }
  return lines;
}

bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return !text.empty() && (text.front() == '#' || text.front() == '%' || text.substr(0, 2) == "//");
}

/// What a line holds under a separator and a decimal mark.
struct Census {
  std::size_t cells = 0;  // without empty ones at the end
  std::size_t filled = 0;
  std::size_t numbers = 0;
  bool mostly_numbers() const { return numbers > 0 && 2 * numbers >= filled; }
};

Census take_census(std::string_view line, char separator, char decimal) {
  Census census;
  const auto cells = split_cells(line, separator);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    census.cells = i + 1;
    ++census.filled;
    if (is_number(cells[i], decimal)) ++census.numbers;
  }
  return census;
}

struct Form {
  char separator, decimal;
};

/// The most frequent number of cells among the lines that are mostly numbers, 0 when there are none.
std::size_t usual_cells(const std::vector<Census>& lines) {
  std::map<std::size_t, std::size_t> count;
  for (const Census& line : lines) {
    if (line.mostly_numbers()) ++count[line.cells];
  }
  std::size_t cells = 0, most = 0;
  for (const auto& [n, times] : count) {
    if (times >= most) {
      cells = n;
      most = times;
    }
  }
  return cells;
}

struct Layout {
  Form form{',', '.'};
  std::size_t columns = 0;
  std::vector<Census> lines;
};

Layout find_layout(const std::vector<Line>& lines) {
  // Where two forms read equally many numbers the earlier one is meant.
  static constexpr std::array<Form, 5> forms = {{{'\t', '.'}, {';', '.'}, {',', '.'}, {'\t', ','}, {';', ','}}};
  Layout best;
  double best_score = 0;
  for (const Form& form : forms) {
    Layout layout{form, 0, {}};
    for (const Line& line : lines) {
      layout.lines.push_back(is_comment(line.text) ? Census{} : take_census(line.text, form.separator, form.decimal));
    }
    layout.columns = usual_cells(layout.lines);
    double score = 0;
    for (const Census& line : layout.lines) {
      if (line.cells != layout.columns || line.filled == 0) continue;
      const double numbers = static_cast<double>(line.numbers);
      score += numbers * numbers / static_cast<double>(line.filled);
    }
    if (score > best_score) {
      best_score = score;
      best = std::move(layout);
    }
  }
  return best;
}

bool is_unit_cell(std::string_view cell) {
  std::string_view text = trimmed(cell);
  if (text.size() >= 2 &&
      ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'))) {
    return true;
  }
  return find_unit(text).has_value();
}

/// Whether the cells are units: all of them, or at least half where none is the name of a channel (so that a unit
/// that is not known is named as such and does not make the row a header).
bool is_units_row(const std::vector<std::string>& cells) {
  std::size_t filled = 0, units = 0;
  bool names = false;
  for (const std::string& cell : cells) {
    if (cell.empty() || cell == "-" || cell == "1") continue;
    ++filled;
    if (is_unit_cell(cell))
      ++units;
    else
      names = names || is_field_name(parse_column_name(cell).base);
  }
  return filled > 0 && (units == filled || (!names && 2 * units >= filled));
}

void trim_empty_end(std::vector<std::string>& cells) {
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
}

/// Cells of a line of text above the rows; a comment sign at its start is taken off.
std::vector<std::string> heading_cells(std::string_view line, char separator, Encoding encoding) {
  std::string text = to_utf8(line, encoding);
  if (is_comment(text)) text = text.substr(std::min(text.find_first_not_of("#%/! \t"), text.size()));
  auto cells = split_cells(text, separator);
  trim_empty_end(cells);
  return cells;
}

/// Finds the header (and the row of units) above line `first`.
void find_heading(const std::vector<Line>& lines, std::size_t first, Encoding encoding, Dialect& dialect) {
  std::vector<std::string> units;
  std::size_t units_line = 0;
  std::optional<std::pair<std::size_t, std::vector<std::string>>> comment_heading;
  for (std::size_t i = first; i-- > 0 && first - i <= 8;) {
    if (trimmed(lines[i].text).empty()) continue;
    auto cells = heading_cells(lines[i].text, dialect.separator, encoding);
    if (cells.empty() || cells.size() > dialect.columns + 1) continue;
    if (is_comment(lines[i].text)) {
      // "# time, mu, v_b": a header only where no plain one stands between it and the rows
      if (!comment_heading && cells.size() == dialect.columns) comment_heading = {i, cells};
      continue;
    }
    if (units_line == 0 && is_units_row(cells)) {
      units = cells;
      units_line = i + 1;
      continue;
    }
    if (cells.size() < dialect.columns && dialect.columns > 1 && cells.size() == 1) continue;  // a title
    dialect.names = cells;
    dialect.header_line = i + 1;
    break;
  }
  if (dialect.names.empty() && comment_heading) {
    dialect.header_line = comment_heading->first + 1;
    dialect.names = comment_heading->second;
  }
  if (dialect.names.empty() && units_line > 0) {  // "t, v": names that could be units
    dialect.names = units;
    dialect.header_line = units_line;
    units_line = 0;
  }
  if (units_line > 0) {
    dialect.units = units;
    dialect.units_line = units_line;
  }
}

/// "# Radius [mm]: 15", "Speed = 4 rpm", "\"Normal load [N]\";50", "Interval,0.0005,..." as a name and its value.
std::optional<RawFact> find_fact(std::string_view line, std::size_t number) {
  std::string text = replaced(std::string(line), "\"", "");
  text.erase(0, text.find_first_not_of("#%/!' \t"));
  const std::size_t mark = text.find_first_of(":=;,\t");
  if (mark == std::string::npos || mark == 0) return std::nullopt;
  const std::string separators = text[mark] == ',' ? ",;\t" : ";\t";
  const std::size_t begin = text.find_first_not_of(separators + " ", mark + 1);
  if (begin == std::string::npos) return std::nullopt;
  const std::size_t end = std::min(text.find_first_of(separators, begin), text.size());
  RawFact fact{std::string(trimmed(std::string_view(text).substr(0, mark))),
               std::string(trimmed(std::string_view(text).substr(begin, end - begin))), number};
  const std::string next = end < text.size() ? split(std::string_view(text).substr(end + 1), text[end]).front() : "";
  if (!trimmed(next).empty() && find_unit(next)) fact.value += " " + std::string(trimmed(next));
  return fact;
}

std::vector<RawFact> find_facts(const std::vector<Line>& lines, Encoding encoding, const Dialect& dialect) {
  std::vector<RawFact> facts;
  for (std::size_t number = 1; number < dialect.data_line; ++number) {
    if (number == dialect.header_line || number == dialect.units_line) continue;
    if (auto fact = find_fact(to_utf8(lines[number - 1].text, encoding), number)) facts.push_back(std::move(*fact));
  }
  return facts;
}

[[noreturn]] void refuse_without_rows(const std::vector<Line>& lines, std::string_view head, Encoding encoding,
                                      const std::string& path) {
  std::size_t last = lines.size();
  while (last > 0 && trimmed(lines[last - 1].text).empty()) --last;
  if (last == 0) throw InputError("is empty", "export the trace again", {path, 0, ""});
  std::size_t numbers = 0;
  for (const Line& line : lines) {
    const std::string_view text = trimmed(line.text);
    if (text.find(' ') != std::string_view::npos && take_census(text, ' ', '.').mostly_numbers()) ++numbers;
  }
  if (numbers > lines.size() / 2) {
    throw InputError("the columns are separated by spaces", "separate them by commas, semicolons or tabs",
                     {path, last, ""});
  }
  if (head.find('\n') == std::string_view::npos && head.find('\r') != std::string_view::npos) {
    throw InputError("lines end in CR alone", "convert them with: tr '\\r' '\\n'", {path, 1, ""});
  }
  const std::string shown = to_utf8(lines[last - 1].text.substr(0, 120), encoding);
  throw InputError(fmt::format("has a header but no rows of numbers (last line: \"{}\")", shown),
                   "check that the export was complete", {path, last, ""});
}

/// Sets data_end before a last line that lacks its line end and is cut off.
///
/// Only its number of cells and the length of its last cell show that: a cell with fewer characters than the one above
/// may be a number cut in two, and one sample is a small price for not reading 0.4 where 0.4123 was meant.
void drop_cut_off_line(const InputFile& file, std::size_t columns, Dialect& dialect) {
  const std::uint64_t size = file.size();
  const std::size_t length = static_cast<std::size_t>(std::min<std::uint64_t>(size, 1 << 16));
  std::string tail(length, '\0');
  tail.resize(file.read(size - length, tail));
  if (tail.empty() || tail.back() == '\n' || tail.back() == '\r') return;
  const std::size_t end = tail.rfind('\n');
  if (end == std::string::npos || end == 0) return;
  const std::uint64_t begin = size - length + end + 1;
  if (begin <= dialect.data_begin) return;
  const std::size_t before = tail.rfind('\n', end - 1);
  const std::string_view view(tail);
  const std::size_t from = before == std::string::npos ? 0 : before + 1;
  const auto cells = split_cells(view.substr(end + 1), dialect.separator);
  const auto above = split_cells(view.substr(from, end - from), dialect.separator);
  const bool numbers = take_census(view.substr(from, end - from), dialect.separator, dialect.decimal).mostly_numbers();
  if (!numbers || above.size() < columns) return;
  const bool whole =
      cells.size() > above.size() || (cells.size() == above.size() && cells.back().size() >= above.back().size());
  if (whole) return;
  dialect.data_end = begin;
  dialect.notes.push_back(fmt::format("the last line is cut off (no line end) and was dropped: \"{}\"",
                                      view.substr(end + 1).substr(0, 80)));
}

}  // namespace

std::vector<std::string> split_cells(std::string_view line, char separator) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (quoted && i + 1 < line.size() && line[i + 1] == '"')
        cells.back() += line[++i];
      else
        quoted = !quoted;
    } else if (line[i] == separator && !quoted) {
      cells.emplace_back();
    } else {
      cells.back() += line[i];
    }
  }
  for (std::string& cell : cells) cell = std::string(trimmed(cell));
  return cells;
}

bool is_number(std::string_view cell, char decimal) {
  std::string text(trimmed(cell));
  if (decimal != '.') {
    if (text.find('.') != std::string::npos) return false;
    std::replace(text.begin(), text.end(), decimal, '.');
  }
  const char* begin = text.data();
  if (!text.empty() && *begin == '+') ++begin;
  double value = 0;
  const auto [end, error] = std::from_chars(begin, text.data() + text.size(), value);
  return error != std::errc::invalid_argument && end == text.data() + text.size() && !text.empty();
}

Dialect find_dialect(const InputFile& file) {
  if (file.size() == 0) throw InputError("is empty", "export the trace again", {file.path(), 0, ""});
  std::string head(static_cast<std::size_t>(std::min<std::uint64_t>(file.size(), InputFile::longest_line + 1)), '\0');
  head.resize(file.read(0, head));
  if (head.size() > InputFile::longest_line && head.find('\n') == std::string::npos) file.refuse_long_line(1);

  std::string_view text(head);
  const std::size_t mark = byte_order_mark(text);
  text.remove_prefix(mark);
  if (file.size() > head.size()) text = text.substr(0, text.rfind('\n') + 1);  // whole lines only
  const auto lines = split_lines(text, 500);
  const Encoding encoding = guess_encoding(text.substr(0, 1 << 16));
  const Layout layout = find_layout(lines);

  Dialect dialect;
  dialect.separator = layout.form.separator;
  dialect.decimal = layout.form.decimal;
  dialect.columns = layout.columns;
  std::size_t first = 0;
  while (first < layout.lines.size() &&
         !(layout.lines[first].cells == layout.columns && layout.lines[first].mostly_numbers())) {
    ++first;
  }
  if (layout.columns == 0 || first == layout.lines.size()) refuse_without_rows(lines, text, encoding, file.path());

  dialect.data_line = first + 1;
  dialect.data_begin = mark + lines[first].begin;
  dialect.data_end = file.size();
  dialect.first_row = split_cells(lines[first].text, dialect.separator);
  dialect.row_bytes = static_cast<double>(text.size() - lines[first].begin) /
                      static_cast<double>(std::max<std::ptrdiff_t>(
                          1, std::count(text.begin() + std::ptrdiff_t(lines[first].begin), text.end(), '\n')));
  find_heading(lines, first, encoding, dialect);
  dialect.facts = find_facts(lines, encoding, dialect);
  dialect.columns = std::max(dialect.columns, dialect.names.size());
  if (dialect.header_line > 1 || (dialect.header_line == 0 && first > 0)) {
    const std::size_t above = dialect.header_line > 0 ? dialect.header_line - 1 : first;
    dialect.notes.push_back(fmt::format("{} line{} of preamble skipped", above, above == 1 ? "" : "s"));
  }
  if (encoding != Encoding::utf8) {
    dialect.notes.push_back(encoding == Encoding::gbk ? "header read as GBK" : "header read as Latin-1");
  }
  if (dialect.decimal == ',') dialect.notes.push_back("numbers have a decimal comma");
  drop_cut_off_line(file, layout.columns, dialect);
  return dialect;
}

}  // namespace tribofit
