#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoding.hpp"
#include "ingest/input_file.hpp"
#include "ingest/raw_table.hpp"

namespace tribofit {

/// The separator of columns that are divided by one or more blanks or tabs.
inline constexpr char blanks = ' ';

/// The cells of a line: quotes taken off, white space trimmed.
std::vector<std::string> split_cells(std::string_view line, char separator);

/// The number that the whole cell is, exactly rounded; nan and inf are, and a decimal point is understood in any file.
std::optional<double> number_in(std::string_view cell, char decimal);
/// Whether it is one with this decimal mark.
bool is_number(std::string_view cell, char decimal);

/// The time of a logger that writes a clock: "12:04:59.250", with a date before it or not ("2024-05-03T12:04:59,25",
/// "03.05.2024 12:04:59"), in seconds since the beginning of the year 2020, or of the day. Doubles hold it to 0.1 us.
/// Nothing for any other text: days and months in American or English order cannot be told apart.
std::optional<double> clock_time(std::string_view cell);

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

/// A line of the beginning of a file, without its end.
struct HeadLine {
  std::string_view text;
  std::uint64_t begin = 0;
};

/// Whether the line begins like a comment.
bool is_comment(std::string_view line);

/// Finds the names and units of the columns above line `first` (from 0) and sets them in the dialect, whose separator
/// and number of columns are known: a header with a row of units below it, or with units in the place of some names and
/// the names in the line above (drives), or "Channel name, Force, Channel name, Input" (NI), where every other column
/// is the time of the next.
void find_heading(const std::vector<HeadLine>& lines, std::size_t first, Encoding encoding, Dialect& dialect);

/// "# Radius [mm]: 15", "Speed = 4 rpm", "\"Normal load [N]\";50", "Interval,0.0005,..." as a name and its value.
std::optional<RawFact> find_fact(std::string_view line, std::size_t number);

/// "2" of "Step No. 2", "Step 2 started at 12:00", "Run # 2"; empty for other lines.
std::string number_of_step(const std::string& text);

/// The facts of the lines above the first row.
std::vector<RawFact> find_facts(const std::vector<HeadLine>& lines, Encoding encoding, const Dialect& dialect);

/// Sets which block of columns each belongs to, where a time column stands more than once in a row: a block begins with
/// each. `rows`: some rows of the file, its last one among them; where they show that the blocks have clocks of their
/// own, or that one ends before the other, the blocks are apart.
void find_blocks(const std::vector<std::vector<std::string>>& rows, Dialect& dialect);

/// What is wrong with a line of more than a megabyte.
RawDefect too_long_line();

}  // namespace tribofit
