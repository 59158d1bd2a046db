#pragma once

#include "columns.hpp"
#include "tribofit/ingest/units.hpp"

namespace tribofit {

/// What a column of a manifest, or a line above the table of a trace, says of a run.
enum class Role { file, radius, speed, load, repeat, other };

Role role_of(const ColumnName& name);

/// Of radius, speed and load.
Quantity quantity_of(Role role);

}  // namespace tribofit
