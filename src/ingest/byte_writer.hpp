#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace tribofit {

/// Whether numbers of this machine begin with their highest byte.
inline constexpr bool native_big_endian = std::endian::native == std::endian::big;

/// Puts numbers, in the order of this machine, and texts into bytes, from which ByteCursor takes them.
class ByteWriter {
 public:
  explicit ByteWriter(std::string_view begin = {}) : bytes_(begin) {}

  template <class Number>
  ByteWriter& number(Number value) {
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof value);
    std::memcpy(bytes_.data() + at, &value, sizeof value);
    return *this;
  }
  ByteWriter& text(std::string_view value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_ += value;
    return *this;
  }
  ByteWriter& raw(std::string_view value) {
    if (bytes_.capacity() - bytes_.size() < value.size()) bytes_.reserve(2 * bytes_.size() + value.size());
    bytes_ += value;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace tribofit
