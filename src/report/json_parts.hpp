#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

#include "tribofit/diagnosis/diagnosis.hpp"
#include "tribofit/report/json.hpp"

namespace tribofit {

/// The parts of which the objects of all verbs are made.

using Json = nlohmann::ordered_json;

/// A number, or null for what is not known.
inline Json number(double value) {
  return std::isfinite(value) ? Json(value) : Json(nullptr);
}
/// A number, or null for what is not declared.
inline Json positive_or_null(double value) {
  return value > 0 ? number(value) : Json(nullptr);
}
inline Json text_or_null(const std::string& text) {
  return text.empty() ? Json(nullptr) : Json(text);
}
/// The ends of an interval.
inline Json interval_json(double lower, double upper) {
  return Json::array({number(lower), number(upper)});
}

inline void add_members(Json&) {}
/// Adds names and values, one after the other; numbers that are not known become null.
template <class Value, class... More>
void add_members(Json& json, const char* name, Value&& value, More&&... more) {
  if constexpr (std::is_same_v<std::decay_t<Value>, double>) {
    json[name] = number(value);
  } else {
    json[name] = std::forward<Value>(value);
  }
  add_members(json, std::forward<More>(more)...);
}

/// An object of names and values: object("law", "exponential", "slope", 0.2).
template <class... Members>
Json object(Members&&... members) {
  Json json = Json::object();
  add_members(json, std::forward<Members>(members)...);
  return json;
}

/// A list of what `make` makes of each item.
template <class Items, class Make>
Json list_of(const Items& items, Make&& make) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(make(item));
  return list;
}

Json tool_json(const JsonOptions& options);
/// "tool", "trace", "conditions", "health" and "stick_slip": how the object of one trace begins.
Json record_json(const Identification& trace, const JsonOptions& options);
Json trace_json(const Identification& trace);
Json conditions_json(const Conditions& conditions);
/// With those of the steps, where there are several.
Json conditions_of(const Motion& motion);
/// In the units people read, which depend on whether friction is a force (`motion`).
Json parameter_json(const FitParameter& parameter, const Motion& motion);
Json fits_json(std::span<const Fit> fits, const Motion& motion);
Json rig_json(const RigFit& rig);

/// The whole result of one trace.
Json identification_json(const Identification& result, const JsonOptions& options);

/// Indented text, which ends with a line break.
std::string text_of(const Json& json);
/// On one line.
std::string line_of(const Json& json);

}  // namespace tribofit
