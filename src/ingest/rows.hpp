#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "columns.hpp"
#include "dialect.hpp"
#include "input_file.hpp"

namespace tribofit {

/// Which line of the file a row came from: rows follow one another line by line except after dropped lines.
class LineMap {
 public:
  /// Row `row` (and those after it, one line each) came from `line`. Rows must not decrease.
  void set(std::size_t row, std::size_t line);
  std::size_t line_of(std::size_t row) const;

 private:
  std::vector<std::pair<std::size_t, std::size_t>> starts_;
};

/// The rows of a table, converted to SI.
struct Rows {
  std::vector<std::vector<double>> values;  ///< one vector per column in `columns`, in the same order
  LineMap lines;
  std::uint64_t checksum = 0;  ///< of the bytes read, see hash_bytes
  std::size_t text_rows = 0;   ///< dropped because they hold text, not numbers
  std::size_t first_text_line = 0;

  std::size_t size() const { return values.empty() ? 0 : values.front().size(); }
};

/// AddsToReading the rows of the table in chunks of a megabyte, in parallel; only `columns` are converted.
///
/// Lines are read by fast-cpp-csv-parser; cells are taken as text and converted exactly rounded. Blank lines are
/// skipped; comments and lines of text are dropped and counted. Cells that are empty, no number or not finite, and rows
/// with too few or too many cells are refused with an InputError: the first one in the file, whatever the number of
/// threads. The result does not depend on it either.
/// Cost: linear; memory: the values and some two megabytes a thread.
Rows read_rows(const InputFile& file, const Dialect& dialect, const std::vector<Column>& columns, int threads);

/// FNV-1a of `bytes` continuing from `hash`: over words of eight bytes in four lanes, the rest one by one.
std::uint64_t hash_bytes(const char* bytes, std::size_t count, std::uint64_t hash = 14695981039346656037ULL);

}  // namespace tribofit
