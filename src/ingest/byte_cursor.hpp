#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>

#include "numbers.hpp"

namespace tribofit {

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
