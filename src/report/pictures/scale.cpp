#include "report/pictures/scale.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "report/pictures/sizes.hpp"

namespace tribofit {
namespace {

constexpr std::string_view kMinus = "\xE2\x88\x92";

std::string with_minus(std::string text) {
  if (text.starts_with('-')) text.replace(0, 1, kMinus);
  return text;
}

/// "0.25", or "2.5·10^{-5}" where zeros would fill the axis.
std::string tic_text(double value, double step, double largest) {
  if (largest < 1e5 && step >= 0.99e-4) {
    const int places = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - 1e-9)));
    const double rounded = std::abs(value) < step / 1e3 ? 0 : value;
    // 2.5 needs a place more than its power of ten says.
    const double units = step * std::pow(10, places);
    return with_minus(fmt::format("{:.{}f}", rounded, places + (std::abs(units - std::round(units)) > 1e-6 ? 1 : 0)));
  }
  if (std::abs(value) < step / 1e3) return "0";
  const int power = static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9));
  const double factor = value / std::pow(10, power);
  const std::string exponent = "10^{" + with_minus(fmt::format("{}", power)) + "}";
  return with_minus(fmt::format("{:.4g}", factor)) + "\xC2\xB7" + exponent;
}

/// The least of 1, 2, 2.5 and 5 times a power of ten that gives at most `most` steps.
double step_for(double width, int most) {
  const double least = width / std::max(most, 1);
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 2.5, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

void add_even_tics(Scale& scale, int most) {
  constexpr int kMore = 3;  // one tic alone shows no scale
  const double largest = std::max(std::abs(scale.low), std::abs(scale.high));
  double step = 0, first = 0, last = 0;
  for (const int up_to = most + kMore; most <= up_to && last - first < 1; ++most) {
    step = step_for(scale.high - scale.low, most);
    first = std::ceil(scale.low / step - 1e-6), last = std::floor(scale.high / step + 1e-6);
  }
  for (int k = 0; k <= most && first + k <= last; ++k) {
    scale.tics.push_back({(first + k) * step, tic_text((first + k) * step, step, largest)});
  }
}

std::string decade_text(int power) {
  if (power >= -3 && power <= 4) return fmt::format("{:.{}f}", std::pow(10, power), std::max(0, -power));
  return "10^{" + with_minus(fmt::format("{}", power)) + "}";
}

/// Powers of ten; within less than two of them 1, 2 and 5 times as well.
void add_logarithmic_tics(Scale& scale, int most) {
  const int first = static_cast<int>(std::floor(std::log10(scale.low) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(scale.high) - 1e-9));
  const bool few = std::log10(scale.high / scale.low) < 2;
  const int every = std::max(1, (last - first + most - 1) / std::max(most, 1));
  for (int power = first; power <= last; power += every) {
    for (const int factor : few ? std::vector<int>{1, 2, 5} : std::vector<int>{1}) {
      const double at = factor * std::pow(10, power);
      if (at < scale.low * (1 - 1e-9) || at > scale.high * (1 + 1e-9)) continue;
      const std::string text = factor == 1 ? decade_text(power) : tic_text(at, at, at);
      scale.tics.push_back({at, text});
    }
  }
  if (scale.tics.size() < 2) {
    scale.tics.clear();
    add_even_tics(scale, most);
  }
}

void widen(Scale& scale, double margin, const ChartAxis& axis) {
  const bool low_given = std::isfinite(axis.low), high_given = std::isfinite(axis.high);
  if (!(scale.low < scale.high)) {
    const double half = scale.low == 0 ? 1 : 0.05 * std::abs(scale.low);
    scale.low -= scale.logarithmic ? 0.5 * scale.low : half;
    scale.high += half;
  } else if (scale.logarithmic) {
    const double factor = std::pow(scale.high / scale.low, margin);
    if (!low_given) scale.low /= factor;
    if (!high_given) scale.high *= factor;
  } else {
    const double more = margin * (scale.high - scale.low);
    if (!low_given && !(axis.from_zero && scale.low == 0)) scale.low -= more;
    if (!high_given && !(axis.from_zero && scale.high == 0)) scale.high += more;
  }
}

void set_range(Scale& scale, const ChartAxis& axis, const Extent& extent, double margin) {
  if (!axis.names.empty()) {
    scale.low = -0.5;
    scale.high = static_cast<double>(axis.names.size()) - 0.5;
    return;
  }
  const auto usable = [&](double value) { return std::isfinite(value) && (!axis.logarithmic || value > 0); };
  scale.low = extent.empty() ? (axis.logarithmic ? 1 : 0) : extent.low();
  scale.high = extent.empty() ? (axis.logarithmic ? 10 : 1) : extent.high();
  if (axis.from_zero && !axis.logarithmic) {
    scale.low = std::min(scale.low, 0.0);
    scale.high = std::max(scale.high, 0.0);
  }
  if (usable(axis.low)) scale.low = axis.low;
  if (usable(axis.high)) scale.high = axis.high;
  if (scale.low > scale.high) std::swap(scale.low, scale.high);
  widen(scale, margin, axis);
}

}  // namespace

double Scale::part(double value) const {
  if (logarithmic && !(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  const double along = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  return falling ? 1 - along : along;
}

void Extent::add(double value) {
  if (!std::isfinite(value) || (logarithmic_ && value <= 0)) return;
  low_ = std::min(low_, value);
  high_ = std::max(high_, value);
}

Scale scale_of(const ChartAxis& axis, const Extent& extent, double margin, int most_tics) {
  Scale scale;
  scale.named = !axis.names.empty();
  scale.logarithmic = axis.logarithmic && !scale.named;
  scale.falling = axis.falling;
  scale.title = axis.unit.empty() ? axis.quantity : axis.quantity + " [" + axis.unit + "]";
  set_range(scale, axis, extent, margin);
  if (scale.named) {
    const std::size_t every = (axis.names.size() + sizes.most_names - 1) / sizes.most_names;
    for (std::size_t k = 0; k < axis.names.size(); k += every)
      scale.tics.push_back({static_cast<double>(k), axis.names[k]});
  } else if (scale.logarithmic) {
    add_logarithmic_tics(scale, most_tics);
  } else {
    add_even_tics(scale, most_tics);
  }
  return scale;
}

}  // namespace tribofit
