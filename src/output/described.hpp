#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <ranges>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "output/json.hpp"

namespace tribofit {

/// A struct is described once, by the names of its members in files:
///
///   constexpr auto description(const Harmonic*) {
///     return described("frequency_hz", &Harmonic::frequency, "amplitude_mm_s", in(kMillimetre, &Harmonic::amplitude));
///   }
///
/// From that json_of() writes it and read_json() reads it, and csv_names() and csv_line() of json_of() make a table of
/// such structs. Lists, optional values, enumerations (by to_string) and described structs may be members. A number
/// that is not known is NaN here and null there; what a file does not name stays as it is. Behind a name stands a
/// member, another description (an object of members of the same struct) or a function of the struct, which is written
/// and not read.
template <class... Parts>
struct Description {
  std::tuple<Parts...> parts;  ///< a name and what stands behind it, by turns
};

template <class... Parts>
constexpr Description<Parts...> described(Parts... parts) {
  return {{parts...}};
}

/// The description of a struct whose members stand in files under their own names: TRIBOFIT_DESCRIBED(Harmonic,
/// frequency, amplitude);
#define TRIBOFIT_MEMBER(member) #member, &Owner::member,
#define TRIBOFIT_MEMBERS(...) NLOHMANN_JSON_EXPAND(NLOHMANN_JSON_PASTE(TRIBOFIT_MEMBER, __VA_ARGS__))
#define TRIBOFIT_DESCRIBED(Struct, ...)                      \
  constexpr auto description(const Struct*) {                \
    using Owner = Struct;                                    \
    return described(TRIBOFIT_MEMBERS(__VA_ARGS__) nullptr); \
  }                                                          \
  static_assert(true)

template <class Struct>
concept Described = requires(const Struct* one) {
  description(one);
};

/// A member of a member.
template <class Outer, class Inner>
struct Within {
  Outer outer;
  Inner inner;
  template <class Struct>
  constexpr auto& operator()(Struct& one) const {
    return (one.*outer).*inner;
  }
};
template <class Outer, class Inner>
constexpr Within<Outer, Inner> within(Outer outer, Inner inner) {
  return {outer, inner};
}

/// A number or a list of them in SI here and in a unit there, with so many digits; 0: with all.
template <class Get>
struct Shown {
  double unit;
  int digits;
  Get get;
};
template <class Get>
constexpr Shown<Get> in(double unit, Get get, int digits = 0) {
  return {unit, digits, get};
}
template <class Get>
constexpr Shown<Get> to_digits(int digits, Get get) {
  return {1, digits, get};
}

/// An empty text, or a number that is not greater than zero, as null.
template <class Get>
struct NullWhereNone {
  Get get;
};
template <class Get>
constexpr NullWhereNone<Get> or_null(Get get) {
  return {get};
}

/// The ends of an interval as a list of two.
template <class Lower, class Upper>
struct IntervalEnds {
  Lower lower;
  Upper upper;
};
template <class Lower, class Upper>
constexpr IntervalEnds<Lower, Upper> ends(Lower lower, Upper upper) {
  return {lower, upper};
}

template <class Value>
Json json_of(const Value& value);
template <class Value>
void read_json(const Json& json, Value& value);

template <class... Parts, class Visit>
constexpr void for_each_member(const Description<Parts...>& one, Visit&& visit) {
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (visit(std::get<2 * k>(one.parts), std::get<2 * k + 1>(one.parts)), ...);
  }
  (std::make_index_sequence<sizeof...(Parts) / 2>());
}

// What stands behind a name: written from a struct, read into one.

template <class Get, class Struct>
Json written(const Get& get, const Struct& from) {
  return json_of(std::invoke(get, from));
}
template <class Get, class Struct>
void read_into(const Get& get, const Json& json, Struct& to) {
  if constexpr (std::is_lvalue_reference_v<std::invoke_result_t<const Get&, Struct&>>) {
    read_json(json, std::invoke(get, to));
  }
}

