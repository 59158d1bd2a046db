#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "dialect.hpp"
#include "ingest/input_file.hpp"
#include "ingest/raw_table.hpp"
#include "row_parser.hpp"

namespace tribofit {

/// The rows of a table, as written.
struct Rows {
  std::vector<std::vector<double>> values;  ///< one vector for each wanted cell, in the same order
  LineMap lines;
  std::uint64_t checksum = 0;  ///< of the bytes read, XXH64
  std::size_t text_rows = 0;   ///< dropped because they hold text, not numbers
  std::size_t first_text_line = 0;

  std::size_t size() const { return values.empty() ? 0 : values.front().size(); }
};

/// Reads the rows of the table in chunks of a megabyte, in parallel; only the `wanted` cells are converted.
///
/// Lines are read by fast-cpp-csv-parser; cells are taken as text and converted exactly rounded. Blank lines are
/// skipped; comments and lines of text are dropped and counted. Cells that are empty, no number or not finite, and rows
/// with too few or too many cells are refused with an InputError: the first one in the file, whatever the number of
/// threads. The result does not depend on it either.
/// Cost: linear; memory: the values and some two megabytes a thread.
Rows read_rows(const InputFile& file, const Dialect& dialect, const std::vector<WantedCell>& wanted, int threads);

}  // namespace tribofit
