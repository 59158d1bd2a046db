#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace tribofit {

/// XXH64 of Y. Collet (libxxhash): a 64-bit hash in which every bit of the input moves every bit of the result, at the
/// speed of memory. seed: what came before, where a hash is made of parts.
std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed = 0);

/// The same of the eight bytes of a number, in the order of the machine.
std::uint64_t xxh64(std::uint64_t number, std::uint64_t seed);

/// Hash of the contents of files in their order. Throws InputError for one that cannot be read. Cost: linear in bytes;
/// memory: a block of 256 KB.
std::uint64_t content_hash(std::span<const std::string> paths);

/// 16 hexadecimal digits.
std::string hexadecimal(std::uint64_t hash);

}  // namespace tribofit
