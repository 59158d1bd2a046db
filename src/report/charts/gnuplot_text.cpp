#include "report/charts/gnuplot_text.hpp"

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

namespace tribofit {
namespace {

constexpr std::string_view kEllipsis = "\xE2\x80\xA6", kFixedBlank = "\xC2\xA0";
constexpr double kMillimetresPerPoint = 25.4 / 72;

/// Bytes of the character at `at` of valid UTF-8.
std::size_t length_at(std::string_view text, std::size_t at) {
  std::size_t length = 1;
  while (at + length < text.size() && (static_cast<unsigned char>(text[at + length]) & 0xC0U) == 0x80) ++length;
  return length;
}

/// Width of a character in Arial and Helvetica, in parts of the size: roughly, by its kind.
double width_of_character(std::string_view character) {
  if (character.size() > 1) return character[0] == '\xE2' ? 0.7 : character.size() > 2 ? 1.0 : 0.58;
  const char c = character[0];
  constexpr std::string_view narrow = "ijl'|", slim = "fIrt.,:;/\\!()[]{} -`\"", wide = "mMWw@%";
  if (narrow.find(c) != std::string_view::npos) return 0.222;
  if (slim.find(c) != std::string_view::npos) return 0.3;
  if (wide.find(c) != std::string_view::npos) return 0.85;
  if (c >= 'A' && c <= 'Z') return 0.7;
  return 0.556;
}

/// Calls `plain(character)` for what is shown as it is and `sign(character)` for the signs of markup: the '_' or '^'
/// and the braces of "_{...}" and "^{...}". `text` is valid UTF-8.
template <class Plain, class Sign>
void walk_markup(std::string_view text, Plain plain, Sign sign) {
  std::size_t closes = std::string_view::npos;
  for (std::size_t k = 0; k < text.size(); k += length_at(text, k)) {
    const bool script = (text[k] == '_' || text[k] == '^') && k + 1 < text.size() && text[k + 1] == '{';
    if (script && closes == std::string_view::npos) {
      closes = text.find('}', k);
      if (closes != std::string_view::npos) {
        sign(text[k]);
        sign(text[++k]);
        continue;
      }
    }
    if (k == closes) {
      sign(text[k]);
      closes = std::string_view::npos;
    } else {
      plain(text.substr(k, length_at(text, k)));
    }
  }
}

/// In gnuplot nothing but the quote itself means anything between single quotes, and its double stands for it.
std::string between_quotes(std::string_view text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("''") : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string one_line(std::string_view text) {
  // Names of files need not be valid UTF-8; pictures are.
  const nlohmann::json json = std::string(text);
  auto out =
      nlohmann::json::parse(json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)).get<std::string>();
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto byte = static_cast<unsigned char>(out[k]);
    const bool c1 = byte == 0xC2 && k + 1 < out.size() && static_cast<unsigned char>(out[k + 1]) < 0xA0;
    if (c1) out.erase(k, 1);  // a control character of two bytes
    if (c1 || byte < 0x20 || byte == 0x7F) out[k] = ' ';
  }
  return out;
}

std::string quoted(std::string_view text) {
  return between_quotes(one_line(text));
}

std::string quoted_markup(std::string_view text) {
  std::string out;
  const auto plain = [&](std::string_view character) {
    constexpr std::string_view special = "\\^_{}@&~";
    if (special.find(character) != std::string_view::npos) out += '\\';
    // Viewers of SVG swallow a blank behind a subscript unless it is one that does not break.
    out += character == " " && out.ends_with('}') && !out.ends_with("\\}") ? kFixedBlank : character;
  };
  walk_markup(one_line(text), plain, [&](char sign) { out += sign; });
  return between_quotes(out);
}

double width_of(std::string_view text, double points) {
  double sum = 0;
  walk_markup(
      one_line(text), [&](std::string_view character) { sum += width_of_character(character); }, [](char) {});
  return sum * points * kMillimetresPerPoint;
}

std::string shortened(std::string_view text, double width, double points) {
  std::string line = one_line(text);
  if (width_of(line, points) <= width) return line;
  std::vector<std::string> characters;
  for (std::size_t k = 0; k < line.size(); k += length_at(line, k))
    characters.push_back(line.substr(k, length_at(line, k)));
  double left = width - width_of(kEllipsis, points);
  std::string front, back;
  for (std::size_t first = 0, last = characters.size(); first < last;) {
    const bool to_front = front.size() <= back.size();
    const std::string& next = to_front ? characters[first] : characters[last - 1];
    left -= width_of(next, points);
    if (left < 0) break;
    if (to_front) {
      front += next;
      ++first;
    } else {
      back = next + back;
      --last;
    }
  }
  return front + std::string(kEllipsis) + back;
}

}  // namespace tribofit
