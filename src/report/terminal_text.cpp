#include "terminal_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "commands.hpp"
#include "numbers.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

constexpr std::size_t kIndent = 2, kMostRows = 40;  // of tables
constexpr std::size_t kNames = 18;                  // columns of the names of facts

namespace {

using ColumnIndices = std::vector<std::size_t>;
using Lines = std::vector<std::string>;

/// The columns of a table up to a level of detail.
ColumnIndices columns_of(const ReportTable& table, int detail) {
  ColumnIndices columns;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k].detail <= detail) columns.push_back(k);
  }
  return columns;
}

/// A table that is too wide, in blocks of as many columns as fit; each begins with the columns of text before the first
/// number, which say what a row is of.
std::vector<Lines> in_blocks(const ReportTable& table, std::size_t width) {
  ColumnIndices heads, others;
  for (const std::size_t k : columns_of(table, 0)) {
    (others.empty() && (heads.empty() || !table.columns[k].number) ? heads : others).push_back(k);
  }
  const auto lines_of = [&](ColumnIndices columns, const ColumnIndices& more) {
    columns.insert(columns.end(), more.begin(), more.end());
    return aligned(table, kIndent, columns);
  };
  const auto keep_heads = [&](std::size_t count) {
    others.insert(others.begin(), heads.begin() + static_cast<std::ptrdiff_t>(count), heads.end());
    heads.resize(count);
  };
  std::set<std::string> names;
  for (const Lines& row : table.rows) names.insert(row.empty() ? "" : row[0]);
  if (heads.size() > 1 && names.size() == table.rows.size() && !names.contains("")) keep_heads(1);
  while (heads.size() > 1 && widest(lines_of(heads, {})) > width / 2) keep_heads(heads.size() - 1);
  std::vector<Lines> blocks;
  for (std::size_t begin = 0, end = 0; begin < others.size(); begin = end) {
    ColumnIndices columns;
    for (end = begin; end < others.size(); ++end) {
      columns.push_back(others[end]);
      if (end > begin && widest(lines_of(heads, columns)) > width) break;
    }
    if (end < others.size()) columns.pop_back();
    blocks.push_back(lines_of(heads, columns));
  }
  return blocks;
}

/// Text for a terminal, part by part: sentences broken to its width, tables whose columns line up, colours where they
/// can be shown, and "+/-" as one sign where it can.
class TerminalText {
 public:
  explicit TerminalText(const TerminalOptions& options)
      : colour_(options.colour), width_(std::clamp<std::size_t>(options.width, 40, 120)), unicode_(options.unicode) {}

  /// What a terminal shows of a section, under its title unless that of the first item says enough.
  void section(const ReportSection& section) {
    if (section.medium == Medium::page) return;
    bool titled = section.title.empty();
    for (const ReportItem& one : section.items) {
      const auto* table = std::get_if<ReportTable>(&one);
      const auto* text = std::get_if<ReportText>(&one);
      const bool is_drawn = std::holds_alternative<Chart>(one) || std::holds_alternative<Animation>(one);
      if (one.medium == Medium::page || is_drawn || (table != nullptr && table->folded)) continue;
      titled = titled || (text != nullptr && text->kind == ReportText::Kind::heading) ||
               (table != nullptr && !table->caption.empty());
      if (!titled) heading(section.title);
      titled = true;
      std::visit([&](const auto& own) { item(own); }, one);
    }
  }

