#include "dialect.hpp"

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "ingest/raw_table.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {
namespace {

bool is_unit_cell(std::string_view cell) {
  return strip_brackets(cell) != trimmed(cell) || find_unit(cell);
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

/// The text with every blank and tab that stands in brackets, and the blank before a bracket, as '_': one word.
std::string bracketed_as_words(std::string_view text) {
  std::string words;
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool opens = i + 1 < text.size() && (text[i + 1] == '(' || text[i + 1] == '[');
    if (c == '(' || c == '[') ++depth;
    if (c == ')' || c == ']') depth = std::max(0, depth - 1);
    const bool joined = c == ' ' && (depth > 0 || (opens && i > 0 && text[i - 1] != ' '));
    words += joined ? '_' : c;
  }
  return words;
}

/// The text with runs of two or more blanks as tabs.
std::string wide_blanks_as_tabs(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text.substr(i, 2) != "  ") {
      result += text[i];
      continue;
    }
    while (i + 1 < text.size() && text[i + 1] == ' ') ++i;
    result += '\t';
  }
  return result;
}

/// Cells of a heading above columns that blanks divide: names may hold single blanks themselves, so that the division
/// is taken that gives as many as there are columns.
std::vector<std::string> words_of_heading(std::string_view text, std::size_t columns) {
  const std::string wide = wide_blanks_as_tabs(trimmed(text)), bracketed = bracketed_as_words(trimmed(text));
  for (const auto& [line, separator] : {std::pair{std::string_view(wide), '\t'},
                                        {trimmed(text), ','},
                                        {trimmed(text), ';'},
                                        {std::string_view(bracketed), blanks}}) {
    auto cells = split_cells(line, separator);
    trim_empty_end(cells);
    if (cells.size() == columns) return cells;
  }
  return split_cells(text, blanks);
}

/// Cells of a line of text above the rows; a comment sign at its start is taken off.
std::vector<std::string> heading_cells(std::string_view line, const Dialect& dialect, Encoding encoding) {
  std::string text = to_utf8(line, encoding);
  if (is_comment(text)) text = text.substr(std::min(text.find_first_not_of("#%/! \t"), text.size()));
  if (dialect.separator == blanks) return words_of_heading(text, dialect.columns);
  auto cells = split_cells(text, dialect.separator);
  trim_empty_end(cells);
  if (dialect.separator == '\t' && cells.size() == 1 && dialect.columns > 1) {  // blanks above columns of tabs
    auto words = words_of_heading(text, dialect.columns);
    const auto named = [](const std::string& word) { return is_field_name(parse_column_name(word).base); };
    if (words.size() == dialect.columns && std::any_of(words.begin(), words.end(), named)) return words;
  }
  return cells;
}

/// "Time,Analog 1" above "ms,Motor speed": where a unit stands in the place of a name, the name is in the line above.
void take_names_above(const std::vector<HeadLine>& lines, Encoding encoding, Dialect& dialect) {
  if (dialect.header_line < 2 || dialect.units_line > 0) return;
  const auto above = heading_cells(lines[dialect.header_line - 2].text, dialect, encoding);
  if (above.size() != dialect.names.size()) return;
  for (std::size_t k = 0; k < above.size(); ++k) {
    if (!is_field_name(parse_column_name(above[k]).base)) continue;
    if (is_field_name(parse_column_name(dialect.names[k]).base) || !find_unit(dialect.names[k])) continue;
    dialect.units.resize(dialect.names.size());
    dialect.units[k] = std::exchange(dialect.names[k], above[k]);
    dialect.units_line = dialect.header_line;
  }
}

/// LabVIEW's measurement files: "Y_Unit_Label" is followed by the units of the columns after the first, which is X.
void take_labels_of_units(const std::vector<HeadLine>& lines, std::size_t first, Encoding encoding, Dialect& dialect) {
  for (std::size_t i = 0; i < first && dialect.units_line == 0; ++i) {
    auto cells = heading_cells(lines[i].text, dialect, encoding);
    if (cells.size() < 2 || lower_case(cells.front()) != "y_unit_label") continue;
    cells.front() = "s";
    dialect.units = std::move(cells);
    dialect.units_line = i + 1;
  }
}

