#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace tribofit {

/// Whether numbers of this machine begin with their highest byte.
inline constexpr bool native_big_endian = std::endian::native == std::endian::big;

/// The number whose bytes stand at `at`, which must lie within: of this machine's kind, in the order that is said.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::array<char, sizeof(Number)> own;
  std::memcpy(own.data(), bytes.data() + at, own.size());
  if (big_endian != native_big_endian) std::reverse(own.begin(), own.end());
  return std::bit_cast<Number>(own);
}

/// A type of numbers in a binary file: its length, and how one becomes a double.
struct NumberType {
  std::size_t bytes;
  double (*at)(std::string_view bytes, std::size_t at, bool big_endian);
};
template <class Number>
inline constexpr NumberType number_type = {sizeof(Number), [](std::string_view bytes, std::size_t at, bool big_endian) {
                                             return static_cast<double>(number_at<Number>(bytes, at, big_endian));
                                           }};

}  // namespace tribofit
