#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "raw_table.hpp"
#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {

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
