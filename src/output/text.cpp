#include "tribofit/output/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tribofit {

namespace {

/// The character in UTF-8 at the beginning of a text, where it has two or three bytes; else 0.
unsigned short_sequence(std::string_view text) {
  const auto at = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0U; };
  const auto continues = [&](std::size_t k) { return (at(k) & 0xC0U) == 0x80; };
  if ((at(0) & 0xE0U) == 0xC0 && continues(1)) return (at(0) & 0x1FU) << 6 | (at(1) & 0x3FU);
  if ((at(0) & 0xF0U) != 0xE0 || !continues(1) || !continues(2)) return 0;
  return (at(0) & 0x0FU) << 12 | (at(1) & 0x3FU) << 6 | (at(2) & 0x3FU);
}

}  // namespace

std::size_t unseen_bytes(std::string_view text) {
  constexpr std::pair<unsigned, unsigned> kUnseen[] = {{0x80, 0x9F},     {0xAD, 0xAD},     {0x61C, 0x61C},
                                                       {0x180E, 0x180E}, {0x200B, 0x200F}, {0x2028, 0x202E},
                                                       {0x2060, 0x206F}, {0xFEFF, 0xFEFF}};
  const auto byte = static_cast<unsigned char>(text.empty() ? ' ' : text[0]);
  if (byte < 0x20 || byte == 0x7F) return 1;
  const unsigned wide = short_sequence(text);
  for (const auto& [first, last] : kUnseen) {
    if (first <= wide && wide <= last) return wide < 0x800 ? 2 : 3;
  }
  return 0;
}

std::string printable(std::string_view text) {
  std::string shown;
  while (!text.empty()) {
    const std::size_t unseen = unseen_bytes(text);
    if (text[0] == '\n') {
      shown += "\\n";
    } else if (unseen == 1) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[0]));
    } else if (unseen > 1) {
      shown += fmt::format("\\u{:04x}", short_sequence(text));
    } else {
      shown += text[0];
    }
    text.remove_prefix(std::max<std::size_t>(unseen, 1));
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