inline Json shown_as(double value, double unit, int digits) {
  return digits > 0 ? rounded(value / unit, digits) : number(value / unit);
}
template <class Get, class Struct>
Json written(const Shown<Get>& shown, const Struct& from) {
  const auto& value = std::invoke(shown.get, from);
  if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
    return shown_as(value, shown.unit, shown.digits);
  } else {
    return list_of(value, [&](double one) { return shown_as(one, shown.unit, shown.digits); });
  }
}
template <class Get, class Struct>
void read_into(const Shown<Get>& shown, const Json& json, Struct& to) {
  auto& value = std::invoke(shown.get, to);
  read_json(json, value);
  if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
    value *= shown.unit;
  } else {
    for (double& one : value) one *= shown.unit;
  }
}

template <class Get, class Struct>
Json written(const NullWhereNone<Get>& part, const Struct& from) {
  const auto& value = std::invoke(part.get, from);
  if constexpr (std::is_floating_point_v<std::decay_t<decltype(value)>>) {
    return positive_or_null(value);
  } else {
    return text_or_null(value);
  }
}
template <class Get, class Struct>
void read_into(const NullWhereNone<Get>& part, const Json& json, Struct& to) {
  auto& value = std::invoke(part.get, to);
  value = {};
  if (!json.is_null()) read_json(json, value);
}

template <class Lower, class Upper, class Struct>
Json written(const IntervalEnds<Lower, Upper>& part, const Struct& from) {
  return interval_json(std::invoke(part.lower, from), std::invoke(part.upper, from));
}
template <class Lower, class Upper, class Struct>
void read_into(const IntervalEnds<Lower, Upper>& part, const Json& json, Struct& to) {
  read_json(json.at(0), std::invoke(part.lower, to));
  read_json(json.at(1), std::invoke(part.upper, to));
}

template <class... Parts, class Struct>
Json written(const Description<Parts...>& one, const Struct& from) {
  Json json;
  make_room(json, sizeof...(Parts) / 2);
  for_each_member(one, [&](const char* name, const auto& part) { json[name] = written(part, from); });
  return json;
}
template <class... Parts, class Struct>
void read_into(const Description<Parts...>& one, const Json& json, Struct& to) {
  for_each_member(one, [&](const char* name, const auto& part) {
    if (const auto found = json.find(name); found != json.end()) read_into(part, *found, to);
  });
}

template <class Value>
Json json_of(const Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    return number(value);
  } else if constexpr (std::is_enum_v<Value>) {
    return to_string(value);
  } else if constexpr (Described<Value>) {
    return written(description(&value), value);
  } else if constexpr (std::is_same_v<Value, Json> || std::is_convertible_v<const Value&, std::string_view>) {
    return value;
  } else if constexpr (std::ranges::range<Value>) {
    return list_of(value, [](const auto& one) { return json_of(one); });
  } else if constexpr (requires { value.has_value(); }) {
    return value ? json_of(*value) : Json(nullptr);
  } else {
    return value;
  }
}

/// Throws Json::exception for what is of another kind.
template <class Value>
void read_json(const Json& json, Value& value) {
  if constexpr (std::is_floating_point_v<Value>) {
    value = json.is_null() ? std::numeric_limits<Value>::quiet_NaN() : json.get<Value>();
  } else if constexpr (Described<Value>) {
    if (!json.is_object()) throw Json::type_error::create(302, "is no object", &json);
    read_into(description(&value), json, value);
  } else if constexpr (requires { value.emplace_back(); }) {
    value.clear();
    for (const Json& one : json.get_ref<const Json::array_t&>()) read_json(one, value.emplace_back());
  } else if constexpr (requires { value.has_value(); }) {
    value.reset();
    if (!json.is_null()) read_json(json, value.emplace());
  } else {
    json.get_to(value);
  }
}

template <class Value>
Value read_from(const Json& json) {
  Value value;
  read_json(json, value);
  return value;
}

}  // namespace tribofit
