#include "parameter_options.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "driven_options.hpp"
#include "exit_status.hpp"
#include "tribofit/ingest/input_error.hpp"
#include "tribofit/ingest/nearest_name.hpp"
#include "tribofit/ingest/spelling.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/workbench/session.hpp"

using namespace tribofit;

namespace {

using Slot = FrictionModel::Slot;

[[noreturn]] void refuse(const std::string& problem) {
  throw UsageError(problem);
}

/// A number with what follows it.
struct Number {
  double value = 0;
  std::string unit;
};

Number number_from(const std::string& with_spaces, const std::string& option) {
  const std::string text(trimmed(with_spaces));
  Number out;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out.value);
  if (error != std::errc{} || !std::isfinite(out.value))
    refuse(option + ": '" + text + "' does not begin with a number");
  out.unit = trimmed(std::string_view(end, static_cast<std::size_t>(text.data() + text.size() - end)));
  return out;
}

/// Both ends of "LOW..HIGH"; the unit behind the last holds for both where the first has none.
std::pair<Number, Number> range_from(const std::string& text, const std::string& option, const char* example) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos) refuse(option + ": '" + text + "' is not FROM..TO, as in " + example);
  std::pair<Number, Number> ends = {number_from(text.substr(0, dots), option),
                                    number_from(text.substr(dots + 2), option)};
  if (ends.first.unit.empty()) ends.first.unit = ends.second.unit;
  return ends;
}

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
  std::string list;
  for (const Slot& slot : slots) {
    if (slot.full_name() == name) return slot;
    names.push_back(slot.full_name());
    list += (list.empty() ? "" : ", ") + names.back();
  }
  refuse(option + ": the laws fitted here have no parameter '" + name + "'; did you mean '" +
         nearest_name(name, names) + "'? They have " + list);
}

/// In SI. A bare number is in the unit in which the parameter is shown.
double si_from(const Number& number, const Slot& slot, const std::string& option) {
  const Parameter& p = slot.parameter;
  const auto shown = find_unit(p.unit), given = find_unit(number.unit);
  if (number.unit.empty() || number.unit == p.unit || (p.unit == "1" && number.unit == "N")) return number.value * p.si;
  if (given && shown && given->quantity == shown->quantity) return number.value * given->factor / shown->factor * p.si;
  refuse(option + ": '" + number.unit + "' is not a unit of " + slot.full_name() + ", which is in " +
         (p.unit == "1" ? "no unit" : p.unit));
}

/// "NAME=VALUE,NAME=VALUE"
std::vector<std::pair<std::string, std::string>> pairs_from(const std::vector<std::string>& texts,
                                                            const std::string& option, const char* example) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& text : texts) {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::string part(trimmed(text.substr(begin, end - begin)));
      const std::size_t equals = part.find('=');
      if (equals == std::string::npos || equals == 0 || equals + 1 == part.size()) {
        refuse(option + ": '" + part + "' is not " + example);
      }
      const std::string name(trimmed(part.substr(0, equals)));
      if (std::any_of(pairs.begin(), pairs.end(), [&](const auto& p) { return p.first == name; })) {
        refuse(option + ": '" + name + "' is given twice");
      }
      pairs.emplace_back(name, std::string(trimmed(part.substr(equals + 1))));
      begin = end + 1;
    }
  }
  return pairs;
}

GivenParameter& entry_of(const std::string& name, std::vector<GivenParameter>& given) {
  const auto found = std::find_if(given.begin(), given.end(), [&](const auto& g) { return g.name == name; });
  if (found != given.end()) return *found;
  given.push_back({name, std::nullopt, std::nullopt});
  return given.back();
}

}  // namespace

Effect effect_named(const std::string& name) {
  try {
    return make_effect(name);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}

std::string list_of_laws() {
  std::string list;
  const std::vector<std::string> keys = law_keys();
  for (const std::string& key : keys) list += (list.empty() ? "" : key == keys.back() ? " or " : ", ") + key;
  return list;
}

void refuse_clashes(const std::vector<Effect>& effects, const std::vector<Law>& laws) {
  try {
    for (const Law& law : laws) FrictionModel(law, effects);
  } catch (const InputError& error) {
    throw UsageError(error.what());
  }
}

std::vector<GivenParameter> given_from(const Settings& s, const std::vector<Law>& laws,
                                       const std::vector<Effect>& effects) {
  std::vector<GivenParameter> given;
  if (s.start_values.empty() && s.bounds.empty()) return given;
  const std::vector<Slot> slots = slots_of(laws, effects);
  // Those of velocity steps are read by driven_options.cpp; the file may yet show that it is a record of them.
  const auto of_state = [&](const std::string& name) {
    return is_rate_state_parameter(s, name) && std::none_of(slots.begin(), slots.end(), [&](const Slot& slot) {
             return slot.parameter.name == name || slot.full_name() == name;
           });
  };
  for (const auto& [name, text] : pairs_from(s.start_values, "--start", "NAME=VALUE, as in alpha=0.05s/mm")) {
    if (of_state(name)) continue;
    const Slot& slot = slot_named(name, slots, "--start");
    entry_of(name, given).start = si_from(number_from(text, "--start"), slot, "--start");
  }
  for (const auto& [name, text] : pairs_from(s.bounds, "--bounds", "NAME=FROM..TO, as in alpha=0.01..0.2s/mm")) {
    if (of_state(name)) continue;
    const Slot& slot = slot_named(name, slots, "--bounds");
    const auto [low, high] = range_from(text, "--bounds", "alpha=0.01..0.2s/mm");
    const GivenParameter::Bounds bounds = {si_from(low, slot, "--bounds"), si_from(high, slot, "--bounds")};
    if (bounds.lower > bounds.upper) refuse("--bounds: '" + text + "' of " + name + " runs from high to low");
    entry_of(name, given).bounds = bounds;
  }
  if (const std::string why = contradiction_in(given); !why.empty()) refuse("--start and --bounds: " + why);
  return given;
}

Selection selection_from(const Settings& s) {
  Selection selection;
  if (!s.cycles.empty()) {
    const auto [first, last] = range_from(s.cycles, "--cycles", "3..40");
    const auto whole = [](const Number& n) { return n.unit.empty() && n.value >= 0 && n.value == std::floor(n.value); };
    constexpr double kMost = 1e9;
    if (!whole(first) || !whole(last) || first.value > last.value || last.value > kMost) {
      refuse("--cycles: '" + s.cycles + "' is not FIRST..LAST, two numbers of cycles as in cycles.csv (from 0)");
    }
    selection.cycles = {static_cast<std::size_t>(first.value), static_cast<std::size_t>(last.value)};
  }
  for (const std::string& text : s.excluded) {
    const auto [from, to] = range_from(text, "--exclude", "2.5s..3.1s");
    const auto seconds = [&](const Number& n) {
      const auto unit =
          n.unit.empty() ? Unit{Quantity::time, 1, 0} : find_unit(n.unit, Quantity::time).value_or(Unit{});
      if (unit.quantity != Quantity::time) refuse("--exclude: '" + n.unit + "' is not a unit of time");
      return n.value * unit.factor;
    };
    selection.excluded.push_back({seconds(from), seconds(to)});
    if (!(selection.excluded.back().from < selection.excluded.back().to)) {
      refuse("--exclude: '" + text + "' does not run from an earlier to a later time");
    }
  }
  return selection;
}
