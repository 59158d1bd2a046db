#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dialect.hpp"
#include "encoding.hpp"

namespace tribofit {

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

}  // namespace tribofit
