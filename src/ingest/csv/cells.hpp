#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tribofit {

/// The separator of columns that are divided by one or more blanks or tabs.
inline constexpr char blanks = ' ';

/// The cells of a line: quotes taken off, white space trimmed.
std::vector<std::string> split_cells(std::string_view line, char separator);

/// The number that the whole cell is, exactly rounded; nan and inf are, and a decimal point is understood in any file.
std::optional<double> number_in(std::string_view cell, char decimal);
/// Whether it is one with this decimal mark.
bool is_number(std::string_view cell, char decimal);

/// The time of a logger that writes a clock: "12:04:59.250", with a date before it or not ("2024-05-03T12:04:59,25",
/// "03.05.2024 12:04:59"), in seconds since the beginning of the year 2020, or of the day. Doubles hold it to 0.1 us.
/// Nothing for any other text: days and months in American or English order cannot be told apart.
std::optional<double> clock_time(std::string_view cell);

}  // namespace tribofit
