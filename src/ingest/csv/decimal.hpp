#pragma once

#include <cstdint>

namespace tribofit {

/// Reads a decimal number at `text` exactly rounded, or says that it cannot.
///
/// Covers what traces are made of: digits with a decimal mark and perhaps an exponent, at most 19 digits with a value
/// up to 2^53, and a power of ten up to 10^22. Integer and power are then exact doubles, and their one product or
/// quotient is correctly rounded (Clinger 1990, "How to read floating point numbers accurately", the fast path).
/// Everything else is left to std::from_chars, which rounds correctly too.
/// Returns the end of the number, or nullptr when `text` must be read the long way.
inline const char* read_decimal(const char* text, char decimal, double& value) {
  static constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                      1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  const auto is_digit = [](char c) { return static_cast<unsigned char>(c - '0') < 10; };
  const bool negative = *text == '-';
  const char* at = text + negative;
  std::uint64_t digits = 0;
  const char* begin = at;
  for (; is_digit(*at); ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
  std::int64_t count = at - begin, exponent = 0;
  if (*at == decimal) {
    begin = ++at;
    for (; is_digit(*at); ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
    exponent = begin - at;
    count -= exponent;
  }
  if (count == 0 || count > 19 || digits > (std::uint64_t{1} << 53)) return nullptr;
  if (*at == 'e' || *at == 'E') {
    const bool down = at[1] == '-';
    begin = at += (down || at[1] == '+') ? 2 : 1;
    std::int64_t power = 0;
    for (; is_digit(*at) && at - begin < 4; ++at) power = 10 * power + (*at - '0');
    if (at == begin) return nullptr;
    exponent += down ? -power : power;
  }
  if (exponent < -22 || exponent > 22) return nullptr;
  const double integer = static_cast<double>(digits);
  const double size = exponent < 0 ? integer / powers[-exponent] : integer * powers[exponent];
  value = negative ? -size : size;
  return at;
}

}  // namespace tribofit
