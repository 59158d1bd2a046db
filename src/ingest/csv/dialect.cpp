#include "dialect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <map>

#include "encoding.hpp"
#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

std::vector<HeadLine> split_lines(std::string_view head, std::size_t most) {
  std::vector<HeadLine> lines;
  for (std::size_t at = 0; at < head.size() && lines.size() < most;) {
    const std::size_t end = std::min(head.find('\n', at), head.size());
    std::string_view text = head.substr(at, end - at);
    if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
    lines.push_back({text, at});
    at = end + 1;
  }
  return lines;
}

/// What a line holds under a separator and a decimal mark.
struct Census {
  std::size_t cells = 0;  // without empty ones at the end
  std::size_t filled = 0;
  std::size_t numbers = 0;
  bool starts = false;  // with a number
  bool mostly_numbers() const { return numbers > 0 && 2 * numbers >= filled; }
};

Census take_census(std::string_view line, char separator, char decimal) {
  Census census;
  const auto cells = split_cells(line, separator);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (cells[i].empty()) continue;
    census.cells = i + 1;
    const bool number = is_number(cells[i], decimal);
    if (census.filled++ == 0) census.starts = number;
    if (number) ++census.numbers;
  }
  return census;
}

struct Form {
  char separator, decimal;
};

/// The most frequent of some numbers, the largest of several; 0 where there are none.
std::size_t most_frequent(const std::vector<std::size_t>& numbers) {
  std::map<std::size_t, std::size_t> count;
  for (const std::size_t number : numbers) ++count[number];
  std::size_t frequent = 0, most = 0;
  for (const auto& [number, times] : count) {
    if (times >= most) frequent = number, most = times;
  }
  return frequent;
}

struct Layout {
  Form form{',', '.'};
  std::size_t columns = 0;
  std::vector<Census> lines;
  std::size_t numbers = 0;  // in most rows
  bool starts = false;      // most rows do, with a number

  /// "Interval,0.0005,Interval,0.0005" above four columns of numbers is not one of them, nor is "Samples,100,100".
  bool is_row(const Census& line) const {
    return line.cells == columns && line.mostly_numbers() && 2 * line.numbers > numbers && (line.starts || !starts);
  }

  /// Takes from the lines what a row is, and returns how well they fit.
  double settle() {
    std::vector<std::size_t> cells, of_rows;
    for (const Census& line : lines) {
      if (line.mostly_numbers()) cells.push_back(line.cells);
    }
    columns = most_frequent(cells);
    std::ptrdiff_t starting = 0;
    double score = 0;
    for (const Census& line : lines) {
      if (line.cells != columns || line.filled == 0) continue;
      score += static_cast<double>(line.numbers * line.numbers) / static_cast<double>(line.filled);
      if (!line.mostly_numbers()) continue;
      of_rows.push_back(line.numbers);
      starting += line.starts ? 1 : -1;
    }
    numbers = most_frequent(of_rows);
    starts = starting > 0;
    return score;
  }
};

Layout find_layout(const std::vector<HeadLine>& lines) {
  // Where two forms read equally many numbers the earlier one is meant.
  static constexpr std::array<Form, 7> forms = {
      {{'\t', '.'}, {';', '.'}, {',', '.'}, {'\t', ','}, {';', ','}, {blanks, '.'}, {blanks, ','}}};
  Layout best;
  double best_score = 0;
  for (const Form& form : forms) {
    Layout layout{form, 0, {}, 0, false};
    for (const HeadLine& line : lines) {
      layout.lines.push_back(is_comment(line.text) ? Census{} : take_census(line.text, form.separator, form.decimal));
    }
    const double score = layout.settle();
    if (score > best_score) {
      best_score = score;
      best = std::move(layout);
    }
  }
  return best;
}

/// The beginning of a file: kHeadLines lines, or up to the longest line and a byte.
std::string head_of(const InputFile& file) {
  std::string head;
  for (const std::size_t most : {kHeadBytes, kLongestLine + 1}) {
    head = file.read_text(0, most);
    const auto lines = static_cast<std::size_t>(std::count(head.begin(), head.end(), '\n'));
    if (lines > kHeadLines || head.size() < most) break;
  }
  return head;
}

