#pragma once

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <vector>

#include "json_parts.hpp"

namespace tribofit {

/// Digits of what is drawn: finer than any screen; times need more, so that 20 us are distinguishable after an hour.
inline constexpr int kDigits = 5, kTimeDigits = 9;

/// A number with no more digits than are drawn, so that a page stays small; null for what is not known.
inline Json rounded(double value, int digits = kDigits) {
  if (!std::isfinite(value)) return nullptr;
  std::array<char, 40> text = {};
  const auto end = fmt::format_to_n(text.data(), text.size(), "{:.{}g}", value, digits).out;
  std::from_chars(text.data(), end, value);
  return value;
}

inline Json numbers_json(std::span<const double> values, int digits = kDigits) {
  Json list = Json::array();
  for (const double value : values) list.push_back(rounded(value, digits));
  return list;
}

}  // namespace tribofit
