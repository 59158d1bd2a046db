#include "stated_conditions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "limits.hpp"
#include "raw_table.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/digits.hpp"

namespace tribofit {
namespace {

bool has_unit(const ColumnName& name) {
  return name.unit && !name.unit->empty();
}

/// The unit in which the table gives its lengths, or its load; empty where it gives none or several.
std::string unit_in_table(const RawTable& table, const ConditionInfo& info) {
  std::set<std::string> units;
  for (const RawColumn& column : table.columns) {
    const Label label = label_of(column);
    const bool is_force = label.quantity == Quantity::force || label.quantity == Quantity::mass;
    const bool fits = info.quantity == Quantity::force ? is_force && name_rank(label.base, Channel::load) != no_rank
                                                       : label.quantity == info.quantity;
    if (fits) units.insert(label.unit);
  }
  return units.size() == 1 ? *units.begin() : std::string();
}

/// A mass stands for the force it weighs with: "g" is gram-force.
std::optional<double> value_of(const RawFact& fact, const ConditionInfo& info, const std::string& unit) {
  const auto value = value_of(fact, info.quantity, unit);
  if (value || info.quantity != Quantity::force) return value;
  const auto mass = value_of(fact, Quantity::mass, unit);
  return mass ? std::optional(*mass * standard_gravity) : std::nullopt;
}

void set(Conditions& conditions, const ConditionInfo& info, std::optional<double> value) {
  if (!value || (conditions.*info.member).known()) return;
  const double size = std::abs(*value);
  if (size > 0 && size < info.most) conditions.*info.member = {size, "file"};
}

std::string without_unit(const RawFact& fact, const ConditionInfo& info) {
  const std::string place = fact.line > 0 ? fmt::format(" in line {}", fact.line) : "";
  return fmt::format("'{}: {}'{} has no unit and was not used; state {}", fact.name, fact.value, place,
                     setting(info.name));
}

/// A condition that an instruments file may declare.
struct DeclaredCondition {
  Condition Conditions::*stated;
  std::optional<Declared> Instruments::Rig::*declared;
  const char* name;
};
constexpr DeclaredCondition kDeclared[] = {{&Conditions::radius, &Instruments::Rig::radius, "radius"},
                                           {&Conditions::speed, &Instruments::Rig::speed, "disc speed"},
                                           {&Conditions::load, &Instruments::Rig::load, "load"}};
constexpr const char* kSource = "instruments file";

}  // namespace

const ConditionInfo* find_condition(std::string_view base) {
  for (const ConditionInfo& info : condition_infos) {
    if (is_among(base, info.names)) return &info;
    for (const Channel channel : all_channels) {
      if (to_string(channel) == info.name && name_rank(base, channel) != no_rank) return &info;
    }
  }
  return nullptr;
}

bool is_bare_number(const std::string& text) {
  return text.find_first_not_of("+-.0123456789eE ") == std::string::npos;
}

double condition_in_cell(const std::string& text, const ConditionInfo& info, const std::string& column,
                         const std::string& unit) {
  const std::string_view example = example_of(info.quantity);
  if (is_bare_number(text) && unit.empty() && info.quantity != Quantity::force) {
    throw InputError(
        fmt::format("'{}' has no unit", text),
        fmt::format("write it as {}, or the unit in the header as '{} [{}]'", example, info.name, info.unit));
  }
  double value = 0;
  try {
    value = parse_quantity(text, info.quantity, column, unit);
  } catch (const InputError& error) {
    throw InputError(error.problem().substr(column.size() + 2), error.advice());  // without the name before it
  }
  const bool is_large = info.quantity == Quantity::length && value > info.most;
  if (value > 0 && !is_large) return value;
  throw InputError(fmt::format("'{}' {}", text,
                               is_large ? fmt::format("would be more than {} m", general(info.most))
                                        : std::string("is not greater than zero")),
                   fmt::format("give {} such as {}", with_article(to_string(info.quantity)), example));
}

StatedConditions conditions_in(std::span<const RawFact> facts, const RawTable& table) {
  StatedConditions result;
  std::optional<double> linear;
  const ConditionInfo& speed = condition_infos[1];
  for (const RawFact& fact : facts) {
    const ColumnName name = parse_column_name(fact.name);
    const ConditionInfo* info = name.base == "velocity" ? &speed : find_condition(name.base);
    if (info == nullptr || fact.value.find_first_of("0123456789") == std::string::npos) continue;
    const bool bare = is_bare_number(fact.value) && !has_unit(name);
    std::string unit;
    if (bare && info == &speed) {
      unit = names_rpm(name.base) ? "rpm" : "";
    } else if (bare) {
      unit = unit_in_table(table, *info);
    }
    if (bare && unit.empty()) {
      if (value_of(fact, Quantity::dimensionless, "").value_or(0) != 0)
        result.notes.push_back(without_unit(fact, *info));
      continue;
    }
    const auto value = value_of(fact, *info, unit);
    set(result.conditions, *info, value);
    if (info == &speed && !value && !linear) linear = value_of(fact, Quantity::velocity, unit);
  }
  const Condition& radius = result.conditions.radius;
  if (linear && radius.known()) set(result.conditions, speed, *linear / radius.value);
  return result;
}

ReadOptions with_declared_conditions(ReadOptions read, const Instruments& instruments) {
  for (const auto& [stated, declared, name] : kDeclared) {
    if (stated == &Conditions::radius && !read.step_radii.empty()) continue;
    const auto& value = instruments.rig.*declared;
    if (value && !(read.conditions.*stated).known()) read.conditions.*stated = {value->value, kSource};
  }
  return read;
}

std::vector<std::string> warnings_beside_declared(const Conditions& used, const Instruments& instruments,
                                                  bool rig_is_wanted) {
  std::vector<std::string> warnings;
  for (const auto& [stated, declared, name] : kDeclared) {
    const Condition& condition = used.*stated;
    const auto& value = instruments.rig.*declared;
    if (!value || !condition.known() || condition.source == kSource) continue;
    const double allowed = std::max(kConditionRounding * std::abs(value->value), kDeclaredWithin * value->uncertainty);
    if (std::abs(condition.value - value->value) <= allowed) continue;
    warnings.push_back(fmt::format("the {} from the {} ({} in SI units) is used, not that of the instruments file ({})",
                                   name, condition.source, general(condition.value, 4), general(value->value, 4)));
  }
  const auto only_for_rig = [&](const std::optional<Declared>& declared, const char* name) {
    if (declared && !rig_is_wanted)
      warnings.push_back(fmt::format("{} is declared in the instruments file; only `identify rig` uses it", name));
  };
  only_for_rig(instruments.rig.stiffness, "rig.stiffness");
  only_for_rig(instruments.rig.ping_frequency, "rig.ping_frequency");
  if (instruments.rig.pad_radius)
    warnings.emplace_back("rig.pad_radius is declared in the instruments file but nothing uses it yet");
  return warnings;
}

}  // namespace tribofit
