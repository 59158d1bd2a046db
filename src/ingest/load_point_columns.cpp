#include "load_point_columns.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "tribofit/ingest/units.hpp"

namespace tribofit {

namespace {

constexpr std::array<std::string_view, 13> kPlainDisplacements = {
    "displacement",      "disp",  "displ",        "sheardisplacement", "sheardisp", "sheardispl", "axialdisplacement",
    "totaldisplacement", "vdcdt", "verschiebung", "scherweg",          "position",  "x"};
constexpr std::array<std::string_view, 9> kPlainVelocities = {
    "speed", "velocity", "v", "slidingvelocity", "slidingspeed", "shearvelocity", "slipvelocity", "sliprate", "rate"};

std::optional<std::size_t> find_named(const RawTable& table, std::span<const std::string_view> names,
                                      const std::function<bool(std::size_t)>& is_free) {
  for (const std::string_view name : names) {
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const RawColumn& column = table.columns[i];
      if (column.named && is_free(i) && parse_column_name(column.name).base == name) return i;
    }
  }
  return std::nullopt;
}

}  // namespace

bool names_load_point(const std::string& column) {
  const std::string base = parse_column_name(column).base;
  return base.starts_with("lp") || base.find("loadpoint") != std::string::npos || base == "xlp";
}

bool is_plain_velocity(const std::string& column) {
  return std::find(kPlainVelocities.begin(), kPlainVelocities.end(), parse_column_name(column).base) !=
         kPlainVelocities.end();
}

std::optional<std::string> unit_in_file(const RawColumn& column) {
  const auto in_name = parse_column_name(column.name).unit;
  if (in_name && !in_name->empty()) return in_name;
  const bool has_none = column.unit.empty() || column.unit == ".";  // xlook writes a dot for a number without a unit
  return has_none ? in_name : column.unit;
}

std::optional<std::size_t> find_plain_displacement(const RawTable& table,
                                                   const std::function<bool(std::size_t)>& is_free) {
  return find_named(table, kPlainDisplacements, is_free);
}

std::optional<std::size_t> find_plain_velocity(const RawTable& table, const std::function<bool(std::size_t)>& is_free) {
  return find_named(table, kPlainVelocities, is_free);
}

bool is_in_length(const RawColumn& column) {
  return find_unit(unit_in_file(column).value_or(""), Quantity::length).has_value();
}

bool may_be_of_load_point(const RawColumn& column) {
  constexpr double kMicro = 1e-6;
  if (!is_plain_velocity(column.name)) return false;
  const auto unit = find_unit(unit_in_file(column).value_or(""), Quantity::velocity);
  return unit && unit->factor <= kMicro * (1 + 1e-9);
}

}  // namespace tribofit
