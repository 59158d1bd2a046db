#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "decimal.hpp"

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

  /// What is wrong with a line, without where.
  struct Defect {
    std::string problem, advice, column;
  };

  /// `wanted` in the order of the row; `cells` is how many a row has; rows that `may_be_short` lack empty ones at the
  /// end.
  RowParser(const std::vector<WantedCell>& wanted, std::size_t cells, char separator, char decimal, bool may_be_short);

  /// Reads whole lines of plain numbers from `at` on, up to `end` (where a NUL stands) or the first that is none, in
  /// one pass: decimals without quotes, the right number of cells. Row `row` goes into column[k][row] for the wanted
  /// cell k, and `row` counts on. Returns the beginning of the first line that it has not read.
  char* parse_plain_rows(char* at, const char* end, const std::vector<double*>& column, std::size_t& row);

  /// Parses `line` (ended by NUL; may be changed) into `out`, one number for each wanted cell, as written; NaN where a
  /// cell holds none of a usable size. defect() says what is wrong after Outcome::wrong, and in the first cell without
  /// a number after is_gappy().
  Outcome parse(char* line, double* out);

  /// Whether a wanted cell of the last row is not a number.
  bool is_gappy() const { return gappy_; }
  const Defect& defect() const { return defect_; }
  /// The last line as it was, after Outcome::text.
  const std::string& text() const { return text_; }

 private:
  template <char separator>
  char* parse_plain_row(char* at, const char* end, const std::vector<double*>& column, std::size_t row);
  bool parse_blanks(const char* line, double* out);
  template <char separator>
  Outcome parse_carefully(char* line, double* out);
  template <char separator>
  void split(char* line);
  void split_at_blanks(char* line);
  Outcome judge(const std::vector<char*>& cells, double* out);
  bool is_data(const std::vector<char*>& cells, std::size_t& count) const;
  void take(char* cell, const std::string& column, double& out);
  Outcome refuse(std::string problem, std::string advice, std::string column = {});
  bool to_number(char* cell, double& value) const;

  const std::vector<WantedCell>& wanted_;
  std::vector<DecimalForm> forms_;  // of the numbers last read
  std::vector<std::size_t> skips_;  // cells between one that is wanted and the next
  std::size_t cells_;
  char separator_, decimal_;
  bool may_be_short_;
  std::vector<char*> split_;
  bool gappy_ = false;
  Defect defect_;
  std::string text_;
};

}  // namespace tribofit
