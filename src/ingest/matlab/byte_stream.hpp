#pragma once

#include <zlib.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "ingest/input_file.hpp"

namespace tribofit {

/// The bytes of a variable of a MATLAB file, one after the other: as they stand in the file, or inflated.
class ByteStream {
 public:
  /// Bytes [begin, end) of the file, inflated to `most` bytes at the most.
  ByteStream(const InputFile& file, std::uint64_t begin, std::uint64_t end, bool inflate, std::uint64_t most = 0);
  ~ByteStream();
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;

  /// Fills the buffer. Throws InputError with the offset in the file where there are not as many bytes.
  void read(std::span<char> buffer);
  void skip(std::uint64_t count);
  /// Bytes read or skipped so far.
  std::uint64_t position() const { return position_; }
  /// How many may follow: of an inflated stream, what is left of the most.
  std::uint64_t most_left() const;

  [[noreturn]] void refuse(const std::string& problem) const;
  /// The file holds more values than one of its size may.
  [[noreturn]] void refuse_bomb() const;
  /// Throws InputError where `size` bytes of `what` cannot follow.
  void expect(std::uint64_t size, const std::string& what) const;

 private:
  void read_inflated(std::span<char> buffer);

  const InputFile& file_;
  std::uint64_t begin_, at_, end_, most_, position_ = 0;
  bool inflates_;
  z_stream z_{};
  std::array<char, 1 << 16> packed_;
};

}  // namespace tribofit
