#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "columns.hpp"

namespace tribofit {

/// [m/s^2], by which kilograms become the newtons that they weigh with.
inline constexpr double standard_gravity = 9.80665;

constexpr std::size_t no_rank = std::numeric_limits<std::size_t>::max();

/// How usual `base` (ColumnName::base) is as a name of `channel`: 0 is the most usual; no_rank: it does not name that
/// channel. `quantity` is that of the column's unit, where it has one: "Velocity (rpm)" is the disc's, not the block's.
std::size_t name_rank(std::string_view base, Channel channel, std::optional<Quantity> quantity);

/// Whether `base` is a name of any channel.
bool is_field_name(std::string_view base);

/// Whether the name itself says that the numbers are revolutions per minute.
bool names_rpm(std::string_view base);

/// SI value per volt of a sensitivity: "5 mm/s/V", "20 N/V", "0.2 V/(mm/s)", "3.9 mV/N"; nothing when `text` does not
/// state one. Throws InputError where it is a sensitivity of something else.
std::optional<double> find_sensitivity(std::string_view text, Channel channel);

/// "[mm/s]" or "(mm/s)" without the brackets.
std::string strip_brackets(std::string_view text);

}  // namespace tribofit
