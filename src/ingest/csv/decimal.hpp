#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace tribofit {

/// Bytes behind a number that read_decimal() may look at: a sign, up to seven digits, a mark and eight characters.
inline constexpr std::size_t kReadBeyond = 18;

inline bool is_digit(char c) {
  return static_cast<unsigned char>(c - '0') < 10;
}

/// Eight characters, the first of which is the lowest byte; each is 0 to 9 where a digit stands.
inline std::uint64_t digits_at(const char* text) {
  std::uint64_t characters = 0;
  std::memcpy(&characters, text, sizeof characters);
  return characters ^ 0x3030303030303030;
}

/// The high bit of each byte that is no digit.
inline std::uint64_t others_in(std::uint64_t digits) {
  constexpr std::uint64_t kHigh = 0x8080808080808080, kBeyondNine = 0x7676767676767676;
  return (((digits & ~kHigh) + kBeyondNine) | digits) & kHigh;
}

/// The number that eight digits make: neighbours are joined to pairs, pairs to fours, fours to eight (D. Lemire and
/// others, "Quickly parsing eight digits").
inline std::uint64_t joined(std::uint64_t digits) {
  digits = digits * 10 + (digits >> 8);
  constexpr std::uint64_t kPairs = 0x000000FF000000FF;
  return ((digits & kPairs) * 0x000F424000000064 + ((digits >> 16) & kPairs) * 0x0000271000000001) >> 32;
}

/// Digits before and after the decimal mark of a number, one at least of each and eight at most together. Neighbours in
/// a column mostly have the same form, and where it is known a number need not be searched for its end: half the time.
struct DecimalForm {
  std::size_t whole = 1, fraction = 1;
};

/// Reads a decimal number at `text` exactly rounded, or says that it cannot. kReadBeyond bytes must be readable behind
/// the character that ends it. `form` is that of the number before it, and becomes that of this one.
///
/// Covers what traces are made of: digits with a decimal mark and perhaps an exponent, at most 19 digits with a value
/// up to 2^53, and a power of ten up to 10^22. Integer and power are then exact doubles, and their one product or
/// quotient is correctly rounded (Clinger 1990, "How to read floating point numbers accurately", the fast path).
/// Everything else is left to std::from_chars, which rounds correctly too.
/// Returns the end of the number, or nullptr when `text` must be read the long way.
[[gnu::noinline]] inline const char* read_any_decimal(const char* text, char decimal, double& value,
                                                      DecimalForm& form) {
  static constexpr double powers[] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                      1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};
  static constexpr std::uint64_t whole_powers[] = {1, 10, 100, 1000, 10000, 100000, 1000000, 10000000, 100000000};
  const bool negative = *text == '-';
  const char* at = text + negative;
  std::uint64_t digits = 0;
  const char* begin = at;
  for (; is_digit(*at); ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
  std::int64_t count = at - begin, exponent = 0;
  if (*at == decimal) {
    begin = ++at;
    if constexpr (std::endian::native == std::endian::little) {
      const std::uint64_t next = digits_at(at);
      const auto some = static_cast<std::size_t>(std::countr_zero(others_in(next))) / 8;
      if (some > 0) digits = digits * whole_powers[some] + joined(next << (64 - 8 * some));  // zeros before the first
      at += some;
    }
    for (; is_digit(*at); ++at) digits = 10 * digits + static_cast<std::uint64_t>(*at - '0');
    exponent = begin - at;
    if (count > 0 && exponent < 0 && count - exponent <= 8) {
      form = {static_cast<std::size_t>(count), static_cast<std::size_t>(-exponent)};
    }
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

/// As read_any_decimal(), in one look where the number has the form of the one before it.
[[gnu::always_inline]] inline const char* read_decimal(const char* text, char decimal, double& value,
                                                       DecimalForm& form) {
  if constexpr (std::endian::native == std::endian::little) {
    static constexpr double powers[] = {1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7};
    const bool negative = *text == '-';
    const char* begin = text + negative;
    const char* mark = begin + form.whole;
    const char* end = mark + 1 + form.fraction;
    const std::uint64_t digits = (digits_at(mark + 1) << (64 - 8 * form.fraction)) |
                                 ((digits_at(begin) << (64 - 8 * form.whole)) >> (8 * form.fraction));
    if (*mark == decimal && others_in(digits) == 0 && !is_digit(*end) && (*end | 0x20) != 'e') [[likely]] {
      const double size = static_cast<double>(joined(digits)) / powers[form.fraction];
      value = negative ? -size : size;
      return end;
    }
  }
  return read_any_decimal(text, decimal, value, form);
}

}  // namespace tribofit
