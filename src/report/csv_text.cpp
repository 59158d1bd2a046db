#include "csv_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tribofit {

std::string cell(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '\r', ' ');
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}

std::string cells(const Json& json) {
  if (json.is_null()) return "";
  if (json.is_string()) return cell(json.get<std::string>());
  if (json.is_boolean()) return json.get<bool>() ? "1" : "0";
  if (json.is_number_float()) return cell(json.get<double>());
  if (!json.is_structured()) return json.dump();
  std::string text;
  bool first = true;
  for (const Json& value : json) {
    text += (first ? "" : ",") + cells(value);
    first = false;
  }
  return text;
}

std::string csv_line(const std::vector<std::string>& cells) {
  return fmt::format("{}\n", fmt::join(cells, ","));
}

}  // namespace tribofit
