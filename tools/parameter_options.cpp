#include <algorithm>
#include <cmath>
#include <string>

#include "exit_status.hpp"
#include "settings.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/output/text.hpp"
#include "tribofit/workbench/session.hpp"
#include "typed_values.hpp"

using namespace tribofit;

namespace {

using Slot = FrictionModel::Slot;

std::vector<Slot> slots_of(const std::vector<Law>& laws, const std::vector<Effect>& effects) {
  std::vector<Slot> slots;
  for (const Law& law : laws) {
    const FrictionModel model(law, effects);
    for (const Slot& slot : model.parameters()) {
      const bool known = std::any_of(slots.begin(), slots.end(),
                                     [&](const Slot& other) { return other.full_name() == slot.full_name(); });
      if (!known) slots.push_back(slot);
    }
  }
  return slots;
}

const Slot& slot_named(const std::string& name, const std::vector<Slot>& slots, const std::string& option) {
  std::vector<std::string> names;
  for (const Slot& slot : slots) {
    if (slot.full_name() == name) return slot;
    names.push_back(slot.full_name());
  }
  throw UsageError(option + ": the laws fitted here have no parameter '" + name + "'; did you mean '" +
                   nearest_name(name, names) + "'? They have " + listed(names));
}

/// Of a fit: where friction is in newtons, so is a parameter that has no unit elsewhere.
double slot_value(const std::string& text, const Slot& slot, const std::string& option) {
  const bool in_newtons = slot.parameter.unit == "1" && unit_of(text) == "N";
  return as_usage([&] {
    return parameter_value(in_newtons ? text.substr(0, text.find('N')) : text, slot.parameter,
                           option + ": " + slot.full_name());
  });
}

}  // namespace

double parameter_value(const std::string& text, const Parameter& parameter, const std::string& option) {
  const Unit unit = find_unit(parameter.unit).value_or(Unit{});
  return stated_value(text, unit.quantity, option, parameter.unit == "1" ? "" : parameter.unit);
}

Effect effect_named(const std::string& name) {
  return as_usage([&] { return make_effect(name); });
}

Law law_named(const std::string& name) {
  return as_usage([&] { return make_law(name); });
}

std::string list_of_laws() {
  return enumerated(law_keys(), "or");
}

void refuse_clashes(const std::vector<Effect>& effects, const std::vector<Law>& laws) {
  as_usage([&] {
    for (const Law& law : laws) FrictionModel(law, effects);
  });
}

GivenParameter& given_entry(const std::string& name, std::vector<GivenParameter>& given) {
  const auto found = std::find_if(given.begin(), given.end(), [&](const auto& g) { return g.name == name; });
  if (found != given.end()) return *found;
  given.push_back({name, std::nullopt, std::nullopt});
  return given.back();
}

std::vector<GivenParameter> given_from(const Settings& s, const std::vector<Law>& laws,
                                       const std::vector<Effect>& effects) {
  std::vector<GivenParameter> given;
  const std::vector<Slot> slots = slots_of(laws, effects);
  // Those of velocity steps are read by driven_options.cpp; the file may yet show that it is a record of them.
  const auto of_state = [&](const std::string& name) {
    return is_rate_state_parameter(s, name) && std::none_of(slots.begin(), slots.end(), [&](const Slot& slot) {
             return slot.parameter.name == name || slot.full_name() == name;
           });
  };
  for (const auto& [name, text] : named_texts(s.start_values, "--start", kStartExample)) {
    if (of_state(name)) continue;
    given_entry(name, given).start = slot_value(text, slot_named(name, slots, "--start"), "--start");
  }
  for (const auto& [name, text] : named_texts(s.bounds, "--bounds", kBoundsExample)) {
    if (of_state(name)) continue;
    const Slot& slot = slot_named(name, slots, "--bounds");
    const auto [low, high] =
        as_usage([&, &typed = text] { return range_ends(typed, "--bounds", "alpha=0.01..0.2s/mm"); });
    const GivenParameter::Bounds bounds = {slot_value(low, slot, "--bounds"), slot_value(high, slot, "--bounds")};
    if (bounds.lower > bounds.upper) throw UsageError("--bounds: '" + text + "' of " + name + " runs from high to low");
    given_entry(name, given).bounds = bounds;
  }
  if (const std::string why = contradiction_in(given); !why.empty()) throw UsageError("--start and --bounds: " + why);
  return given;
}

Selection::Cycles cycles_from(const std::string& text) {
  const auto [first, last] = as_usage([&] { return range_ends(text, "--cycles", "3..40"); });
  const auto number = [&](std::string_view spelled) {
    constexpr std::size_t kMostDigits = 9;
    const std::string end(trimmed(spelled));
    if (end.empty() || end.size() > kMostDigits || end.find_first_not_of("0123456789") != std::string::npos)
      throw UsageError("--cycles: '" + text + "' is not FIRST..LAST, two numbers of cycles as in cycles.csv (from 0)");
    return static_cast<std::size_t>(std::stoul(end));
  };
  const Selection::Cycles cycles = {number(first), number(last)};
  if (cycles.first > cycles.last) number("");
  return cycles;
}

Selection::Stretch stretch_from(const std::string& text) {
  const auto stretch = as_usage([&] {
    const auto [from, to] = range_ends(text, "--exclude", "2.5s..3.1s");
    return Selection::Stretch{stated_value(from, Quantity::time, "--exclude", "s"),
                              stated_value(to, Quantity::time, "--exclude", "s")};
  });
  if (stretch.from < stretch.to) return stretch;
  throw UsageError("--exclude: '" + text + "' does not run from an earlier to a later time");
}
