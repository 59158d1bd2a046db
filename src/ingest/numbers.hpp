#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string_view>

namespace tribofit {

/// The number whose bytes stand at `at`, which must lie within: of this machine's kind, in the order that is said.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::array<char, sizeof(Number)> own;
  std::memcpy(own.data(), bytes.data() + at, own.size());
  if (big_endian != (std::endian::native == std::endian::big)) std::reverse(own.begin(), own.end());
  return std::bit_cast<Number>(own);
}

}  // namespace tribofit
