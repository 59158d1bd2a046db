#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <string_view>
#include <utility>

namespace tribofit {

/// Whether numbers of this machine begin with their highest byte.
inline constexpr bool native_big_endian = std::endian::native == std::endian::big;

/// The number whose bytes stand at `at`, which must lie within: of this machine's kind, in the order that is said.
template <class Number>
Number number_at(std::string_view bytes, std::size_t at, bool big_endian) {
  std::array<char, sizeof(Number)> own;
  std::memcpy(own.data(), bytes.data() + at, own.size());
  if (big_endian != native_big_endian) std::reverse(own.begin(), own.end());
  return std::bit_cast<Number>(own);
}

/// A type of numbers in a binary file: its length, and how one becomes a double.
struct NumberType {
  std::size_t bytes;
  double (*at)(std::string_view bytes, std::size_t at, bool big_endian);
};
template <class Number>
inline constexpr NumberType number_type = {sizeof(Number), [](std::string_view bytes, std::size_t at, bool big_endian) {
                                             return static_cast<double>(number_at<Number>(bytes, at, big_endian));
                                           }};

/// Takes numbers and texts from bytes, one after the other.
class ByteCursor {
 public:
  /// `cut_off(wanted, left)` throws, where fewer bytes are left than are wanted.
  using CutOff = std::function<void(std::uint64_t wanted, std::uint64_t left)>;
  ByteCursor(std::string bytes, CutOff cut_off) : bytes_(std::move(bytes)), cut_off_(std::move(cut_off)) {}

  std::size_t position() const { return at_; }
  const std::string& bytes() const { return bytes_; }

  /// Makes sure that `count` parts of `size` bytes are left.
  void need(std::uint64_t count, std::uint64_t size) const {
    const std::uint64_t left = bytes_.size() - at_;
    if (size != 0 && count > left / size) cut_off_(count * size, left);
  }
  void skip(std::uint64_t size) {
    need(size, 1);
    at_ += static_cast<std::size_t>(size);
  }
  template <class Number>
  Number number(bool big_endian) {
    need(1, sizeof(Number));
    const auto value = number_at<Number>(bytes_, at_, big_endian);
    at_ += sizeof(Number);
    return value;
  }
  /// A text behind its length.
  std::string text(bool big_endian) {
    const auto length = number<std::uint32_t>(big_endian);
    skip(length);
    return bytes_.substr(at_ - length, length);
  }

 private:
  std::string bytes_;
  CutOff cut_off_;
  std::size_t at_ = 0;
};

}  // namespace tribofit
