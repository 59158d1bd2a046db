#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

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

  template <class Cell>
  void add(const Cell& cell) {
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
  /// The line with its line break; what is added then is the next one.
  std::string take();

 private:
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
  (line.add(cells), ...);
  return line.take();
}

/// Names of the cells that the members of an object fill in a line: theirs, and of an interval ("ci95") those of its
/// ends, NAME_lower and NAME_upper.
std::string csv_names(const nlohmann::ordered_json& object);

/// A column of a table: its name, and its cell of a row, which a member or a function gives. One that gives a JSON
/// object or list has as many names, with commas.
template <class Row>
struct CsvColumn {
  template <class Cell>
  CsvColumn(std::string header, Cell cell)
      : name(std::move(header)), add([cell](CsvLine& line, const Row& row) { line.add(std::invoke(cell, row)); }) {}

  std::string name;
  std::function<void(CsvLine&, const Row&)> add;
};

/// Digits of what was measured: more than any instrument has.
constexpr int kMeasuredDigits = 10;

/// A file of a folder that begins with a header.
template <class Row>
class CsvTable {
 public:
  CsvTable(WholeFolder& folder, const std::string& name, std::vector<CsvColumn<Row>> columns, int digits = 0)
      : file_(folder.add(name)), columns_(std::move(columns)), line_(digits) {
    std::string header;
    for (const CsvColumn<Row>& column : columns_) header += (header.empty() ? "" : ",") + column.name;
    file_.write(header + "\n");
  }
  void row(const Row& row) {
    for (const CsvColumn<Row>& column : columns_) column.add(line_, row);
    file_.write(line_.take());
  }

 private:
  WholeFile& file_;
  std::vector<CsvColumn<Row>> columns_;
  CsvLine line_;
};

}  // namespace tribofit
