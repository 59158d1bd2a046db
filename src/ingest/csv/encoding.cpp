#include "encoding.hpp"

#include <fmt/format.h>
#include <iconv.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <utility>

#include "ingest/limits.hpp"
#include "tribofit/ingest/input_error.hpp"

namespace tribofit {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) {
  return static_cast<unsigned char>(text[i]);
}

bool high_bytes_are_pairs(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (byte_at(text, i) < 0x80) continue;
    if (byte_at(text, i) < 0xA1 || i + 1 >= text.size() || byte_at(text, i + 1) < 0xA1) return false;
    ++i;
  }
  return true;
}

struct Conversion {
  std::string text;
  bool is_valid = true;  // but for a letter that the end of the text cuts off
};

/// The text in another encoding that iconv knows; `mark`, in the new one, for every byte that is invalid.
Conversion converted(std::string_view text, const char* from, const char* to, std::string_view mark) {
  const iconv_t converter = iconv_open(to, from);
  if (converter == reinterpret_cast<iconv_t>(-1)) return {valid_utf8(text)};
  std::string source(text), result(3 * text.size() + 4, '\0');
  char *in = source.data(), *out = result.data();
  std::size_t in_left = source.size(), out_left = result.size();
  bool is_valid = true, is_cut_off = false;
  while (in_left > 0 && iconv(converter, &in, &in_left, &out, &out_left) == static_cast<std::size_t>(-1)) {
    is_cut_off = is_cut_off || errno == EINVAL;
    is_valid = is_valid && is_cut_off;
    out = std::ranges::copy(mark, out).out;
    out_left -= mark.size();
    ++in;
    --in_left;
  }
  iconv_close(converter);
  result.resize(result.size() - out_left);
  return {std::move(result), is_valid};
}

/// UTF-16 has no more letters than there are, where UTF-8 from itself lets those beyond Unicode through.
Conversion utf16_from_utf8(std::string_view text) {
  return converted(text, "UTF-8", "UTF-16LE", "\xFD\xFF");
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
  if (utf16_from_utf8(head).is_valid) return Encoding::utf8;
  return high_bytes_are_pairs(head) ? Encoding::gbk : Encoding::latin1;
}

std::string to_utf8(std::string_view text, Encoding encoding) {
  if (encoding == Encoding::latin1) return converted(text, "ISO-8859-1", "UTF-8", "?").text;
  if (encoding == Encoding::gbk) return converted(text, "GBK", "UTF-8", "?").text;
  return std::string(text);
}

std::string valid_utf8(std::string_view text) {
  return converted(utf16_from_utf8(text).text, "UTF-16LE", "UTF-8", "").text;
}

std::size_t byte_order_mark(std::string_view head) {
  return head.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
}

}  // namespace tribofit
