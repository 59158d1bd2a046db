#pragma once

#include <optional>
#include <string_view>

namespace tribofit {

/// The time of a logger that writes a clock: "12:04:59.250", with a date before it or not ("2024-05-03T12:04:59,25",
/// "03.05.2024 12:04:59"), in seconds since the beginning of the year 2020, or of the day. Doubles hold it to 0.1 us.
/// Nothing for any other text: days and months in American or English order cannot be told apart.
std::optional<double> clock_time(std::string_view cell);

}  // namespace tribofit
