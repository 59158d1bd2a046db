#include "terminal_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "numbers.hpp"

namespace tribofit {

constexpr std::size_t kIndent = 2;  // of tables

namespace {

/// The columns of a table up to a level of detail.
ReportTable with_columns(const ReportTable& table, const std::vector<std::size_t>& kept) {
  ReportTable out;
  for (const std::size_t k : kept) out.columns.push_back(table.columns[k]);
  for (const std::vector<std::string>& row : table.rows) {
    std::vector<std::string>& own = out.rows.emplace_back();
    for (const std::size_t k : kept) own.push_back(k < row.size() ? row[k] : "");
  }
  return out;
}

/// Lines of a table that is too wide, in blocks of as many columns as fit; each block begins with the columns of text
/// before the first number, which say what a row is of.
std::vector<std::vector<std::string>> in_blocks(const ReportTable& table, std::size_t width) {
  std::vector<std::size_t> heads, others;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].detail > 0) continue;
    (others.empty() && (heads.empty() || !table.columns[k].number) ? heads : others).push_back(k);
  }
  std::set<std::string> first;
  for (const std::vector<std::string>& row : table.rows) first.insert(row.empty() ? "" : row[0]);
  if (heads.size() > 1 && first.size() == table.rows.size() &&
      first.count("") == 0) {  // its name says what a row is of
    others.insert(others.begin(), heads.begin() + 1, heads.end());
    heads.resize(1);
  }
  const auto lines_of = [&](std::vector<std::size_t> columns, const std::vector<std::size_t>& more) {
    columns.insert(columns.end(), more.begin(), more.end());
    return aligned(with_columns(table, columns), kIndent);
  };
  while (heads.size() > 1 && widest(lines_of(heads, {})) > width / 2) {  // leave room for what they are of
    others.insert(others.begin(), heads.back());
    heads.pop_back();
  }
  std::vector<std::vector<std::string>> blocks;
  for (std::size_t begin = 0, end = 0; begin < others.size(); begin = end) {
    std::vector<std::size_t> columns;
    for (end = begin; end < others.size(); ++end) {
      columns.push_back(others[end]);
      if (end > begin && widest(lines_of(heads, columns)) > width) break;
    }
    if (end < others.size()) columns.pop_back();
    blocks.push_back(lines_of(heads, columns));
  }
  return blocks;
}

}  // namespace

TerminalText::TerminalText(const TerminalOptions& options)
    : width_(std::clamp<std::size_t>(options.width, 40, 120)), unicode_(options.unicode) {
  if (!options.colour) return;
  bold_ = "\033[1m";
  dim_ = "\033[2m";
  yellow_ = "\033[33m";
  red_ = "\033[31m";
  off_ = "\033[0m";
}

std::string TerminalText::in_colour(std::string_view code, std::string_view text) const {
  return std::string(code) + std::string(text) + std::string(off_);
}

std::string TerminalText::with_signs(std::string_view text) const {
  std::string out(text);
  if (!unicode_) return out;
  for (std::size_t at = out.find("+/-"); at != std::string::npos; at = out.find("+/-", at)) {
    out.replace(at, 3, "\u00b1");
  }
  return out;
}

void TerminalText::heading(std::string_view title) {
  text_ += "\n" + bold(with_signs(title)) + "\n";
}

void TerminalText::line(std::string_view sentence, std::size_t indent, std::size_t hanging) {
  if (sentence.empty()) return;
  const std::string text = wrapped(with_signs(sentence), width_, hanging == kAll ? indent : hanging);
  text_ += std::string(indent, ' ') + text + "\n";
}

void TerminalText::lines(const std::vector<std::string>& sentences, std::size_t indent, std::size_t hanging) {
  for (const std::string& sentence : sentences) line(sentence, indent, hanging);
}

void TerminalText::item(std::string_view name, std::string_view text, std::size_t name_width) {
  text_ += fmt::format("  {:<{}}{}\n", name, name_width, wrapped(with_signs(text), width_, name_width + 2));
}

void TerminalText::warning(std::string_view text) {
  text_ += "  " + in_yellow("warning") + " " + wrapped(with_signs(text), width_, 10) + "\n";
}

void TerminalText::table(const ReportTable& all, std::size_t most) {
  if (all.rows.empty()) return;
  if (!all.caption.empty()) heading(all.caption);
  ReportTable table = all;
  table.rows.resize(std::min(most, table.rows.size()));
  for (std::vector<std::string>& row : table.rows) {
    for (std::string& cell : row) cell = with_signs(cell);
  }
  int detail = 0;
  for (const ReportColumn& column : table.columns) detail = std::max(detail, column.detail);
  std::vector<std::string> rows;
  for (; detail >= 0; --detail) {
    rows = aligned(table, kIndent, detail);
    if (widest(rows) <= width_) break;
  }
  const auto show = [&](const std::vector<std::string>& lines) {
    for (std::size_t k = 0; k < lines.size(); ++k) text_ += (k == 0 ? dim(lines[k]) : lines[k]) + "\n";
  };
  if (widest(rows) <= width_ || table.columns.size() < 3) {
    show(rows);
  } else {
    const auto blocks = in_blocks(table, width_);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (b > 0) text_ += "\n";
      show(blocks[b]);
    }
  }
  if (all.rows.size() > most) line(fmt::format("... and {} more in {}", all.rows.size() - most, all.file));
}

