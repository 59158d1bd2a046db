#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

/// Which line of the file a row came from: rows follow one another line by line except after dropped lines.
class LineMap {
 public:
  /// Row `row` (and those after it, one line each) came from `line`. Rows must not decrease.
  void set(std::size_t row, std::size_t line);
  /// The line of a row, from 1; 0 where nothing was set, as in a file without lines.
  std::size_t line_of(std::size_t row) const;

 private:
  std::vector<std::pair<std::size_t, std::size_t>> starts_;
};

/// What a file states beside its columns: a line of a preamble, a scalar variable, a property of a channel.
struct RawFact {
  std::string name;      ///< as the file gives it; may hold a unit ("Radius [mm]")
  std::string value;     ///< as written ("15", "20 kHz"); may hold a unit
  std::size_t line = 0;  ///< 0: the file has no lines
};

/// The value of a fact in SI: its unit stands in the value, else in the name, else it is `bare_unit`. Nothing when the
/// value is not a number of this quantity.
std::optional<double> value_of(const RawFact& fact, Quantity quantity, std::string_view bare_unit);

/// A stretch of rows which the file itself sets apart (a step of a recipe), with the conditions stated for it.
struct RawStep {
  std::size_t begin = 0;  ///< its first row; it ends where the next one begins
  std::string label;
  Conditions conditions;  ///< in SI, source "file"; what the file does not state is not known
};

/// Rows that were recorded together: every column that refers to them has one value in each.
struct RawRows {
  LineMap lines;                   ///< empty where the file has no lines
  std::optional<double> interval;  ///< [s] between rows, where the file states it and no column holds the time
  double start = 0;                ///< [s] of the first row on the clock of the file, beside `interval`
  std::vector<RawStep> steps;      ///< in their order, the first from row 0; empty: the file divides nothing
};

/// A named column of numbers or text.
struct RawColumn {
  std::string name;                   ///< as the file gives it; "#3" where it gives none
  bool named = true;                  ///< the file gives the name
  std::string unit;                   ///< stated apart from the name, without brackets; empty: none
  std::string place;                  ///< where it stands, if the name does not say: "block 3", "group Vibrometer"
  std::size_t line = 0;               ///< that names it; 0: none does
  std::size_t unit_line = 0;          ///< that states its unit
  std::size_t rows = 0;               ///< which of RawTable::rows
  std::size_t count = 0;              ///< of its values, where that is known before they are loaded
  bool is_text = false;               ///< holds text, as far as is known before its values are loaded
  std::vector<double> numbers;        ///< as written, not yet in SI
  std::optional<InputError> refusal;  ///< why its values cannot be read, where `load` could not

  std::string shown_name() const { return place.empty() ? name : name + " of " + place; }
};

/// A cell that is not a number of a usable size, whose value is NaN, or a line that is no row.
struct RawDefect {
  std::size_t row = 0;  ///< or the line
  std::string problem, advice;
  std::string column;  ///< its name; empty: all
};

/// What a file holds, before anything is known of what it means: readers make it (reader.hpp); channels, units, clocks,
/// steps, continued files and joins work on it.
///
/// Columns recorded together share rows; a file of several blocks, or of channels with rates of their own, has several
/// RawRows, whose clocks agree. Values may be loaded later: `load` fills the columns it is asked for, by index.
struct RawTable {
  std::string path;
  std::string format;              ///< of the reader that made it
  std::vector<RawColumn> columns;  ///< in the order of the file
  std::vector<RawRows> rows = std::vector<RawRows>(1);
  std::vector<RawFact> facts;
  std::optional<RawDefect> first_gap;  ///< the first cell without a number, where the reader can say what it holds
  std::vector<std::string> notes, warnings;

  /// Reads the values of these columns, each once and in the order of the table; a column that cannot be read gets its
  /// `refusal`, and the others their values. Throws InputError where no column can.
  using Load = std::function<void(RawTable& table, std::span<const std::size_t> columns, int threads)>;
  Load load;  ///< empty: the values are there

  bool has_names() const;
  std::vector<std::string> names() const;
  /// Where a column is named, and where the first one is, for messages.
  InputLocation heading(std::size_t column) const;
  InputLocation heading() const { return {path, columns.empty() ? 0 : columns.front().line, ""}; }
};

// ---- what names say

/// [m/s^2], by which kilograms become the newtons that they weigh with.
inline constexpr double standard_gravity = 9.80665;

constexpr std::size_t no_rank = std::string_view::npos;

/// A column's name taken apart: "DAQ.Fx (N)" is {"fx", "N"}, "v_b_mm_s" is {"vb", "mm/s"}.
struct ColumnName {
  std::string base;                 ///< lower case, without separators and what stands before a dot
  std::optional<std::string> unit;  ///< as written; absent when the name has none
};
ColumnName parse_column_name(std::string_view name);

/// What the heading of a column says.
struct Label {
  std::string base;                  ///< of its name
  std::string unit;                  ///< in its name, else beside it
  std::optional<Quantity> quantity;  ///< of a unit that is known; an angular velocity where it may be one
};
Label label_of(const RawColumn& column);

/// How usual `base` (ColumnName::base) is as a name of `channel`: 0 is the most usual; no_rank: it does not name that
/// channel. `quantity` is that of the column's unit, where it has one: "Velocity (rpm)" is the disc's, not the block's.
std::size_t name_rank(std::string_view base, Channel channel, std::optional<Quantity> quantity = std::nullopt);

/// Whether `base` is a name of any channel.
bool is_field_name(std::string_view base);

/// Whether the name itself says that the numbers are revolutions per minute.
bool names_rpm(std::string_view base);

/// Whether the name says that it is the displacement of a load point: such a record is one of velocity steps or holds.
bool names_load_point(std::string_view base);

/// What to do where the columns of a file are not known, for messages.
std::string lists_columns(const std::string& path);

/// Index of the column that a user names for a channel: as it is called in the file, by a name that is much the same,
/// or as "#3". Throws InputError where there is none.
std::size_t named_column(const RawTable& table, const std::string& wanted, Channel channel);

/// SI value per volt of a sensitivity: "5 mm/s/V", "20 N/V", "0.2 V/(mm/s)", "3.9 mV/N"; nothing when `text` does not
/// state one. Throws InputError where it is a sensitivity of something else.
std::optional<double> find_sensitivity(std::string_view text, Channel channel);

/// "[mm/s]" or "(mm/s)" without the brackets.
std::string strip_brackets(std::string_view text);

}  // namespace tribofit
