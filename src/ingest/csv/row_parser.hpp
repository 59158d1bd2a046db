#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/raw_table.hpp"

namespace tribofit {

/// A cell that is asked for in each row.
struct WantedCell {
  std::size_t index = 0;  ///< in the row, from 0
  std::string column;     ///< for messages
};

/// Turns one line into the numbers of the wanted cells.
class RowParser {
 public:
  enum class Outcome { numbers, blank, text, wrong };

  /// `wanted` in the order of the row; `cells` is how many a row has; rows that `may_be_short` lack empty ones at the
  /// end.
  RowParser(const std::vector<WantedCell>& wanted, std::size_t cells, char separator, char decimal, bool may_be_short);

  /// Reads the line at `at`, which ends with a line feed before `end`, where it holds plain numbers without quotes in
  /// the right number of cells: into column[k][row] for the wanted cell k. Returns the beginning of the next line;
  /// nullptr leaves this one to parse().
  const char* parse_plain(const char* at, const char* end, const std::vector<double*>& column, std::size_t row) const;

  /// Parses a line without its end into `out`, one number for each wanted cell, as written; NaN where a cell holds none
  /// of a usable size. defect() says what is wrong after Outcome::wrong, and in the first cell without a number after
  /// is_gappy().
  Outcome parse(std::string_view line, std::vector<double>& out);

  /// Whether a wanted cell of the last row is not a number.
  bool is_gappy() const { return gappy_; }
  const RawDefect& defect() const { return defect_; }

 private:
  Outcome judge(const std::vector<std::string>& cells, std::vector<double>& out);
  double number_of(const std::string& cell, const std::string& column);
  Outcome refuse(std::string problem, std::string advice, std::string column = {});

  const std::vector<WantedCell>& wanted_;
  std::size_t cells_;
  char separator_, decimal_;
  bool may_be_short_;
  bool gappy_ = false;
  RawDefect defect_;
};

}  // namespace tribofit
