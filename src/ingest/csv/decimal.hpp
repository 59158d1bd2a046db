#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tribofit {

/// Bytes behind a number that read_decimal() may look at.
inline constexpr std::size_t kReadBeyond = 8;

/// Up to eight digits at once.
struct Digits {
  std::uint64_t value = 0;
  std::size_t count = 0;
};

/// The digits at the beginning of eight characters, the first of which is the lowest byte: neighbours are joined to
/// pairs, pairs to fours, fours to eight (D. Lemire and others, "Quickly parsing eight digits").
inline Digits leading_digits(std::uint64_t characters) {
  constexpr std::uint64_t kZeros = 0x3030303030303030, kHigh = 0x8080808080808080, kBeyondNine = 0x7676767676767676;
  const std::uint64_t off = characters ^ kZeros;  // 0 to 9 where there is a digit
  const std::uint64_t others = ((off & ~kHigh) + kBeyondNine) | off;
  Digits digits;
  digits.count = static_cast<std::size_t>(std::countr_zero(others & kHigh)) / 8;
  if (digits.count == 0) return digits;
  std::uint64_t value = off << (64 - 8 * digits.count);  // zeros before the first
  value = value * 10 + (value >> 8);
  constexpr std::uint64_t kPairs = 0x000000FF000000FF;
  digits.value = ((value & kPairs) * 0x000F424000000064 + ((value >> 16) & kPairs) * 0x0000271000000001) >> 32;
  return digits;
}

/// Reads a decimal number at `text` exactly rounded, or says that it cannot. kReadBeyond bytes must be readable behind
/// the character that ends it.
///
/// Covers what traces are made of: digits with a decimal mark and perhaps an exponent, at most 19 digits with a value
/// up to 2^53, and a power of ten up to 10^22. Integer and power are then exact doubles, and their one product or
/// quotient is correctly rounded (Clinger 1990, "How to read floating point numbers accurately", the fast path).
/// Everything else is left to std::from_chars, which rounds correctly too.
/// Returns the end of the number, or nullptr when `text` must be read the long way.
inline const char* read_decimal(const char* text, char decimal, double& value) {
  static constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                      1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  static constexpr std::uint64_t whole_powers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
  const auto is_digit = [](char c) { return static_cast<unsigned char>(c - '0') < 10; };
  const bool negative = *text == '-';
  const char* at = text + negative;
  std::uint64_t digits = 0;
  const char* begin = at;
  for (; is_digit(*at); ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
  std::int64_t count = at - begin, exponent = 0;
  if (*at == decimal) {
    begin = ++at;
    if constexpr (std::endian::native == std::endian::little) {
      std::uint64_t characters = 0;
      std::memcpy(&characters, at, sizeof characters);
      const Digits some = leading_digits(characters);
      digits = digits * whole_powers[some.count] + some.value;
      at += some.count;
    }
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
