#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>

#include "whole_folder.hpp"

namespace tribofit {

/// One line of a CSV file, cell by cell. Text is quoted where a reader would see more than one cell or a comment, and
/// its line breaks become blanks; a number that is not known is an empty cell; truth is 1 and 0. The values of a JSON
/// object or list are laid out in their order, null as an empty cell: so a table has the numbers of the JSON, under the
/// names of its header.
class CsvLine {
 public:
  /// digits: of numbers; 0: to the last.
  explicit CsvLine(int digits = 0) : digits_(digits) {}

  template <class... Cells>
  void add(const Cells&... cells) {
    (add_cell(cells), ...);
  }
  /// The line with its line break; what is added then is the next one.
  std::string take();

 private:
  template <class Cell>
  void add_cell(const Cell& cell) {
    if constexpr (std::is_same_v<Cell, nlohmann::ordered_json>) {
      add_values(cell);
    } else if constexpr (std::is_floating_point_v<Cell>) {
      add_number(cell);
    } else if constexpr (std::is_integral_v<Cell>) {
      add_text(std::to_string(cell));
    } else {
      add_text(cell);
    }
  }
  void begin_cell();
  void add_number(double value);
  void add_text(std::string_view text);
  void add_values(const nlohmann::ordered_json& json);

  int digits_;
  bool has_cells_ = false;
  std::string text_;
};

template <class... Cells>
std::string csv_line(const Cells&... cells) {
  CsvLine line;
  line.add(cells...);
  return line.take();
}

/// Names of the cells that the members of an object fill in a line: theirs, and of an interval ("ci95") those of its
/// ends, NAME_lower and NAME_upper.
std::string csv_names(const nlohmann::ordered_json& object);

/// Digits of what was measured: more than any instrument has.
constexpr int kMeasuredDigits = 10;

/// Writes a file of a folder: the names of the cells, then a line a row, which `row_of` gives as an object; that of row
/// 0 has the names, even where there are no rows. digits: of numbers; 0: to the last.
template <class RowOf>
void write_rows(WholeFolder& files, const std::string& name, std::size_t rows, const RowOf& row_of, int digits = 0) {
  WholeFile& file = files.add(name);
  file.write(csv_names(row_of(0)) + "\n");
  CsvLine line(digits);
  for (std::size_t k = 0; k < rows; ++k) {
    line.add(row_of(k));
    file.write(line.take());
  }
}

}  // namespace tribofit
