#pragma once

#include <vector>

#include "rows.hpp"

namespace tribofit {

/// Steps that lines of text between the rows set apart ("Step 2 started at ...", "Radius = 3.9", a repeated header),
/// each with the conditions its own lines state. None where no lines do.
/// Throws InputError where such lines name other columns than those above.
std::vector<RawStep> find_steps(const Dialect& dialect, const Rows& rows, const RawTable& table);

/// Counts the lines of text that head no step and end no file.
std::size_t stray_text(const std::vector<RawStep>& steps, const Rows& rows);

}  // namespace tribofit
