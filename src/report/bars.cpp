#include "bars.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tribofit {

BarSigns bar_signs(bool unicode) {
  return unicode ? BarSigns{"\u2591", "\u2588"} : BarSigns{"-", "#"};
}

std::string bar(double value, double full, std::size_t columns, bool unicode, double pale) {
  static constexpr std::array<const char*, 8> eighths = {"",       "\u258f", "\u258e", "\u258d",
                                                         "\u258c", "\u258b", "\u258a", "\u2589"};
  if (!(full > 0) || !std::isfinite(value)) return "";
  const double width = static_cast<double>(columns);
  const double length = std::clamp(value / full, 0.0, 1.0) * width;
  const auto light = static_cast<std::size_t>(std::round(std::min(std::clamp(pale / full, 0.0, 1.0) * width, length)));
  const auto [pale_sign, full_sign] = bar_signs(unicode);
  std::string text;
  for (std::size_t k = 0; k < light; ++k) text += pale_sign;
  double left = length - static_cast<double>(light);
  if (!unicode) left = std::round(left);
  for (; left >= 1; left -= 1) text += full_sign;
  if (unicode && left > 0) text += eighths[static_cast<std::size_t>(8 * left)];
  return text;
}

}  // namespace tribofit