  /// What to do next, then ways to look at the same result.
  void next(const std::vector<Suggestion>& ways) {
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const std::string reason = k == 0 ? "Next, " + ways[k].reason : capitalised(ways[k].reason);
      text_ += (k == 0 ? "\n" : "") + wrapped(reason + ":", width_, 0) + "\n" +
               folded_command(ways[k].command, width_) + "\n";
    }
  }

  std::string take() { return std::move(text_); }

 private:
  static constexpr std::string_view kBold = "\033[1m", kDim = "\033[2m", kYellow = "\033[33m", kRed = "\033[31m";

  std::string in(std::string_view colour, std::string_view text) const {
    return colour_ ? fmt::format("{}{}\033[0m", colour, text) : std::string(text);
  }
  /// "+/-" as the sign where it can be shown.
  std::string with_signs(const std::string& text) const { return unicode_ ? replaced(text, "+/-", "\u00b1") : text; }
  void heading(const std::string& title) { text_ += "\n" + in(kBold, with_signs(title)) + "\n"; }
  void remark(const std::string& kind, const std::string& sentence) {
    text_ += "  " + kind + " " + wrapped(with_signs(sentence), width_, 10) + "\n";
  }
  void line(const std::string& sentence, std::size_t indent, std::size_t hanging) {
    text_ += std::string(indent, ' ') + wrapped(with_signs(sentence), width_, hanging) + "\n";
  }

  void item(const ReportText& item) {
    using Text = ReportText::Kind;
    const std::string& text = item.text;
    const auto is = [&](Text kind) { return item.kind == kind; };
    if (is(Text::title)) text_ += in(kBold, wrapped(with_signs(text), width_, 2)) + "\n";
    if (is(Text::heading)) heading(text);
    if (is(Text::name)) text_ += "  " + in(kBold, text) + "\n";
    if (is(Text::warning)) remark(in(kYellow, "warning"), text);
    if (is(Text::problem)) remark(in(kRed, "problem"), text);
    if (is(Text::command)) text_ += folded_command(text, width_) + "\n";
    if (is(Text::drawing)) text_ += "\n" + text;
    if (is(Text::detail)) line(text, 4, 4);
    if (is(Text::item)) line(text, 2, 4);
    if (is(Text::plain) || is(Text::soft)) line(text, 2, 2);
  }

  void item(const ReportFacts& facts) {
    for (const auto& [name, value] : facts.facts) {
      text_ += fmt::format("  {:<{}}{}\n", name, kNames, wrapped(with_signs(value), width_, kNames + 2));
    }
  }

  /// A table with its caption as heading: without the columns of most detail where the terminal is narrow, and in
  /// blocks one below the other where it is too narrow for the others. Without names no row is above it.
  void item(ReportTable table) {
    if (!table.caption.empty()) heading(table.caption);
    const std::size_t count = table.rows.size();
    table.rows.resize(std::min(kMostRows, count));
    for (Lines& row : table.rows) {
      for (std::string& cell : row) cell = with_signs(cell);
    }
    int detail = 0;
    bool named = false;
    for (const ReportColumn& column : table.columns) {
      detail = std::max(detail, column.detail);
      named |= !column.name.empty();
    }
    const ReportTable::Bars& bars = table.bars;
    const std::size_t shortest = bars.values.empty() ? 0 : bars.shortest;
    const auto lines = [&] { return aligned(table, kIndent, columns_of(table, detail)); };
    while (detail > 0 && widest(lines()) + shortest > width_) --detail;
    const std::size_t used = widest(lines()), room = used < width_ ? std::min(width_ - used, bars.longest) : 0;
    for (std::size_t k = 0; k < bars.values.size(); ++k) {
      table.rows[k][bars.column] = bar(bars.values[k], bars.full, room, unicode_, bars.pale);
    }
    std::vector<Lines> blocks = {lines()};
    if (widest(blocks[0]) > width_ && table.columns.size() > 2) blocks = in_blocks(table, width_);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      if (b > 0) text_ += "\n";
      if (named) text_ += in(kDim, blocks[b][0]) + "\n";
      for (std::size_t k = 1; k < blocks[b].size(); ++k) text_ += blocks[b][k] + "\n";
    }
    if (!bars.pale_name.empty()) {
      const auto [pale, full] = bar_signs(unicode_);
      line(fmt::format("{} {}; {} {}", pale, bars.pale_name, full, bars.full_name), 2, 2);
    }
    if (count > kMostRows) line(fmt::format("... and {} more in {}", count - kMostRows, table.file), 2, 2);
  }

  static void item(const Chart&) {}
  static void item(const Animation&) {}

  bool colour_;
  std::size_t width_;
  bool unicode_;
  std::string text_;
};

}  // namespace

std::string render_terminal(const Report& report, const TerminalOptions& options) {
  TerminalText text(options);
  for (const ReportSection& section : report.sections) text.section(section);
  text.next(report.next);
  return text.take();
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

std::vector<std::string> aligned(const ReportTable& table, std::size_t indent, const ColumnIndices& columns) {
  Lines lines(table.rows.size() + 1, std::string(indent, ' '));
  for (const std::size_t k : columns) {
    const ReportColumn& column = table.columns[k];
    Lines cells = {column.brief.empty() ? column.name : column.brief};
    for (const Lines& row : table.rows) cells.push_back(k < row.size() ? row[k] : "");
    const std::size_t width = widest(cells);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::string gap(width - displayed(cells[i]), ' ');
      lines[i] += (k == columns.front() ? "" : "  ") + (column.number ? gap + cells[i] : cells[i] + gap);
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
