#include "raw_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace tribofit {
namespace {

/// Names that need a unit to be believed: a velocity is as often the carriage's, a position a height.
bool needs_unit(std::string_view base, Channel channel) {
  return (channel == Channel::angle && base == "position") || (channel == Channel::torque && base == "m") ||
         base == "tau";
}

/// The longest end of "a_b_c" that is a unit when '_' is read as '/': {"v_b", "mm/s"} of "v_b_mm_s".
std::optional<std::pair<std::string, std::string>> split_unit_at_end(const std::string& name) {
  for (std::size_t at = name.find('_', 1); at != std::string::npos; at = name.find('_', at + 1)) {
    const std::string end = name.substr(at + 1);
    if (end.empty() || end == "1" || end == "-" || end == "t" || end == "h" || end == "g") continue;
    std::string quotient = replaced(replaced(end, "_per_", "/"), "_", "/");
    for (const auto& [from, to] : {std::pair{"/s2", "/s^2"}, std::pair{"/s/2", "/s^2"}})
      quotient = replaced(quotient, from, to);
    if (find_unit(quotient)) return std::pair{name.substr(0, at), quotient};
  }
  return std::nullopt;
}

std::string base_of(std::string_view text) {
  std::string_view name = text;
  if (const std::size_t dot = name.rfind('.'); dot != std::string_view::npos && dot + 1 < name.size()) {
    name = name.substr(dot + 1);
  }
  name = name.substr(0, name.find_first_of(",(", 1));  // "v_b, laser", "Velocity (laser)"
  std::string base;
  for (const char c : lower_case(name)) {
    if (std::string_view(" _-.\"'").find(c) == std::string_view::npos) base += c;
  }
  return base;
}

/// Quantity in the numerator of a sensitivity, as the channel's own.
std::optional<double> value_in(std::string_view number, std::string_view unit, Channel channel) {
  for (const Quantity quantity : info_of(channel).quantities) {
    if (find_unit(unit, quantity)) {
      return parse_quantity(std::string(number) + std::string(unit), quantity, to_string(channel));
    }
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> channel_names() {
  std::vector<std::string> names;
  for (const ChannelInfo& channel : channel_infos) names.emplace_back(channel.key);
  return names;
}

Label label_of(const RawColumn& column) {
  ColumnName name = parse_column_name(column.name);
  Label label{std::move(name.base), std::move(name.unit).value_or(""), std::nullopt};
  if (label.unit.empty() && column.unit != ".") label.unit = column.unit;  // xlook's sign for none
  if (label.unit.empty()) return label;
  auto unit = find_unit(label.unit, Quantity::angular_velocity);
  if (!unit) unit = find_unit(label.unit);
  if (unit) label.quantity = unit->quantity;
  return label;
}

bool is_field_name(std::string_view base) {
  return std::ranges::any_of(channel_infos, [&](const ChannelInfo& c) { return is_among(base, c.names); });
}

std::size_t name_rank(std::string_view base, Channel channel, std::optional<Quantity> quantity) {
  const auto allowed = info_of(channel).quantities;
  const bool rotates = quantity == Quantity::angular_velocity;
  const bool fits = !quantity || allowed.size() == 0 ||
                    std::find(allowed.begin(), allowed.end(), *quantity) != allowed.end() ||
                    *quantity == Quantity::voltage;
  if (needs_unit(base, channel) && !(quantity && fits)) return no_rank;
  // A "velocity" in rpm is the disc's unless the user says otherwise; "speed" in mm/s is a velocity.
  const bool just_velocity = base == "velocity" || base == "v" || base == "geschwindigkeit" || base == "\u901f\u5ea6";
  if (rotates && just_velocity && channel == Channel::v_b) return no_rank;
  if (rotates && just_velocity && channel == Channel::speed) return 100;
  if (channel == Channel::v_r && base == "speed" && quantity == Quantity::velocity) return 100;
  if ((channel == Channel::speed || channel == Channel::angle) && !fits) return no_rank;
  if (channel == Channel::force && base == "friction" && quantity == Quantity::force) return 100;
  if (channel == Channel::mu && base == "friction" && quantity == Quantity::force) return no_rank;
  return place_among(base, info_of(channel).names);
}

bool names_rpm(std::string_view base) {
  return base == "rpm" || base == "drehzahl";
}

bool names_load_point(std::string_view base) {
  return base.starts_with("lp") || base.find("loadpoint") != std::string::npos || base == "xlp";
}

std::string lists_columns(const std::string& path) {
  return fmt::format("'identify columns {}' lists what it holds", path);
}

std::size_t named_column(const RawTable& table, const std::string& wanted, Channel channel) {
  const auto& columns = table.columns;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].named && columns[i].name == wanted) return i;
  }
  if (wanted.size() > 1 && wanted[0] == '#') {
    std::size_t number = 0;
    const char* end = wanted.data() + wanted.size();
    const auto [last, error] = std::from_chars(wanted.data() + 1, end, number);
    if (error == std::errc{} && last == end && number >= 1 && number <= columns.size()) return number - 1;
    throw InputError(fmt::format("there is no column {} for {}", wanted, to_string(channel)),
                     fmt::format("the file has {} columns, #1 to #{}; {}", columns.size(), columns.size(),
                                 lists_columns(table.path)),
                     table.heading());
  }
  const std::string lower = lower_case(wanted), base = parse_column_name(wanted).base;
  std::vector<std::size_t> similar;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const std::string& name = columns[i].name;
    if (lower_case(name) == lower || parse_column_name(name).base == base) similar.push_back(i);
  }
  if (similar.size() == 1) return similar.front();
  const std::vector<std::string> names = table.names();
  throw InputError(
      fmt::format("there is no column '{}' for {}{}", wanted, to_string(channel), did_you_mean(wanted, names)),
      "the columns are: " + listed(names) + "; " + lists_columns(table.path), table.heading());
}

