#include "encoding.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <optional>

#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

/// Length of the UTF-8 sequence at `i`, 0 where no valid one begins. A sequence cut off by the end of the text is
/// accepted.
std::size_t utf8_sequence(std::string_view text, std::size_t i) {
  const unsigned char lead = byte_at(text, i);
  const std::size_t length = lead < 0x80                   ? 1
                             : lead >= 0xC2 && lead < 0xE0 ? 2
                             : lead >= 0xE0 && lead < 0xF0 ? 3
                             : lead >= 0xF0 && lead < 0xF5 ? 4
                                                           : 0;
  for (std::size_t k = 1; k < length && i + k < text.size(); ++k) {
    if ((byte_at(text, i + k) & 0xC0) != 0x80) return 0;
  }
  if (length > 2 && i + 1 < text.size()) {  // neither longer than need be, nor a half of UTF-16, nor beyond Unicode
    const unsigned char second = byte_at(text, i + 1);
    if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second >= 0xA0) || (lead == 0xF0 && second < 0x90) ||
        (lead == 0xF4 && second >= 0x90))
      return 0;
  }
  return length;
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_sequence(text, i);
    if (length == 0) return false;
    i += length;
  }
  return true;
}

bool high_bytes_are_pairs(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (byte_at(text, i) < 0x80) continue;
    if (byte_at(text, i) < 0xA1 || i + 1 >= text.size() || byte_at(text, i + 1) < 0xA1) return false;
    ++i;
  }
  return true;
}

/// The text from an encoding that iconv knows; '?' for every byte that is invalid in it.
std::string converted(std::string_view text, const char* from) {
  const iconv_t converter = iconv_open("UTF-8", from);
  std::string source(text), result(2 * text.size() + 4, '\0');
  if (converter == reinterpret_cast<iconv_t>(-1)) return valid_utf8(text);
  char* in = source.data();
  char* out = result.data();
  std::size_t in_left = source.size(), out_left = result.size();
  while (in_left > 0 && iconv(converter, &in, &in_left, &out, &out_left) == static_cast<std::size_t>(-1)) {
    if (in_left == 0 || out_left == 0) break;
    ++in;
    --in_left;
    *out++ = '?';
    --out_left;
  }
  iconv_close(converter);
  result.resize(result.size() - out_left);
  return result;
}

struct Signature {
  std::string_view bytes, name;
  const char* advice;
};

constexpr std::array signatures = {
    Signature{"PK\x03\x04", "a ZIP archive or an Excel workbook", "save the sheet as CSV"},
    Signature{"\xD0\xCF\x11\xE0", "an old Excel or Office file", "save the sheet as CSV"},
    Signature{"\x1F\x8B", "compressed with gzip", "unpack it with gunzip"},
    Signature{"\x89HDF", "an HDF5 file", "export the channels as CSV"},
    Signature{"%PDF", "a PDF document", "export the data as CSV"},
};

/// What a file is that is not text, and what to do with it.
std::optional<InputError> find_foreign(std::string_view head) {
  for (const Signature& signature : signatures) {
    if (!head.starts_with(signature.bytes)) continue;
    return InputError(fmt::format("is {}, not a CSV file", signature.name), signature.advice);
  }
  const std::string_view start = head.substr(0, 4096);
  const auto zeros = std::count(start.begin(), start.end(), '\0');
  const bool utf16_mark = head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF");
  if (utf16_mark || (start.size() >= 4 && (start[0] == '\0') != (start[1] == '\0') &&
                     static_cast<double>(zeros) > kZerosOfUtf16 * static_cast<double>(start.size()))) {
    return InputError("is UTF-16 text (\"Unicode\" in Windows programs)",
                      "save it as CSV UTF-8, or convert it with: iconv -f UTF-16 -t UTF-8");
  }
  const auto control = std::count_if(start.begin(), start.end(), [](char c) {
    return static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != '\x1A';
  });
  if (zeros > 0 || static_cast<double>(control) > kControlsOfText * static_cast<double>(start.size())) {
    return InputError("is a binary file, not a CSV file", "export the channels as text with one row per sample");
  }
  return std::nullopt;
}

}  // namespace

bool is_text(std::string_view head) {
  return !find_foreign(head);
}

void refuse_unless_text(std::string_view head, const std::string& path) {
  const auto foreign = find_foreign(head);
  if (foreign) throw InputError(foreign->problem(), foreign->advice(), {path, 0, ""});
}

Encoding guess_encoding(std::string_view head) {
  if (is_utf8(head)) return Encoding::utf8;
  return high_bytes_are_pairs(head) ? Encoding::gbk : Encoding::latin1;
}

std::string to_utf8(std::string_view text, Encoding encoding) {
  if (encoding == Encoding::latin1) return converted(text, "ISO-8859-1");
  if (encoding == Encoding::gbk) return converted(text, "GBK");
  return std::string(text);
}

std::string valid_utf8(std::string_view text) {
  std::string valid;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = utf8_sequence(text, i);
    const bool is_letter = length > 0 && i + length <= text.size();
    valid += is_letter ? text.substr(i, length) : "\xEF\xBF\xBD";
    i += is_letter ? length : 1;
  }
  return valid;
}

std::size_t byte_order_mark(std::string_view head) {
  return head.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
}

}  // namespace tribofit
