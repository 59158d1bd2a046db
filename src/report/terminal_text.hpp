#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "tribofit/report/report.hpp"
#include "tribofit/report/terminal.hpp"

namespace tribofit {

/// Text for a terminal, part by part: sentences broken to its width, tables whose columns line up, colours where they
/// can be shown, and "+/-" as one sign where it can.
class TerminalText {
 public:
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

  explicit TerminalText(const TerminalOptions& options);

  /// As it is.
  void raw(std::string_view text) { text_ += text; }
  /// A blank line, then the title.
  void heading(std::string_view title);
  /// A sentence, if there is one; `hanging`: indentation of the lines after the first (by default that of the first).
  void line(std::string_view sentence, std::size_t indent = 2, std::size_t hanging = kAll);
  void lines(const std::vector<std::string>& sentences, std::size_t indent = 2, std::size_t hanging = kAll);
  /// "  name      text", the text indented behind the name.
  void item(std::string_view name, std::string_view text, std::size_t name_width = 18);
  void warning(std::string_view text);
  /// A table with its caption as heading, if it has rows: the first `most` of them, without the columns of most detail
  /// where the terminal is narrow, and in blocks one below the other where it is too narrow for the others.
  void table(const ReportTable& table, std::size_t most = kAll);
  /// What a page shows of a section; charts, and tables that it folds, are left out.
  void items(const std::vector<ReportItem>& items);
  /// The same under the title of the section, if there are any.
  void section(const ReportSection& section);
  void next(const Suggestion& next);
  /// Ways to look at the same result, behind the next command.
  void look(const std::vector<Suggestion>& ways);
  /// What it comes to: warnings, the verdict and the next command.
  void result(const std::vector<std::string>& warnings, std::string_view verdict, const Suggestion& next);

  std::string bold(std::string_view text) const { return in_colour(bold_, text); }
  std::string dim(std::string_view text) const { return in_colour(dim_, text); }
  std::string in_red(std::string_view text) const { return in_colour(red_, text); }
  std::string in_yellow(std::string_view text) const { return in_colour(yellow_, text); }
  std::size_t width() const { return width_; }
  bool unicode() const { return unicode_; }
  /// "+/-" as the sign where it can be shown.
  std::string with_signs(std::string_view text) const;

  std::string take() { return std::move(text_); }

 private:
  std::string in_colour(std::string_view code, std::string_view text) const;

  std::string_view bold_, dim_, yellow_, red_, off_;
  std::size_t width_;
  bool unicode_;
  std::string text_;
};

/// Columns a text takes: bytes that continue a UTF-8 character take none.
std::size_t displayed(std::string_view text);

std::size_t widest(const std::vector<std::string>& lines);

/// `sentence` broken at blanks to `width` columns, continuation lines indented by `indent`.
std::string wrapped(std::string_view sentence, std::size_t width, std::size_t indent);

/// Lines of a table, the header first, with `indent` blanks before each; numbers stand to the right. Columns of more
/// than `detail` are left out.
std::vector<std::string> aligned(const ReportTable& table, std::size_t indent, int detail = 0);

/// A bar of `value` on a scale on which `full` fills `columns`; the part up to `pale` is drawn lighter. Block
/// characters with eighths of a column, or '-' and '#' where only ASCII can be shown.
std::string bar(double value, double full, std::size_t columns, bool unicode, double pale = 0);

/// The two signs of which a bar is made: {lighter, full}.
std::pair<const char*, const char*> bar_signs(bool unicode);

}  // namespace tribofit
