#include "manifest_roles.hpp"

#include <algorithm>
#include <initializer_list>
#include <optional>
#include <string_view>

#include "column_names.hpp"

namespace tribofit {
namespace {

bool is_one_of(std::string_view name, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

Role role_of(const ColumnName& name) {
  if (is_one_of(name.base, {"file", "filename", "trace", "path", "datei"})) return Role::file;
  if (is_one_of(name.base, {"radius", "r", "frictionradius", "reibradius"})) return Role::radius;
  if (is_one_of(name.base, {"repeat", "repetition", "replicate", "rep", "wiederholung"})) return Role::repeat;
  if (name_rank(name.base, Channel::speed, std::nullopt) != no_rank) return Role::speed;
  if (name_rank(name.base, Channel::load, std::nullopt) != no_rank) return Role::load;
  return Role::other;
}

Quantity quantity_of(Role role) {
  if (role == Role::radius) return Quantity::length;
  return role == Role::speed ? Quantity::angular_velocity : Quantity::force;
}

}  // namespace tribofit
