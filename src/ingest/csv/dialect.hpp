#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cells.hpp"
#include "ingest/input_file.hpp"
#include "ingest/raw_table.hpp"

namespace tribofit {

/// How a file writes its table, and where the table begins and ends.
struct Dialect {
  char separator = ',';
  char decimal = '.';
  std::size_t columns = 0;             ///< cells in a row, without empty ones after a trailing separator
  std::vector<std::string> names;      ///< of the columns, in UTF-8; empty where there is no header
  std::vector<std::string> units;      ///< from a row of units below the header; empty where there is none
  std::size_t header_line = 0;         ///< 1-based; 0: no header
  std::size_t units_line = 0;          ///< 1-based; 0: no row of units
  std::size_t data_line = 1;           ///< of the first row
  std::uint64_t data_begin = 0;        ///< bytes
  std::uint64_t data_end = 0;          ///< bytes; before the end of the file where the last row is cut off
  double row_bytes = 0;                ///< mean length of the first rows
  std::vector<std::string> first_row;  ///< its cells
  std::vector<std::size_t> blocks;     ///< of each column, where a row has several, each with a time; else empty
  bool blocks_apart = false;           ///< their clocks differ, or one ends before the other
  std::string first_step;              ///< its number, where a line above the first row states it
  std::vector<RawFact> facts;          ///< "name: value" of the preamble
  std::vector<std::string> notes;
};

/// Finds the dialect from the first lines of the file, within its first megabyte.
///
/// Separator and decimal mark are those under which most cells of most lines are numbers. The first row is the first
/// line with as many cells as most have and mostly numbers in them; the header is the last line of text above it that
/// names at least one column, below which a row of units may stand. A last line without an end that is shorter than
/// the one above is cut off and dropped.
/// Throws InputError for an empty file, a file that is not text, and one without rows of numbers.
Dialect find_dialect(const InputFile& file);

/// What is wrong with a line of more than a megabyte.
RawDefect too_long_line();

}  // namespace tribofit
