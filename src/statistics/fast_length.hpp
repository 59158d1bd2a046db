#pragma once

#include <cstddef>

namespace tribofit {

/// Next even length with no prime factor above five, n or more: the transform of another may take as many steps for
/// each value as its largest prime factor has ones.
inline std::size_t fast_length(std::size_t n) {
  for (;; ++n) {
    std::size_t rest = n;
    for (const std::size_t p : {2u, 3u, 5u}) {
      while (rest > 0 && rest % p == 0) rest /= p;
    }
    if (rest == 1 && n % 2 == 0) return n;
  }
}

}  // namespace tribofit