void name_times_of_channels(Dialect& dialect) {
  for (std::size_t k = 0; k + 1 < dialect.names.size(); ++k) {
    if (lower_case(dialect.names[k]) != "channel name") continue;
    dialect.names[k] = "Time";
    if (k < dialect.units.size() && lower_case(dialect.units[k]) == "unit") dialect.units[k] = "s";
  }
}

}  // namespace

bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return !text.empty() && (text.front() == '#' || text.front() == '%' || text.substr(0, 2) == "//");
}

void find_heading(const std::vector<HeadLine>& lines, std::size_t first, Encoding encoding, Dialect& dialect) {
  std::vector<std::string> units;
  std::size_t units_line = 0;
  std::optional<std::pair<std::size_t, std::vector<std::string>>> comment_heading;
  for (std::size_t i = first; i-- > 0 && first - i <= 8;) {
    if (trimmed(lines[i].text).empty()) continue;
    auto cells = heading_cells(lines[i].text, dialect, encoding);
    if (cells.empty() || cells.size() > std::max(dialect.columns + 1, dialect.first_row.size())) continue;
    if (dialect.separator == blanks && cells.size() != dialect.columns) continue;  // words of a sentence
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
  take_names_above(lines, encoding, dialect);
  take_labels_of_units(lines, first, encoding, dialect);
  name_times_of_channels(dialect);
}

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

std::vector<RawFact> find_facts(const std::vector<HeadLine>& lines, Encoding encoding, const Dialect& dialect) {
  std::vector<RawFact> facts;
  for (std::size_t number = 1; number < dialect.data_line; ++number) {
    if (number == dialect.header_line || number == dialect.units_line) continue;
    if (auto fact = find_fact(to_utf8(lines[number - 1].text, encoding), number)) facts.push_back(std::move(*fact));
  }
  return facts;
}

std::string number_of_step(const std::string& text) {
  std::string rest = lower_case(trimmed(text));
  for (const std::string& word : split("step|run|schritt|zyklus|cycle", '|')) {
    if (!rest.starts_with(word)) continue;
    rest.erase(0, word.size());
    for (const char* filler : {" ", "number", "no.", "no", "nr.", "nr", "#", " ", ":", "=", " "}) {
      if (rest.starts_with(filler)) rest.erase(0, std::string_view(filler).size());
    }
    const auto end = std::find_if_not(rest.begin(), rest.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
    const bool whole = end == rest.end() || !std::isalnum(static_cast<unsigned char>(*end));
    return whole ? std::string(rest.begin(), end) : std::string();
  }
  return {};
}

void find_blocks(const std::vector<std::vector<std::string>>& rows, Dialect& dialect) {
  std::map<std::string, std::size_t> times;
  std::vector<std::string> bases;
  for (const std::string& name : dialect.names) {
    bases.push_back(parse_column_name(name).base);
    if (name_rank(bases.back(), Channel::time, std::nullopt) != no_rank) ++times[bases.back()];
  }
  std::vector<std::size_t> starts;
  for (std::size_t k = 0; k < bases.size(); ++k) {
    const auto time = times.find(bases[k]);
    if (time != times.end() && time->second > 1) starts.push_back(k);
  }
  if (starts.size() < 2) return;
  dialect.blocks.assign(dialect.columns, 0);
  for (std::size_t k = 0; k < dialect.columns; ++k) {
    const auto begun = std::upper_bound(starts.begin(), starts.end(), k) - starts.begin();
    dialect.blocks[k] = static_cast<std::size_t>(std::max<std::ptrdiff_t>(begun, 1)) - 1;
  }
  for (const auto& row : rows) {
    const auto time = [&](std::size_t start) { return start < row.size() ? row[start] : std::string(); };
    for (const std::size_t start : starts) {
      dialect.blocks_apart = dialect.blocks_apart || time(start) != time(starts.front());
    }
  }
}

}  // namespace tribofit