[[noreturn]] void refuse_without_rows(const std::vector<HeadLine>& lines, Encoding encoding, const std::string& path) {
  std::size_t last = lines.size();
  while (last > 0 && trimmed(lines[last - 1].text).empty()) --last;
  if (last == 0) throw InputError("is empty", "export the trace again", {path, 0, ""});
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
  const std::uint64_t length = std::min<std::uint64_t>(size, kTailBytes);
  const std::string tail = file.read_text(size - length, length);
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
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  const bool is_text = !cells.front().empty() && letter(cells.front().front()) && !is_number(cells.front(), '.');
  if (is_text) return;  // a footer
  const bool whole =
      cells.size() > above.size() || (cells.size() == above.size() && cells.back().size() >= above.back().size());
  if (whole) return;
  dialect.data_end = begin;
  dialect.notes.push_back(fmt::format("the last line is cut off (no line end) and was dropped: \"{}\"",
                                      view.substr(end + 1).substr(0, 80)));
}

/// The cells of rows from the beginning, and of the last one.
std::vector<std::vector<std::string>> some_rows(const InputFile& file, const std::vector<HeadLine>& lines,
                                                std::size_t first, const Dialect& dialect) {
  std::vector<std::vector<std::string>> rows;
  const auto take = [&](std::string_view line) {
    if (!take_census(line, dialect.separator, dialect.decimal).mostly_numbers()) return false;
    rows.push_back(split_cells(line, dialect.separator));
    return true;
  };
  for (std::size_t i = first; i < lines.size() && rows.size() < kRowsForBlocks; ++i) take(lines[i].text);
  const std::string tail =
      file.read_text(dialect.data_end - std::min<std::uint64_t>(dialect.data_end, kLastRowBytes), kLastRowBytes);
  const auto last = split_lines(tail, tail.size());
  for (std::size_t i = last.size(); i-- > 1;) {
    if (take(last[i].text)) break;
  }
  return rows;
}

}  // namespace

RawDefect too_long_line() {
  return {1, "a line is longer than 1 MB", "a trace has one row of numbers per line; check that this is a CSV file",
          ""};
}

Dialect find_dialect(const InputFile& file) {
  if (file.size() == 0) throw InputError("is empty", "export the trace again", {file.path(), 0, ""});
  const std::string head = head_of(file);
  if (head.size() > kLongestLine && head.find('\n') == std::string::npos) {
    const RawDefect defect = too_long_line();
    throw InputError(defect.problem, defect.advice, {file.path(), defect.row, ""});
  }

  std::string_view text(head);
  const std::size_t mark = byte_order_mark(text);
  text.remove_prefix(mark);
  if (file.size() > head.size()) text = text.substr(0, text.rfind('\n') + 1);  // whole lines only
  const auto lines = split_lines(text, kHeadLines);
  const Encoding encoding = guess_encoding(text.substr(0, kHeadBytes));
  const Layout layout = find_layout(lines);

  Dialect dialect;
  dialect.separator = layout.form.separator;
  dialect.decimal = layout.form.decimal;
  dialect.columns = layout.columns;
  std::size_t first = 0;
  while (first < layout.lines.size() && !layout.is_row(layout.lines[first])) ++first;
  if (layout.columns == 0 || first == layout.lines.size()) refuse_without_rows(lines, encoding, file.path());

  dialect.data_line = first + 1;
  dialect.data_begin = mark + lines[first].begin;
  dialect.data_end = file.size();
  dialect.first_row = split_cells(lines[first].text, dialect.separator);
  dialect.row_bytes = static_cast<double>(text.size() - lines[first].begin) /
                      static_cast<double>(std::max<std::ptrdiff_t>(
                          1, std::count(text.begin() + std::ptrdiff_t(lines[first].begin), text.end(), '\n')));
  find_heading(lines, first, encoding, dialect);
  dialect.facts = find_facts(lines, encoding, dialect);
  for (std::size_t i = 0; i < first; ++i) {
    const std::string number = number_of_step(to_utf8(lines[i].text, encoding));
    if (!number.empty()) dialect.first_step = number;
  }
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
  find_blocks(some_rows(file, lines, first, dialect), dialect);
  return dialect;
}

}  // namespace tribofit
