#pragma once

#include <functional>
#include <optional>
#include <string>

#include "column_names.hpp"

namespace tribofit {

/// Whether a name says that it is the displacement of a load point: such a record is one of velocity steps or holds.
bool names_load_point(const std::string& column);

/// Whether the name of a velocity leaves open whether it is that of the contact or of the load point.
bool is_plain_velocity(const std::string& column);

/// The unit of a column as the file gives it.
std::optional<std::string> unit_in_file(const RawColumn& column);

/// Column whose name says that it is a displacement or a velocity, but not of what, among those that are free.
std::optional<std::size_t> find_plain_displacement(const RawTable& table,
                                                   const std::function<bool(std::size_t)>& is_free);
std::optional<std::size_t> find_plain_velocity(const RawTable& table, const std::function<bool(std::size_t)>& is_free);

/// Whether a column has a unit of length.
bool is_in_length(const RawColumn& column);
/// Whether a velocity is named plainly, and in a unit in which people measure creep: um/s or less.
bool may_be_of_load_point(const RawColumn& column);

}  // namespace tribofit
