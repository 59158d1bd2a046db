#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace tribofit {

/// Escape sequences of a terminal, all empty without colour, and the width sentences are broken to.
struct Style {
  explicit Style(bool colour, std::size_t columns) : width(std::clamp<std::size_t>(columns, 40, 120)) {
    if (!colour) return;
    bold = "\033[1m";
    dim = "\033[2m";
    yellow = "\033[33m";
    red = "\033[31m";
    off = "\033[0m";
  }

  std::string heading(std::string_view text) const {
    return "\n" + std::string(bold) + std::string(text) + std::string(off) + "\n";
  }

  std::string_view bold, dim, yellow, red, off;
  std::size_t width;
};

}  // namespace tribofit
