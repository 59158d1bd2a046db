#include "content_hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "ingest/input_file.hpp"

namespace tribofit {
namespace {

constexpr std::uint64_t kPrime1 = 0x9E3779B185EBCA87ULL, kPrime2 = 0xC2B2AE3D27D4EB4FULL,
                        kPrime3 = 0x165667B19E3779F9ULL, kPrime4 = 0x85EBCA77C2B2AE63ULL,
                        kPrime5 = 0x27D4EB2F165667C5ULL;

/// Words are those of a little-endian machine, on which results may be compared.
std::uint64_t word_at(const char* at) {
  std::uint64_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}

std::uint64_t round_of(std::uint64_t lane, std::uint64_t word) {
  return std::rotl(lane + word * kPrime2, 31) * kPrime1;
}

std::uint64_t merged(std::uint64_t hash, std::uint64_t lane) {
  return (hash ^ round_of(0, lane)) * kPrime1 + kPrime4;
}

/// Takes the stripes of 32 bytes; leaves `at` behind them.
std::uint64_t hash_of_stripes(const char*& at, const char* end, std::uint64_t seed) {
  std::array<std::uint64_t, 4> lanes = {seed + kPrime1 + kPrime2, seed + kPrime2, seed, seed - kPrime1};
  for (; end - at >= 32; at += 32) {
    for (std::size_t k = 0; k < 4; ++k) lanes[k] = round_of(lanes[k], word_at(at + 8 * k));
  }
  std::uint64_t hash =
      std::rotl(lanes[0], 1) + std::rotl(lanes[1], 7) + std::rotl(lanes[2], 12) + std::rotl(lanes[3], 18);
  for (const std::uint64_t lane : lanes) hash = merged(hash, lane);
  return hash;
}

}  // namespace

std::uint64_t xxh64(std::string_view bytes, std::uint64_t seed) {
  const char *at = bytes.data(), *end = at + bytes.size();
  std::uint64_t hash = bytes.size() >= 32 ? hash_of_stripes(at, end, seed) : seed + kPrime5;
  hash += bytes.size();
  for (; end - at >= 8; at += 8) hash = std::rotl(hash ^ round_of(0, word_at(at)), 27) * kPrime1 + kPrime4;
  if (end - at >= 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, at, sizeof word);
    hash = std::rotl(hash ^ (word * kPrime1), 23) * kPrime2 + kPrime3;
    at += 4;
  }
  for (; at < end; ++at) hash = std::rotl(hash ^ (static_cast<unsigned char>(*at) * kPrime5), 11) * kPrime1;
  hash = (hash ^ (hash >> 33)) * kPrime2;
  hash = (hash ^ (hash >> 29)) * kPrime3;
  return hash ^ (hash >> 32);
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
