#include "stated_conditions.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>

#include "column_names.hpp"
#include "limits.hpp"
#include "manifest_roles.hpp"
#include "tribofit/ingest/spelling.hpp"

namespace tribofit {
namespace {

std::string unit_of(const RawColumn& column) {
  const auto in_name = parse_column_name(column.name).unit;
  return in_name && !in_name->empty() ? *in_name : column.unit;
}

/// The unit in which the table gives its lengths, or its load; empty where it gives none or several.
std::string unit_in_table(const RawTable& table, Role role) {
  std::set<std::string> units;
  for (const RawColumn& column : table.columns) {
    const std::string text = unit_of(column);
    const auto unit = text.empty() ? std::nullopt : find_unit(text);
    if (!unit) continue;
    const bool is_length = unit->quantity == Quantity::length;
    const bool is_force = unit->quantity == Quantity::force || unit->quantity == Quantity::mass;
    const bool is_load = is_force && name_rank(parse_column_name(column.name).base, Channel::load, {}) != no_rank;
    if (role == Role::radius ? is_length : is_load) units.insert(text);
  }
  return units.size() == 1 ? *units.begin() : std::string();
}

/// Masses stand for the forces they weigh with: "g" is gram-force.
std::optional<double> force_of(const RawFact& fact, const std::string& unit) {
  if (const auto force = value_of(fact, Quantity::force, unit)) return force;
  const auto mass = value_of(fact, Quantity::mass, unit);
  return mass ? std::optional(*mass * standard_gravity) : std::nullopt;
}

class Taker {
 public:
  explicit Taker(const RawTable& table) : table_(table) {}

  void take(const RawFact& fact) {
    const ColumnName name = parse_column_name(fact.name);
    if (fact.value.find_first_of("0123456789") == std::string::npos) return;
    const Role role = name.base == "velocity" ? Role::speed : role_of(name);
    if (role != Role::radius && role != Role::speed && role != Role::load) return;
    const bool bare = is_bare_number(fact.value) && !(name.unit && !name.unit->empty());
    const std::string unit = !bare                                         ? ""
                             : role == Role::speed && names_rpm(name.base) ? "rpm"
                             : role == Role::speed                         ? ""
                                                                           : unit_in_table(table_, role);
    if (bare && unit.empty()) {
      note_without_unit(fact, role);
      return;
    }
    if (role == Role::radius) set(result_.conditions.radius, value_of(fact, Quantity::length, unit), kLargestRadius);
    if (role == Role::load) set(result_.conditions.load, force_of(fact, unit), kLargestLoad);
    if (role != Role::speed) return;
    const auto angular = value_of(fact, Quantity::angular_velocity, unit);
    set(result_.conditions.speed, angular, kLargestSpeed);
    if (!angular && !linear_) linear_ = value_of(fact, Quantity::velocity, unit);
  }

  StatedConditions result() {
    const Condition& radius = result_.conditions.radius;
    if (linear_ && radius.known()) set(result_.conditions.speed, *linear_ / radius.value, kLargestSpeed);
    return std::move(result_);
  }

 private:
  static void set(Condition& condition, std::optional<double> value, double most) {
    if (!value || condition.known()) return;
    const double size = std::abs(*value);
    if (size > 0 && size < most) condition = {size, "file"};
  }

  void note_without_unit(const RawFact& fact, Role role) {
    const double number = value_of(fact, Quantity::dimensionless, "").value_or(0);
    if (number == 0) return;
    const char* option = role == Role::radius ? "--radius" : role == Role::speed ? "--speed" : "--load";
    const std::string place = fact.line > 0 ? fmt::format(" in line {}", fact.line) : "";
    result_.notes.push_back(
        fmt::format("'{}: {}'{} has no unit and was not used; state {}", fact.name, fact.value, place, option));
  }

  const RawTable& table_;
  StatedConditions result_;
  std::optional<double> linear_;
};

}  // namespace

StatedConditions stated_conditions(std::span<const RawFact> facts, const RawTable& table) {
  Taker taker(table);
  for (const RawFact& fact : facts) taker.take(fact);
  return taker.result();
}

}  // namespace tribofit
