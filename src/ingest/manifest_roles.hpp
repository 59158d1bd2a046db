#pragma once

#include <string>

#include "columns.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

/// What a column of a manifest, or a line above the table of a trace, says of a run.
enum class Role { file, radius, speed, load, repeat, other };

Role role_of(const ColumnName& name);

/// Of radius, speed and load.
Quantity quantity_of(Role role);

/// A radius, speed or load [SI] as a cell states it: with a unit of its own ("15mm"), else in that of its column. A
/// bare load is in N. Throws InputError, without a place, for what is not a number, has no unit or a wrong one, and for
/// a value that cannot be.
double condition_in_cell(const std::string& text, Role role, const std::string& column, const std::string& unit);

/// Whether the cell is a number without a unit.
bool is_bare_number(const std::string& text);

}  // namespace tribofit
