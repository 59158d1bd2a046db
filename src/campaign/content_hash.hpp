#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tribofit {

/// XXH64 of Y. Collet: a 64-bit hash in which every bit of the input moves every bit of the result, at the speed of
/// memory. (The checksum of a trace, FNV-1a by words, sees a file being damaged, but two digits changed in the right
/// places may cancel.)
std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed = 0);

/// Hash of the contents of files in their order. Throws InputError for one that cannot be read. Cost: linear in bytes;
/// memory: a block of 256 KB.
std::uint64_t content_hash(std::span<const std::string> paths);

/// 16 hexadecimal digits.
std::string hexadecimal(std::uint64_t hash);

}  // namespace tribofit
