#include "csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

namespace tribofit {

std::string CsvLine::take() {
  has_cells_ = false;
  return std::exchange(text_, {}) + "\n";
}

void CsvLine::begin_cell() {
  if (std::exchange(has_cells_, true)) text_ += ',';
}

void CsvLine::add_number(double value) {
  begin_cell();
  if (!std::isfinite(value)) return;
  if (digits_ > 0) {
    fmt::format_to(std::back_inserter(text_), "{:.{}g}", value, digits_);
  } else {
    fmt::format_to(std::back_inserter(text_), "{}", value);
  }
}

bool is_formula(std::string_view text) {
  const std::size_t first = std::min(text.find_first_not_of('\''), text.size());
  if (std::string_view("=+-@\t\r").find(text.substr(first, 1)) == std::string_view::npos || first == text.size())
    return false;
  double number = 0;
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data() + (text[0] == '+' ? 1 : 0), end, number);
  return error != std::errc{} || rest != end;
}

void CsvLine::add_text(std::string_view text) {
  begin_cell();
  const bool quoted = text.find_first_of(",;\t\"#") != std::string_view::npos;
  if (quoted) text_ += '"';
  if (is_formula(text)) text_ += '\'';
  for (const char c : text) {
    if (c == '"') text_ += '"';
    text_ += c == '\n' || c == '\r' ? ' ' : c;
  }
  if (quoted) text_ += '"';
}

void CsvLine::add_values(const nlohmann::ordered_json& json) {
  if (json.is_structured()) {
    for (const auto& value : json) add_values(value);
  } else if (json.is_number_float()) {
    add_number(json.get<double>());
  } else if (json.is_boolean()) {
    add_text(json.get<bool>() ? "1" : "0");
  } else {
    add_text(json.is_null() ? "" : json.is_string() ? json.get<std::string>() : json.dump());
  }
}

std::string csv_names(const nlohmann::ordered_json& object) {
  std::string names;
  for (const auto& [name, value] : object.items()) {
    const bool is_interval = name.starts_with("ci95");
    names += (names.empty() ? "" : ",") + (is_interval ? name + "_lower," + name + "_upper" : name);
  }
  return names;
}

}  // namespace tribofit
