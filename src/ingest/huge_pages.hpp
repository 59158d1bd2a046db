#pragma once

#include <sys/mman.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tribofit {

/// Asks for memory in pages of 2 MB for so many values: a column of millions of numbers is touched for the first time
/// here, and page by page that costs as much as reading the numbers. Only an advice; nothing depends on it.
inline void prefer_huge_pages(std::vector<double>& values, std::size_t count) {
  constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
  const auto begin = (reinterpret_cast<std::uintptr_t>(values.data()) + page - 1) & ~(page - 1);
  const auto end = reinterpret_cast<std::uintptr_t>(values.data() + std::min(count, values.capacity())) & ~(page - 1);
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);
}

/// Has the memory for values [from, to), which is reserved, made present now and not at the first touch, which waits
/// for it: by a thread that nobody waits for. Only an advice; nothing depends on it.
inline void make_present(double* values, std::size_t from, std::size_t to) {
#ifdef MADV_POPULATE_WRITE
  constexpr std::uintptr_t page = 4096;
  const auto page_of = [&](std::size_t i) { return reinterpret_cast<std::uintptr_t>(values + i) & ~(page - 1); };
  const std::uintptr_t begin = page_of(from) + page, end = page_of(to);
  if (begin < end) ::madvise(reinterpret_cast<void*>(begin), end - begin, MADV_POPULATE_WRITE);
#else
  static_cast<void>(values), static_cast<void>(from), static_cast<void>(to);
#endif
}

}  // namespace tribofit
