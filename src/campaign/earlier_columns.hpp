#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/campaign/pool.hpp"

namespace tribofit {

/// A quantity that the groups give a value for, in their unit.
struct KnownQuantity {
  std::string name, unit;
};

/// A column of a table of earlier values.
struct EarlierColumn {
  enum class Kind { radius, speed, load, other, law, protocol, value, std_error, none };
  Kind kind = Kind::none;
  std::string title;          ///< as the file gives it
  std::string name;           ///< of the quantity, or of a further condition
  std::string unit;           ///< of conditions; empty: in the cells
  std::string own_unit;       ///< of values: that of ours
  std::string law, protocol;  ///< said by the name of the column
  double factor = 1;          ///< from the unit of the column to ours
};

/// Columns of a table with a row a value.
struct LongColumns {
  std::size_t name = 0, value = 0;
  std::optional<std::size_t> unit, std_error;
};

/// The header of a table of earlier values, see read_earlier().
class EarlierColumns {
 public:
  EarlierColumns(std::string path, std::span<const PooledGroup> groups);

  /// Throws InputError with file, line and column.
  void read(const std::vector<std::string>& titles, std::size_t line);

  bool empty() const { return columns_.empty(); }
  std::size_t size() const { return columns_.size(); }
  const EarlierColumn& operator[](std::size_t k) const { return columns_.at(k); }
  bool is_long() const { return long_.has_value(); }
  const LongColumns& long_columns() const { return *long_; }
  /// Column of the standard error of the value in a column.
  std::optional<std::size_t> error_of(std::size_t value) const;
  /// Columns that are nothing a campaign knows.
  const std::vector<std::string>& notes() const { return notes_; }

  std::optional<KnownQuantity> find(std::string_view name) const;
  /// Factor from `unit` to that of the quantity. Throws InputError for an unknown unit, one of another quantity and
  /// none where there must be one.
  double factor_to(const KnownQuantity& quantity, const std::string& unit, std::size_t line,
                   const std::string& column) const;

 private:
  EarlierColumn column_of(const std::string& title, std::size_t line) const;
  std::optional<EarlierColumn> value_column(const std::string& title, std::size_t line) const;
  std::optional<EarlierColumn> condition_column(const std::string& title) const;
  void find_long();
  void check(std::size_t line);
  void note_unknown(const EarlierColumn& column);

  std::string path_;
  std::vector<KnownQuantity> known_;
  std::vector<std::string> laws_, others_;
  std::vector<EarlierColumn> columns_;
  std::optional<LongColumns> long_;
  std::vector<std::string> notes_;
};

}  // namespace tribofit
