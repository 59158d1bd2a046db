#pragma once

#include <string>
#include <vector>

#include "json_parts.hpp"

namespace tribofit {

/// A cell of a CSV file; quoted where it must be, line breaks become blanks.
std::string cell(std::string text);

/// To the last digit; empty where it is not known.
std::string cell(double value);

/// The values of a JSON object or list in their order, as cells: lists and objects in it are laid out, what is null is
/// an empty cell, truth is 1 and 0. So a table has the numbers of the JSON, under the names of its header.
std::string cells(const Json& json);

/// Cells that stand already in their form, and a line break.
std::string csv_line(const std::vector<std::string>& cells);

}  // namespace tribofit
