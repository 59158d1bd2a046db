#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "dialect.hpp"
#include "ingest/input_file.hpp"
#include "ingest/raw_table.hpp"

namespace tribofit {

/// A cell that is asked for in each row.
struct WantedCell {
  std::size_t index = 0;  ///< in the row, from 0
  std::string column;     ///< for messages
};

/// A line of text or comment between the rows.
struct TextLine {
  std::size_t row = 0;   ///< that follows it, or one beyond the last
  std::size_t line = 0;  ///< of the file, from 1
  std::string text;      ///< its beginning, as bytes
};

/// The rows of a table, as written.
struct Rows {
  std::vector<std::vector<double>> values;  ///< one vector for each wanted cell, in the same order
  LineMap lines;
  std::size_t text_rows = 0;           ///< dropped because they hold text, not numbers
  std::vector<TextLine> text;          ///< the first of them
  std::optional<RawDefect> first_gap;  ///< the first cell that is not a number of a usable size: its value is NaN

  std::size_t size() const { return values.empty() ? 0 : values.front().size(); }
};

/// Reads the rows of the table in chunks, in parallel; only the `wanted` cells are converted, exactly rounded.
///
/// Lines of plain numbers are read in one pass; others are divided into cells first. Blank lines are skipped; comments
/// and lines of text are dropped, counted and, up to some thousands, kept. Cells that are empty, no number or not
/// finite are NaN. Rows with too few or too many cells are refused with an InputError: the first one in the file,
/// whatever the number of threads. The result does not depend on it either. Throws InputError where the values would
/// take more memory than there is. Cost: linear; memory: the values and half a megabyte a thread.
Rows read_rows(const InputFile& file, const Dialect& dialect, const std::vector<WantedCell>& wanted, int threads);

}  // namespace tribofit
