#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace tribofit {

/// A small table for people (a manifest, a table of values): every cell is text.
struct TextTable {
  struct Row {
    std::size_t line = 0;
    std::vector<std::string> cells;
  };
  std::string path;
  std::vector<std::string> names;  ///< of the header
  std::size_t header_line = 0;
  std::vector<Row> rows;
  char separator = ',';

  /// The cells of a row, as many as the header has. Throws InputError where the row has more.
  std::vector<std::string> cells_of(std::size_t row) const;

  /// A number as written, with a decimal point where the separator leaves room for a decimal comma.
  std::string with_decimal_point(const std::string& number) const;
};

/// What a table must be, for its messages.
struct TextTableRules {
  std::uint64_t largest = 0;  ///< [bytes]
  std::string too_large;      ///< problem, as "is too large for a manifest"
  std::string size_advice;
  std::string header_advice;  ///< where it is empty or has no header
};

/// Reads a table whose header is the first line that says something: blank lines, lines of separators only and comments
/// (#) are left out. The separator is the most frequent of comma, semicolon and tab in the header.
/// Throws InputError for a file that is too large, empty, no text or without a header.
TextTable read_text_table(const std::string& path, const TextTableRules& rules);

}  // namespace tribofit