void TerminalText::items(const std::vector<ReportItem>& items) {
  for (const ReportItem& item : items) {
    if (const auto* shown = std::get_if<ReportTable>(&item); shown != nullptr && !shown->folded) table(*shown);
    const auto* text = std::get_if<ReportText>(&item);
    if (text == nullptr) continue;
    using Kind = ReportText::Kind;
    if (text->kind == Kind::heading) heading(text->text);
    if (text->kind == Kind::warning) warning(text->text);
    if (text->kind == Kind::plain || text->kind == Kind::soft) line(text->text);
    if (text->kind == Kind::item) line(text->text, 2, 4);
    if (text->kind == Kind::command) text_ += folded_command(text->text, width_) + "\n";
  }
}

void TerminalText::section(const ReportSection& section) {
  if (!section.items.empty()) heading(section.title);
  items(section.items);
}

void TerminalText::next(const Suggestion& next) {
  text_ += "\n" + wrapped("Next, " + next.reason + ":", width_, 0) + "\n" + folded_command(next.command, width_) + "\n";
}

void TerminalText::look(const std::vector<Suggestion>& ways) {
  for (const Suggestion& way : ways) {
    text_ += wrapped(capitalised(way.reason) + ":", width_, 0) + "\n" + folded_command(way.command, width_) + "\n";
  }
}

void TerminalText::result(const std::vector<std::string>& warnings, std::string_view verdict, const Suggestion& then) {
  heading("Result");
  for (const std::string& text : warnings) warning(text);
  line(verdict);
  next(then);
}

std::size_t displayed(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::size_t widest(const std::vector<std::string>& lines) {
  std::size_t width = 0;
  for (const std::string& line : lines) width = std::max(width, displayed(line));
  return width;
}

std::string wrapped(std::string_view sentence, std::size_t width, std::size_t indent) {
  std::string result;
  std::size_t column = indent;
  while (!sentence.empty()) {
    const std::size_t blank = sentence.find(' ');
    const std::string_view word = sentence.substr(0, blank);
    const std::size_t length = displayed(word);
    if (column > indent) {
      const bool fits = column + 1 + length <= width;
      result += fits ? std::string(" ") : "\n" + std::string(indent, ' ');
      column = fits ? column + 1 : indent;
    }
    result += word;
    column += length;
    sentence.remove_prefix(blank == std::string_view::npos ? sentence.size() : blank + 1);
  }
  return result;
}

std::vector<std::string> aligned(const ReportTable& table, std::size_t indent, int detail) {
  const std::size_t count = table.rows.size();
  const auto cell = [&](std::size_t row, std::size_t k) -> std::string_view {  // row 0: the header
    if (row == 0) return table.columns[k].brief.empty() ? table.columns[k].name : table.columns[k].brief;
    return k < table.rows[row - 1].size() ? std::string_view(table.rows[row - 1][k]) : std::string_view();
  };
  std::vector<std::string> lines(count + 1, std::string(indent, ' '));
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].detail > detail) continue;
    std::size_t width = 0;
    for (std::size_t i = 0; i <= count; ++i) width = std::max(width, displayed(cell(i, k)));
    for (std::size_t i = 0; i <= count; ++i) {
      const std::string gap(width - displayed(cell(i, k)), ' ');
      const std::string text(cell(i, k));
      lines[i] += (k == 0 ? "" : "  ") + (table.columns[k].number ? gap + text : text + gap);
    }
  }
  for (std::string& line : lines) line.erase(line.find_last_not_of(' ') + 1);
  return lines;
}

std::pair<const char*, const char*> bar_signs(bool unicode) {
  return unicode ? std::pair("\u2591", "\u2588") : std::pair("-", "#");
}

std::string bar(double value, double full, std::size_t columns, bool unicode, double pale) {
  static constexpr std::array<const char*, 8> eighths = {"",       "\u258f", "\u258e", "\u258d",
                                                         "\u258c", "\u258b", "\u258a", "\u2589"};
  if (!(full > 0) || !std::isfinite(value)) return "";
  const double width = static_cast<double>(columns);
  const double length = std::clamp(value / full, 0.0, 1.0) * width;
  const auto light = static_cast<std::size_t>(std::round(std::min(std::clamp(pale / full, 0.0, 1.0) * width, length)));
  const auto [pale_sign, full_sign] = bar_signs(unicode);
  std::string text;
  for (std::size_t k = 0; k < light; ++k) text += pale_sign;
  double left = length - static_cast<double>(light);
  if (!unicode) left = std::round(left);
  for (; left >= 1; left -= 1) text += full_sign;
  if (unicode && left > 0) text += eighths[static_cast<std::size_t>(8 * left)];
  return text;
}

}  // namespace tribofit
