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

}  // namespace tribofit
