#pragma once

#include <cstddef>
#include <string>
#include <vector>

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

  /// `wanted` in the order of the row; `cells` is how many a row has.
  RowParser(const std::vector<WantedCell>& wanted, std::size_t cells, char separator, char decimal);

  /// Parses `line` (ended by NUL; may be changed) into `out`, one number for each wanted cell, as written.
  /// After Outcome::wrong, defect() says what is wrong.
  Outcome parse(char* line, double* out);

  const Defect& defect() const { return defect_; }

 private:
  template <char separator>
  bool parse_plain(const char* line, double* out) const;
  template <char separator>
  Outcome parse_carefully(char* line, double* out);
  Outcome judge(const std::vector<char*>& cells, double* out);
  Outcome refuse(std::string problem, std::string advice, std::string column = {});
  bool to_number(char* cell, double& value) const;

  const std::vector<WantedCell>& wanted_;
  std::vector<std::size_t> skips_;  // cells between one that is wanted and the next
  std::size_t cells_;
  char separator_, decimal_;
  std::vector<char*> split_;
  Defect defect_;
};

}  // namespace tribofit