std::optional<double> find_sensitivity(std::string_view text, Channel channel) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return std::nullopt;
  const std::size_t digits = static_cast<std::size_t>(end - text.data());
  const std::string_view unit = trimmed(text.substr(digits));
  struct Volt {
    std::string_view below, above;
    double factor;
  };
  for (const auto& [below, above, factor] : {Volt{"/V", "V/", 1}, Volt{"/mV", "mV/", 1e-3}}) {
    if (unit.ends_with(below)) {
      const auto value = value_in(text.substr(0, digits), unit.substr(0, unit.size() - below.size()), channel);
      if (value) return *value / factor;
    }
    if (unit.starts_with(above)) {
      const auto value = value_in("1", strip_brackets(unit.substr(above.size())), channel);
      if (value && number != 0) return *value / (number * factor);
    }
  }
  return std::nullopt;
}

std::string strip_brackets(std::string_view text) {
  text = trimmed(text);
  if (text.size() >= 2 &&
      ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'))) {
    text = trimmed(text.substr(1, text.size() - 2));
  }
  return std::string(text);
}

ColumnName parse_column_name(std::string_view text) {
  std::string name(trimmed(text));
  for (const auto& [from, to] : {std::pair{"\uff08", "("}, std::pair{"\uff09", ")"}}) name = replaced(name, from, to);
  const auto unbracketed = [&](char open, char close) -> std::optional<ColumnName> {
    const std::size_t at = name.find(open);
    if (name.empty() || name.back() != close || at == std::string::npos || at == 0) return std::nullopt;
    if (name[at + 1] == ':' || name.ends_with(",:)")) return std::nullopt;  // "a(:,1)" of a matrix
    return ColumnName{base_of(trimmed(std::string_view(name).substr(0, at))), strip_brackets(name.substr(at))};
  };
  if (const auto split = unbracketed('[', ']')) return *split;
  if (const auto split = unbracketed('(', ')')) return *split;
  for (const std::string_view mark : {" / ", " in ", ", ", "/"}) {  // "v_b / mm/s", "Zeit in s", "Time, s"
    const std::size_t at = name.find(mark);
    if (at != std::string::npos && at > 0 && find_unit(std::string_view(name).substr(at + mark.size()))) {
      return {base_of(std::string_view(name).substr(0, at)),
              std::string(trimmed(std::string_view(name).substr(at + mark.size())))};
    }
  }
  if (is_field_name(base_of(name))) return {base_of(name), std::nullopt};  // "F_N" is a force, not a farad
  if (const auto split = split_unit_at_end(name)) return {base_of(split->first), split->second};
  return {base_of(name), std::nullopt};
}

void LineMap::set(std::size_t row, std::size_t line) {
  if (!starts_.empty() && line_of(row) == line) return;
  if (!starts_.empty() && starts_.back().first == row) {
    starts_.back().second = line;
  } else {
    starts_.emplace_back(row, line);
  }
}

std::size_t LineMap::line_of(std::size_t row) const {
  if (starts_.empty()) return 0;
  auto at =
      std::upper_bound(starts_.begin(), starts_.end(), row, [](std::size_t r, const auto& s) { return r < s.first; });
  if (at != starts_.begin()) --at;
  return at->second + (row - at->first);
}

std::optional<double> value_of(const RawFact& fact, Quantity quantity, std::string_view bare_unit) {
  const std::string value = replaced(fact.value, ",", ".");
  const std::string in_name = parse_column_name(fact.name).unit.value_or("");
  try {
    return parse_quantity(value, quantity, fact.name, in_name.empty() ? bare_unit : in_name);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

bool RawTable::has_names() const {
  return std::any_of(columns.begin(), columns.end(), [](const RawColumn& column) { return column.named; });
}

std::vector<std::string> RawTable::names() const {
  std::vector<std::string> result;
  for (const RawColumn& column : columns) result.push_back(column.name);
  return result;
}

InputLocation RawTable::heading(std::size_t column) const {
  return {path, columns[column].line, columns[column].shown_name()};
}

}  // namespace tribofit
