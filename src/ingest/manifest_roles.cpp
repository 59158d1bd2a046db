#include "manifest_roles.hpp"

#include <fmt/format.h>

#include <optional>
#include <string_view>

#include "column_names.hpp"
#include "limits.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {

Role role_of(const ColumnName& name) {
  if (is_one_of(name.base, {"file", "filename", "trace", "path", "datei"})) return Role::file;
  if (is_one_of(name.base, {"radius", "r", "frictionradius", "reibradius", "trackradius", "weartrackradius",
                            "disctrackradiususedforthisstep"}))
    return Role::radius;
  if (is_one_of(name.base, {"repeat", "repetition", "replicate", "rep", "wiederholung"})) return Role::repeat;
  if (name_rank(name.base, Channel::speed, std::nullopt) != no_rank) return Role::speed;
  if (name_rank(name.base, Channel::load, std::nullopt) != no_rank) return Role::load;
  if (is_one_of(name.base, {"setforce", "setload", "appliedload", "appliedforce", "testload"})) return Role::load;
  return Role::other;
}

bool is_bare_number(const std::string& text) {
  return text.find_first_not_of("+-.0123456789eE ") == std::string::npos;
}

double condition_in_cell(const std::string& text, Role role, const std::string& column, const std::string& unit) {
  const Quantity quantity = quantity_of(role);
  if (is_bare_number(text) && unit.empty() && role != Role::load) {
    throw InputError(fmt::format("'{}' has no unit", text),
                     fmt::format("write it as {}, or the unit in the header as '{}'", example_of(quantity),
                                 role == Role::radius ? "radius [mm]" : "speed [rpm]"));
  }
  double value = 0;
  try {
    value = parse_quantity(text, quantity, column, unit);
  } catch (const InputError& error) {
    throw InputError(error.problem().substr(column.size() + 2), error.advice());  // without the name before it
  }
  if (!(value > 0) || (role == Role::radius && value > kLargestRadius)) {
    throw InputError(fmt::format("'{}' {}", text,
                                 value > 0 ? fmt::format("would be more than {} m", general(kLargestRadius))
                                           : std::string("is not greater than zero")),
                     fmt::format("give {} such as {}", with_article(to_string(quantity)), example_of(quantity)));
  }
  return value;
}

Quantity quantity_of(Role role) {
  if (role == Role::radius) return Quantity::length;
  return role == Role::speed ? Quantity::angular_velocity : Quantity::force;
}

}  // namespace tribofit
