#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>

#include "whole_folder.hpp"

namespace tribofit {

/// Whether a spreadsheet would take a text for a formula: behind any apostrophes it begins with = + - @, and is no
/// number. In a cell it has one apostrophe more, which says that it is text.
bool is_formula(std::string_view text);

/// One line of a CSV file, cell by cell. Text is quoted where a reader would see more than one cell or a comment, and
/// its line breaks become blanks; what a spreadsheet would take for a formula is marked as text; a number that is not
/// known is an empty cell; truth is 1 and 0. The values of a JSON object or list are laid out in their order, null as
/// an empty cell: so a table has the numbers of the JSON, under the names of its header.
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

/// A CSV file of a folder, line by line, which begins with the names of the cells. digits: as of a CsvLine.
class CsvFile {
 public:
  CsvFile(WholeFolder& files, const std::string& name, const std::string& names, int digits = kMeasuredDigits)
      : file_(files.add(name)), line_(digits) {
    file_.write(names + "\n");
  }
  template <class... Cells>
  void add(const Cells&... cells) {
    line_.add(cells...);
  }
  /// A line of what was added, then these cells.
  template <class... Cells>
  void row(const Cells&... cells) {
    add(cells...);
    file_.write(line_.take());
  }

 private:
  WholeFile& file_;
  CsvLine line_;
};

/// Writes a file of a folder, a line a row, which `row_of` gives as an object; that of row 0 has the names, even where
/// there are no rows.
template <class RowOf>
void write_rows(WholeFolder& files, const std::string& name, std::size_t rows, const RowOf& row_of, int digits = 0) {
  CsvFile file(files, name, csv_names(row_of(0)), digits);
  for (std::size_t k = 0; k < rows; ++k) file.row(row_of(k));
}

}  // namespace tribofit
