#include "tribofit/output/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tribofit {

std::string printable(std::string_view text) {
  std::string shown;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      shown += "\\n";
    } else if (byte < 0x20 || byte == 0x7f) {
      shown += fmt::format("\\x{:02x}", byte);
    } else {
      shown += c;
    }
  }
  return shown;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
}

std::string unit_behind(const std::string& unit) {
  return unit.empty() || unit == "1" ? "" : " " + unit;
}

std::string enumerated(const std::vector<std::string>& names, std::string_view last) {
  if (names.size() < 2) return names.empty() ? "" : names.front();
  return fmt::format("{} {} {}", fmt::join(names.begin(), names.end() - 1, ", "), last, names.back());
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

bool is_nested_deeper(std::string_view json, int levels) {
  int depth = 0;
  for (std::size_t i = 0; i < json.size() && depth <= levels; ++i) {
    const std::string_view rest = json.substr(i);
    if (json[i] == '"') {
      for (++i; i < json.size() && json[i] != '"'; ++i) i += json[i] == '\\' ? 1U : 0U;
    } else if (rest.starts_with("//") || rest.starts_with("/*")) {
      const std::string_view close = rest[1] == '/' ? "\n" : "*/";
      i = std::min(json.size(), json.find(close, i + 2));
    } else if (json[i] == '[' || json[i] == '{') {
      ++depth;
    } else if (json[i] == ']' || json[i] == '}') {
      --depth;
    }
  }
  return depth > levels;
}

}  // namespace tribofit
