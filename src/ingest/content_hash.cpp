#include "content_hash.hpp"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <vector>

#include "input_file.hpp"

namespace tribofit {

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed) {
  return XXH64(bytes.data(), bytes.size(), seed);
}

std::uint64_t xxh64(std::uint64_t number, std::uint64_t seed) {
  return XXH64(&number, sizeof number, seed);
}

std::uint64_t content_hash(std::span<const std::string> paths) {
  constexpr std::uint64_t kBlock = std::uint64_t{1} << 18;
  std::uint64_t hash = 0;
  for (const std::string& path : paths) {
    const InputFile file(path);
    std::vector<char> block(static_cast<std::size_t>(std::min(kBlock, file.size() + 1)));
    std::uint64_t at = 0;
    for (std::size_t count = block.size(); count == block.size(); at += count) {
      count = file.read(at, block);
      hash = xxh64({block.data(), count}, hash);
    }
    hash = xxh64(std::to_string(at), hash);  // where one file ends and the next begins
  }
  return hash;
}

std::string hexadecimal(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

}  // namespace tribofit
