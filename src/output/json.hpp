#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <utility>

namespace tribofit {

/// Objects and lists of JSON, as all files and pages are made of them: members in the order in which they are named,
/// what is not known as null.

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

/// Room for so many members more: an object that grows copies all that it holds, since its names are constant. What
/// has long lists is given room for all its members at first.
inline void make_room(Json& json, std::size_t more) {
  if (json.is_null()) json = Json::object();
  auto& members = json.get_ref<Json::object_t&>();
  const std::size_t wanted = members.size() + more;
  if (wanted > members.capacity()) members.reserve(std::max(wanted, 2 * members.capacity()));
}

inline void add_members(Json&) {}
/// Adds names and values, one after the other; numbers that are not known become null.
template <class Value, class... More>
void add_members(Json& json, std::string name, Value&& value, More&&... more) {
  make_room(json, 1 + sizeof...(more) / 2);
  if constexpr (std::is_same_v<std::decay_t<Value>, double>) {
    json[std::move(name)] = number(value);
  } else {
    json[std::move(name)] = std::forward<Value>(value);
  }
  add_members(json, std::forward<More>(more)...);
}

/// As object(), with room for so many members more.
template <class... Members>
Json object_with_room(std::size_t more, Members&&... members) {
  Json json = Json::object();
  make_room(json, sizeof...(members) / 2 + more);
  add_members(json, std::forward<Members>(members)...);
  return json;
}

/// An object of names and values: object("law", "exponential", "slope", 0.2).
template <class... Members>
Json object(Members&&... members) {
  return object_with_room(0, std::forward<Members>(members)...);
}

/// A list of what `make` makes of each item.
template <class Items, class Make>
Json list_of(const Items& items, Make&& make) {
  Json::array_t list;
  list.reserve(std::size(items));
  for (const auto& item : items) list.push_back(make(item));
  return list;
}

/// A number with so many digits, so that files stay small.
inline Json rounded(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  if (value == 0) return 0.0;
  // Integers and powers of ten up to 10^22 are exact, and so their quotient is the double nearest to the decimal.
  static constexpr double kPowersOfTen[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                            1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const int shift = digits - 1 - static_cast<int>(std::floor(std::log10(std::abs(value))));
  const auto exponent = static_cast<std::size_t>(std::abs(shift));
  if (exponent >= std::size(kPowersOfTen)) return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);
  const double power = kPowersOfTen[exponent];
  return shift < 0 ? std::round(value / power) * power : std::round(value * power) / power;
}
inline Json rounded_list(std::span<const double> values, int digits) {
  return list_of(values, [&](double value) { return rounded(value, digits); });
}

/// On one line. File names and headers need not be valid UTF-8.
inline std::string line_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}
/// Indented text, which ends with a line break.
inline std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tribofit
