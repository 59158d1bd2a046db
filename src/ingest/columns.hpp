#pragma once

#include <string>
#include <vector>

#include "raw_table.hpp"
#include "tribofit/ingest/read_trace.hpp"

namespace tribofit {

/// A column that holds a channel, and how its numbers become SI: factor * number + offset.
struct Column {
  Channel channel{};
  std::size_t index = 0;  ///< in RawTable::columns
  std::string name;       ///< as the file gives it, with its place
  std::string base;       ///< ColumnName::base
  Quantity quantity{};    ///< in which it is given: of a velocity, an angular one is to be multiplied by the radius
  double factor = 1, offset = 0;
  bool plain = false;      ///< a motion found by a name that does not say of what it is, or named by the user for x_d
  bool requested = false;  ///< named by the user
};

struct Columns {
  std::vector<Column> used;  ///< in the order of the file; a time column for each RawRows that has one
  std::vector<std::string> notes, warnings;

  const Column* find(Channel channel) const;
  /// Whether a channel is given in this quantity.
  bool has(Channel channel, Quantity quantity) const;
};

/// Which columns hold which channels: those the user names, then those whose names the field uses (COF, Ft, Fn, v_b,
/// rpm, ...). Of several descriptions of one quantity one is chosen: mu before force before torque, v_b before v_r;
/// a disc speed without a velocity means that the block is fixed.
/// Units come from the user, else the name, else what the file states apart from it; forces, times and temperatures
/// without a unit are taken in SI (noted), velocities are not guessed. Throws InputError for columns that do not exist,
/// unknown units and units of another kind.
Columns find_columns(const RawTable& table, const ReadOptions& options);

}  // namespace tribofit
