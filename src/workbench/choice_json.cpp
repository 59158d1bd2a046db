#include "session_json.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tribofit/ingest/input_error.hpp"
#include "tribofit/output/text.hpp"

namespace tribofit::workbench {

namespace {

constexpr int kDeepest = 8;
constexpr std::size_t kMostEffects = 16, kMostStretches = 200, kLongestFormula = 2000;

[[noreturn]] void refuse(const std::string& problem, const std::string& advice) {
  throw InputError(problem, advice);
}

double finite(const Json& json, const std::string& what) {
  if (!json.is_number() || !std::isfinite(json.get<double>())) refuse(what + " is not a number", "give a number");
  return json.get<double>();
}

std::pair<double, double> range(const Json& json, const std::string& what) {
  if (!json.is_array() || json.size() != 2)
    refuse(what + " is not a pair of numbers", "give the lower and the upper end");
  const std::pair<double, double> out = {finite(json[0], what), finite(json[1], what)};
  if (out.first > out.second) refuse(what + " runs from high to low", "give the lower end first");
  return out;
}

std::vector<std::string> texts(const Json& json, const char* key, std::size_t most) {
  std::vector<std::string> out;
  if (!json.contains(key)) return out;
  if (!json[key].is_array() || json[key].size() > most) {
    refuse(fmt::format("'{}' is not a list of at most {} texts", key, most), "choose fewer");
  }
  for (const Json& item : json[key]) {
    if (!item.is_string() || item.get_ref<const std::string&>().size() > kLongestFormula) {
      refuse(fmt::format("an entry of '{}' is not a text, or too long", key), "write it shorter");
    }
    out.push_back(item.get<std::string>());
  }
  return out;
}

std::optional<Parameter> parameter_of(const FrictionModel& model, const std::string& name) {
  for (const FrictionModel::Slot& slot : model.parameters()) {
    if (slot.full_name() == name) return slot.parameter;
  }
  return std::nullopt;
}

GivenParameter& entry_of(const std::string& name, std::vector<GivenParameter>& given) {
  const auto found = std::find_if(given.begin(), given.end(), [&](const auto& g) { return g.name == name; });
  if (found != given.end()) return *found;
  given.push_back({name, std::nullopt, std::nullopt});
  return given.back();
}

/// Starts and bounds of the parameters that the model has.
std::vector<GivenParameter> given_from(const Json& json, const FrictionModel& model) {
  std::vector<GivenParameter> given;
  const auto each = [&](const char* key, auto&& take) {
    if (!json.contains(key)) return;
    if (!json[key].is_object()) refuse(fmt::format("'{}' is not a set of named values", key), "write {\"mu_s\": 0.5}");
    for (const auto& [name, value] : json[key].items()) {
      const auto parameter = parameter_of(model, name);  // a page keeps those of models that it may come back to
      if (parameter) take(entry_of(name, given), value, parameter->si, name);
    }
  };
  each("start", [](GivenParameter& entry, const Json& value, double unit, const std::string& name) {
    entry.start = finite(value, "the start of " + name) * unit;
  });
  each("bounds", [](GivenParameter& entry, const Json& value, double unit, const std::string& name) {
    const auto [low, high] = range(value, "the range of " + name);
    entry.bounds = GivenParameter::Bounds{low * unit, high * unit};
  });
  if (const std::string why = contradiction_in(given); !why.empty()) refuse(why, "take one of them back");
  return given;
}

Selection selection_from(const Json& json) {
  Selection selection;
  if (json.contains("cycles") && !json["cycles"].is_null()) {
    constexpr double kMost = 1e9;
    const auto [first, last] = range(json["cycles"], "the range of cycles");
    if (first < 0 || last > kMost || first != std::floor(first) || last != std::floor(last)) {
      refuse("the range of cycles is not made of whole numbers", "count cycles from 0");
    }
    selection.cycles = {static_cast<std::size_t>(first), static_cast<std::size_t>(last)};
  }
  if (!json.contains("excluded")) return selection;
  if (!json["excluded"].is_array() || json["excluded"].size() > kMostStretches) {
    refuse("'excluded' is not a list of stretches of time", "exclude fewer stretches");
  }
  for (const Json& item : json["excluded"]) {
    const auto [from, to] = range(item, "an excluded stretch");
    if (!(from < to)) refuse("an excluded stretch has no length", "give an earlier and a later time");
    selection.excluded.push_back({from, to});
  }
  return selection;
}

/// SI value of the shown unit of a parameter, which another law with these effects may have.
double unit_in_any_law(const WorkbenchChoice& choice, const std::string& name) {
  if (const auto known = parameter_of(model_of(choice), name)) return known->si;
  for (const Law& law : law_catalogue()) {
    if (const auto known = parameter_of(FrictionModel(law), name)) return known->si;
  }
  return 1;
}

/// The number of units that makes up exactly this SI value, where there is one.
double in_units(double si, double unit) {
  const double nearest = si / unit;
  for (const double near : {nearest, std::nextafter(nearest, HUGE_VAL), std::nextafter(nearest, -HUGE_VAL)}) {
    if (near * unit == si) return near;
  }
  return nearest;
}

/// A choice as it is whatever the order of the clicks that led to it.
Json in_order(WorkbenchChoice choice) {
  std::ranges::sort(choice.effects);
  std::ranges::sort(choice.formulas);
  std::ranges::sort(choice.given, {}, &GivenParameter::name);
  std::ranges::sort(choice.selection.excluded, {}, [](const auto& one) { return std::pair(one.from, one.to); });
  return choice_json(choice);
}

}  // namespace

Json parsed(std::string_view text, const std::string& what) {
  if (is_nested_deeper(text, kDeepest)) refuse(what + " is nested too deeply", "write it as this program does");
  try {
    return Json::parse(text);
  } catch (const Json::exception& error) {
    refuse(what + " is not JSON: " + error.what(), "write it as this program does");
  }
}

std::vector<Effect> effects_of(const WorkbenchChoice& choice) {
  std::vector<Effect> effects;
  for (const std::string& name : choice.effects) effects.push_back(make_effect(name));
  for (const std::string& formula : choice.formulas) effects.emplace_back(Formula(formula));
  return effects;
}

FrictionModel model_of(const WorkbenchChoice& choice) {
  return FrictionModel(choice.law, effects_of(choice));
}

Json choice_json(const WorkbenchChoice& choice) {
  Json json = {{"law", to_string(choice.law)}, {"effects", choice.effects}, {"formulas", choice.formulas}};
  json["start"] = json["bounds"] = Json::object();
  for (const GivenParameter& known : choice.given) {
    const double unit = unit_in_any_law(choice, known.name);
    if (known.start) json["start"][known.name] = in_units(*known.start, unit);
    if (known.bounds) {
      json["bounds"][known.name] = {in_units(known.bounds->lower, unit), in_units(known.bounds->upper, unit)};
    }
  }
  json.update(selection_json(choice.selection));
  return json;
}

Json selection_json(const Selection& selection) {
  Json json = {{"cycles", nullptr}};
  if (selection.cycles) json["cycles"] = {selection.cycles->first, selection.cycles->last};
  json["excluded"] = list_of(selection.excluded, [](const auto& one) { return Json::array({one.from, one.to}); });
  return json;
}

std::vector<std::pair<std::string, double>> values_from(const Json& json) {
  constexpr std::size_t kMost = 64;
  if (!json.is_object() || json.size() > kMost) refuse("'values' is no set of named values", "write {\"mu_s\": 0.5}");
  std::vector<std::pair<std::string, double>> values;
  for (const auto& [name, value] : json.items()) values.emplace_back(name, finite(value, "the value of " + name));
  return values;
}

WorkbenchChoice choice_from(const Json& json) {
  if (!json.is_object()) refuse("this is not a choice", "send law, effects and formulas");
  WorkbenchChoice choice;
  const auto law = json.find("law");
  choice.law = make_law(law != json.end() && law->is_string() ? law->get<std::string>() : "");
  choice.effects = texts(json, "effects", kMostEffects);
  choice.formulas = texts(json, "formulas", kMostEffects);
  choice.given = given_from(json, model_of(choice));
  choice.selection = selection_from(json);
  return choice;
}

std::vector<std::string> arguments_of(const WorkbenchChoice& choice) {
  std::vector<std::string> out = {"--law", std::string(to_string(choice.law))};
  const auto add = [&](const char* option, std::string value) {
    out.emplace_back(option);
    out.push_back(std::move(value));
  };
  for (const std::string& effect : choice.effects) add("--effect", effect);
  for (const std::string& formula : choice.formulas) add("--formula", formula);
  const FrictionModel model = model_of(choice);
  for (const GivenParameter& known : choice.given) {
    const std::optional<Parameter> parameter = parameter_of(model, known.name);
    if (!parameter) continue;  // of another law: the command would be refused
    const double si = parameter->si;
    const std::string unit = parameter->unit.substr(parameter->unit.starts_with('1') ? 1 : 0);  // 2 1/s is 2/s
    if (known.start) add("--start", fmt::format("{}={}{}", known.name, in_units(*known.start, si), unit));
    if (known.bounds) {
      add("--bounds", fmt::format("{}={}..{}{}", known.name, in_units(known.bounds->lower, si),
                                  in_units(known.bounds->upper, si), unit));
    }
  }
  const Selection& selection = choice.selection;
  if (selection.cycles) add("--cycles", fmt::format("{}..{}", selection.cycles->first, selection.cycles->last));
  for (const auto& [from, to] : selection.excluded) add("--exclude", fmt::format("{}s..{}s", from, to));
  return out;
}

bool same(const WorkbenchChoice& a, const WorkbenchChoice& b) {
  return in_order(a) == in_order(b);
}

}  // namespace tribofit::workbench

namespace tribofit {

std::string contradiction_in(const std::vector<GivenParameter>& given) {
  for (const GivenParameter& one : given) {
    // SI; widths of bounds and squares of values have to stay finite.
    const auto beyond_numbers = [](double value) { return !(std::abs(value) <= 1e12); };
    if ((one.start && beyond_numbers(*one.start)) ||
        (one.bounds && (beyond_numbers(one.bounds->lower) || beyond_numbers(one.bounds->upper)))) {
      return one.name + " is given a value that is too large";
    }
    if (!one.bounds) continue;
    if (one.bounds->lower > one.bounds->upper) return "the bounds given for " + one.name + " run from high to low";
    if (one.start && (*one.start < one.bounds->lower || *one.start > one.bounds->upper)) {
      return one.name + " starts beyond the bounds given for it";
    }
  }
  return {};
}

}  // namespace tribofit
