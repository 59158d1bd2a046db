#include "report/pictures/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace tribofit {
namespace {

/// "0.25", "−3".
std::string decimal(double value, int places) {
  const std::string text = fmt::format("{:.{}f}", value, places);
  return text.starts_with('-') ? "\xE2\x88\x92" + text.substr(1) : text;
}

std::string power_of_ten(int power) {
  return "10^{" + decimal(power, 0) + "}";
}

/// "0.25", or "2.5·10^{-5}" where zeros would fill the axis.
std::string tic_text(double value, double step, double largest) {
  const bool is_zero = std::abs(value) < step / 1e3;
  if (largest < 1e5 && step >= 0.99e-4) {
    const int places = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    // 2.5 needs a place more than its power of ten says.
    const double units = step * std::pow(10, places);
    return decimal(is_zero ? 0 : value, places + (std::abs(units - std::round(units)) > 1e-6 ? 1 : 0));
  }
  if (is_zero) return "0";
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
  const std::string factor = fmt::format("{:.4g}", std::abs(value) / std::pow(10, power));
  return (value < 0 ? "\xE2\x88\x92" : "") + factor + "\xC2\xB7" + power_of_ten(power);
}

/// The least of 1, 2, 2.5 and 5 times a power of ten that gives at most `most` steps.
double step_for(double width, int most) {
  const double least = width / std::max(most, 1), power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::vector<Scale::Tic> even_tics(double low, double high, int most) {
  constexpr int kMore = 3;  // one tic alone shows no scale
  double step = 0, first = 0, last = 0;
  for (const int up_to = most + kMore; most <= up_to && last - first < 1; ++most) {
    step = step_for(high - low, most);
    first = std::ceil(low / step - 1e-6), last = std::floor(high / step + 1e-6);
  }
  std::vector<Scale::Tic> tics;
  for (int k = 0; k <= most && first + k <= last; ++k) {
    const double at = (first + k) * step;
    tics.push_back({at, tic_text(at, step, std::max(std::abs(low), std::abs(high)))});
  }
  return tics;
}

/// Powers of ten; within less than two of them 1, 2 and 5 times as well. Ends are logarithms.
std::vector<Scale::Tic> logarithmic_tics(double low, double high, int most) {
  const int first = static_cast<int>(std::floor(low + 1e-9)), last = static_cast<int>(std::ceil(high - 1e-9));
  const bool few = high - low < 2;
  const int every = std::max(1, (last - first + most - 1) / std::max(most, 1));
  std::vector<Scale::Tic> tics;
  for (int power = first; power <= last; power += every) {
    for (const int factor : few ? std::vector<int>{1, 2, 5} : std::vector<int>{1}) {
      const double at = factor * std::pow(10, power), place = std::log10(at);
      if (place < low - 1e-9 || place > high + 1e-9) continue;
      const bool plain = factor > 1 || (power >= -3 && power <= 4);
      tics.push_back({at, plain ? tic_text(at, at, at) : power_of_ten(power)});
    }
  }
  return tics.size() < 2 ? even_tics(std::pow(10, low), std::pow(10, high), most) : tics;
}

void set_range(Scale& scale, const ChartAxis& axis, const Extent& extent, double margin) {
  const bool has_zero = axis.from_zero && !scale.logarithmic;
  if (extent.low <= extent.high) scale.low = extent.low, scale.high = extent.high;
  if (has_zero) scale.low = std::min(scale.low, 0.0), scale.high = std::max(scale.high, 0.0);
  const double low = along(axis.low, scale.logarithmic), high = along(axis.high, scale.logarithmic);
  if (std::isfinite(low)) scale.low = low;
  if (std::isfinite(high)) scale.high = high;
  if (scale.low > scale.high) std::swap(scale.low, scale.high);
  if (!(scale.low < scale.high)) {
    const double half = scale.logarithmic ? std::log10(2) : scale.low == 0 ? 1 : 0.05 * std::abs(scale.low);
    scale.low -= half;
    scale.high += half;
    return;
  }
  const double more = margin * (scale.high - scale.low);
  if (!std::isfinite(low) && !(has_zero && scale.low == 0)) scale.low -= more;
  if (!std::isfinite(high) && !(has_zero && scale.high == 0)) scale.high += more;
}

}  // namespace

Scale scale_of(const ChartAxis& axis, const Extent& extent, double margin, int most_tics) {
  Scale scale;
  scale.named = !axis.names.empty();
  scale.logarithmic = axis.logarithmic && !scale.named;
  scale.title = axis.unit.empty() ? axis.quantity : axis.quantity + " [" + axis.unit + "]";
  if (scale.named) {
    scale.low = -0.5;
    scale.high = static_cast<double>(axis.names.size()) - 0.5;
    const std::size_t every = (axis.names.size() + sizes.most_names - 1) / sizes.most_names;
    for (std::size_t k = 0; k < axis.names.size(); k += every)
      scale.tics.push_back({static_cast<double>(k), axis.names[k]});
    return scale;
  }
  set_range(scale, axis, extent, margin);
  scale.tics = scale.logarithmic ? logarithmic_tics(scale.low, scale.high, most_tics)
                                 : even_tics(scale.low, scale.high, most_tics);
  return scale;
}

}  // namespace tribofit
