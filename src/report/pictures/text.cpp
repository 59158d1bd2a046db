#include "report/pictures/text.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>

#include "ingest/csv/encoding.hpp"

namespace tribofit {
namespace {

constexpr std::string_view kEllipsis = "\xE2\x80\xA6";

/// Widths of ' ' to '~' in Arial, Helvetica and Liberation Sans [1/1000 of the size].
constexpr std::array<int, 95> kWidths = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333,  278, 278, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667,
    611, 778, 722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667,  611, 722, 667, 944, 667,
    667, 611, 278, 278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278,  556, 556, 222, 222, 500,
    222, 833, 556, 556, 556, 556, 333, 500, 278, 556, 500, 722, 500, 500,  500, 334, 260, 334, 584};

/// Bytes of the character at `at` of valid UTF-8.
std::size_t length_at(std::string_view text, std::size_t at) {
  std::size_t length = 1;
  while (at + length < text.size() && (static_cast<unsigned char>(text[at + length]) & 0xC0U) == 0x80) ++length;
  return length;
}

/// In parts of the size; beyond ASCII roughly, by its kind.
double width_of_character(std::string_view character) {
  if (character.size() == 1)
    return character[0] < ' ' || character[0] > '~' ? 0
                                                    : kWidths[static_cast<std::size_t>(character[0] - ' ')] / 1000.0;
  if (character == "\xC2\xB7") return 0.28;  // the dot of "2.5·10"
  if (character[0] == '\xE2') return character == kEllipsis ? 1 : 0.6;
  return character.size() > 2 ? 1 : 0.65;
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string out = valid_utf8(text);
  for (std::size_t k = 0; k < out.size(); ++k) {
    const auto byte = static_cast<unsigned char>(out[k]);
    const bool c1 = byte == 0xC2 && k + 1 < out.size() && static_cast<unsigned char>(out[k + 1]) < 0xA0;
    if (c1) out.erase(k, 1);  // a control character of two bytes
    if (c1 || byte < 0x20 || byte == 0x7F) out[k] = ' ';
    // U+FFFE and U+FFFF are in no XML.
    if (byte == 0xBF && k > 0 && k + 1 < out.size() && out[k - 1] == '\xEF' && out[k + 1] >= '\xBE')
      out[k + 1] = '\xBD';
  }
  return out;
}

std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::vector<TextPiece> pieces_of(std::string_view text) {
  std::vector<TextPiece> pieces;
  const auto add = [&](std::string_view part, int level) {
    if (!part.empty()) pieces.push_back({std::string(part), level});
  };
  std::size_t begin = 0;
  for (std::size_t k = 0; k + 1 < text.size(); ++k) {
    if ((text[k] != '_' && text[k] != '^') || text[k + 1] != '{') continue;
    const std::size_t close = text.find('}', k + 2);
    if (close == std::string_view::npos) break;
    add(text.substr(begin, k - begin), 0);
    add(text.substr(k + 2, close - k - 2), text[k] == '_' ? -1 : 1);
    begin = close + 1;
    k = close;
  }
  add(text.substr(begin), 0);
  return pieces;
}

double width_of(std::string_view text, double points) {
  double sum = 0;
  for (const TextPiece& piece : pieces_of(one_line(text))) {
    for (std::size_t k = 0; k < piece.text.size(); k += length_at(piece.text, k)) {
      sum += width_of_character(std::string_view(piece.text).substr(k, length_at(piece.text, k)));
    }
  }
  return sum * points * kMillimetresPerPoint;
}

std::string shortened(std::string_view text, double width, double points) {
  const std::string line = one_line(text);
  if (width_of(line, points) <= width) return line;
  std::vector<std::string> characters;
  for (std::size_t k = 0; k < line.size(); k += length_at(line, k))
    characters.push_back(line.substr(k, length_at(line, k)));
  std::string cut(kEllipsis);
  for (std::size_t kept = characters.size(); kept-- > 0;) {  // as much of the front as of the back
    const auto front = characters.begin() + static_cast<std::ptrdiff_t>((kept + 1) / 2);
    const auto back = characters.end() - static_cast<std::ptrdiff_t>(kept / 2);
    cut = fmt::format("{}{}{}", fmt::join(characters.begin(), front, ""), kEllipsis,
                      fmt::join(back, characters.end(), ""));
    if (width_of(cut, points) <= width) break;
  }
  return cut;
}

}  // namespace tribofit
