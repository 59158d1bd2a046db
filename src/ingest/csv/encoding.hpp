#pragma once

#include <string>
#include <string_view>

namespace tribofit {

enum class Encoding { utf8, latin1, gbk };

/// Whether `head`, the beginning of a file, is lines of 8-bit text: no UTF-16, spreadsheet, archive or other binary
/// file.
bool is_text(std::string_view head);

/// Throws an InputError that says what the file is, unless it is text.
void refuse_unless_text(std::string_view head, const std::string& path);

/// The encoding of the letters outside ASCII in `head`.
///
/// Valid UTF-8 is UTF-8: other encodings hardly produce it by chance. Otherwise Chinese text in GBK has its high bytes
/// in pairs, the first from 0xA1 and the second from 0xA1, where Latin-1 has single ones (degree, micro, umlauts).
Encoding guess_encoding(std::string_view head);

/// `text` in UTF-8. What cannot be decoded becomes '?'.
std::string to_utf8(std::string_view text, Encoding encoding);

/// The text with U+FFFD for every byte that is not of a letter in UTF-8: names of files need not be.
std::string valid_utf8(std::string_view text);

/// Length of the UTF-8 byte order mark at the start, 0 or 3.
std::size_t byte_order_mark(std::string_view head);

}  // namespace tribofit
