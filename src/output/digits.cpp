#include "tribofit/output/digits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tribofit {
namespace {

/// Power of ten of the first digit, after rounding to `digits` digits (0.0996 to two digits is 0.10).
int leading_power(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return 0;
  const std::string text = fmt::format("{:.{}e}", std::abs(value), digits - 1);
  return std::stoi(text.substr(text.find('e') + 1));
}

/// "0.0" for "-0.0" and "+0.0": what is rounded away has no sign.
std::string without_sign_of_zero(std::string text) {
  const bool is_zero = text.find_first_of("123456789") == std::string::npos;
  return is_zero && (text[0] == '-' || text[0] == '+') ? text.substr(1) : text;
}

}  // namespace

std::string general(double value, int digits) {
  return fmt::format("{:.{}g}", value, digits);
}

std::string general_with_sign(double value, int digits) {
  return fmt::format("{:+.{}g}", value, digits);
}

std::string significant(double value, int digits) {
  if (!std::isfinite(value)) return "-";
  if (value == 0) return "0";
  const int power = leading_power(value, digits);
  if (power < -4 || power > 6) return fmt::format("{:.{}e}", value, digits - 1);
  return fmt::format("{:.{}f}", value, std::max(0, digits - 1 - power));
}

std::string brief(double value) {
  constexpr double kWritable = 1e7;  // beyond it zeros are no longer counted at a glance
  if (!std::isfinite(value)) return "-";
  const double size = std::abs(value);
  return size >= 1e4 && size < kWritable ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

int places_for(double std_error) {
  constexpr int kMostPlaces = 8;
  if (!std::isfinite(std_error) || std_error <= 0) return kMostPlaces;
  return 1 - leading_power(std_error, 2);
}

std::string fixed(double value, int places) {
  if (!std::isfinite(value)) return "-";
  if (places >= 0) return without_sign_of_zero(fmt::format("{:.{}f}", value, std::min(places, 12)));
  const double step = std::pow(10.0, -places);
  return fmt::format("{:.0f}", std::round(value / step) * step);
}

std::string with_sign(double value, int places, std::string_view more) {
  return std::isfinite(value) ? without_sign_of_zero(fmt::format("{:+.{}f}", value, places)) + std::string(more) : "-";
}

std::string with_error(double value, double std_error) {
  if (!std::isfinite(value)) return "-";
  if (!std::isfinite(std_error) || std_error <= 0) return significant(value, 4);
  constexpr double kAbsurd = 1e-6;  // more than six digits of a measured value mislead
  if (std_error < kAbsurd * std::abs(value)) return significant(value, 6) + " +/- " + significant(std_error, 1);
  const int places = places_for(std_error);
  return fixed(value, places) + " +/- " + fixed(std_error, places);
}

std::string percent(double share) {
  if (!std::isfinite(share)) return "-";
  const double value = 100 * share, size = std::abs(value);
  if (value != 0 && size < 0.001) return "< 0.001 %";
  const int places = value == 0 || size >= 10 ? 0 : size >= 1 ? 1 : size >= 0.01 ? 2 : 3;
  return fmt::format("{:.{}f} %", value, places);
}

std::string share_text(double share) {
  if (!std::isfinite(share)) return "-";
  const int decimals = share > 0.9995 ? 2 : 1;
  const double step = std::pow(10.0, -decimals);
  return fmt::format("{:.{}f} %", std::floor(100 * share / step) * step, share >= 1 ? 0 : decimals);
}

std::string grouped(std::size_t count) {
  std::string text = std::to_string(count);
  for (std::size_t at = text.size(); at > 3; at -= 3) text.insert(at - 3, " ");
  return text;
}

std::string interval_text(double lower, double upper, int places) {
  if (!std::isfinite(lower) && !std::isfinite(upper)) return "-";
  return "[" + fixed(lower, places) + ", " + fixed(upper, places) + "]";
}

std::string p_value_text(double p_value) {
  return p_value < 1e-4 ? "p < 0.0001" : "p = " + significant(p_value, 2);
}

}  // namespace tribofit
