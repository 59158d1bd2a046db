#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "raw_table.hpp"
#include "tribofit/ingest/channels.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// What to do where the columns of a file are not known, for messages.
std::string lists_columns(const std::string& path);

/// A column that holds a channel, and how its numbers become SI: factor * number + offset.
struct Column {
  Channel channel{};
  std::size_t index = 0;        ///< in RawTable::columns
  std::string name;             ///< as the file gives it, with its place
  std::string plain_name = {};  ///< without its place
  double factor = 1, offset = 0;
  bool angular = false;    ///< a velocity given as a rotational speed [rad/s], to be multiplied by the radius
  bool over_load = false;  ///< the pull of a spring, given over the load
  bool stress = false;     ///< a force given over an area [Pa]
  bool plain = false;      ///< a motion found by a name that does not say of what it is, or named by the user for x_d
  bool requested = false;  ///< named by the user
};

struct Columns {
  std::vector<Column> used;  ///< in the order of the file; a time column for each RawRows that has one
  std::vector<std::string> notes, warnings;

  const Column* find(Channel channel) const;
};

/// Which columns hold which channels: those the user names, then those whose names the field uses (COF, Ft, Fn, v_b,
/// rpm, ...). Of several descriptions of one quantity one is chosen: mu before force before torque, v_b before v_r;
/// a disc speed without a velocity means that the block is fixed.
/// Units come from the user, else the name, else what the file states apart from it; forces, times and temperatures
/// without a unit are taken in SI (noted), velocities are not guessed. Throws InputError for columns that do not exist,
/// unknown units and units of another kind.
Columns find_columns(const RawTable& table, const ReadOptions& options);

/// A column's name taken apart: "DAQ.Fx (N)" is {"fx", "N"}, "v_b_mm_s" is {"vb", "mm/s"}.
struct ColumnName {
  std::string base;                 ///< lower case, without separators and what stands before a dot
  std::optional<std::string> unit;  ///< as written; absent when the name has none
};
ColumnName parse_column_name(std::string_view name);

/// Index of the column that a user names for a channel, by its name or as "#3". Throws InputError where there is none.
std::size_t named_column(const RawTable& table, const std::string& wanted, Channel channel);

}  // namespace tribofit
