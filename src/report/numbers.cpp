#include "numbers.hpp"

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

std::string friction_unit(const Motion& motion) {
  return motion.friction_kind == FrictionKind::force ? "N" : "1";
}

std::string shown_unit(const FitParameter& parameter, const Motion& motion) {
  const std::string& unit = parameter.parameter.unit;
  const bool in_newtons = unit.starts_with('N');  // a fit to forces says so itself
  if (!parameter.parameter.scales_with_friction || in_newtons || friction_unit(motion) != "N") return unit;
  if (unit == "1") return "N";
  return unit.starts_with("1/") ? "N" + unit.substr(1) : "N " + unit;
}

double shown(const FitParameter& parameter, double value_in_si) {
  return value_in_si / parameter.parameter.si;
}

std::string full_name(const FitParameter& p) {
  return p.effect.empty() ? p.parameter.name : p.effect + "." + p.parameter.name;
}

std::string curve_name(const Fit& fit) {
  return fit.model.name() + (fit.protocol == Protocol::published ? ", " + protocol_text(fit.protocol) : "");
}

std::string limits_text(const FitParameter& p) {
  const double lower = shown(p, p.profile_lower95), upper = shown(p, p.profile_upper95);
  const double reach = 1e-6 * (p.parameter.upper - p.parameter.lower);
  const bool above = lower > p.parameter.lower + reach, below = upper < p.parameter.upper - reach;
  if (above && below) return fmt::format("{} to {}", significant(lower, 2), significant(upper, 2));
  if (above) return "at least " + significant(lower, 2);
  return below ? "at most " + significant(upper, 2) : "";
}

std::string value_text(const FitParameter& p, const Motion& motion) {
  const std::string unit = unit_behind(shown_unit(p, motion)), limits = limits_text(p);
  if (p.determined) return with_error(shown(p, p.value), shown(p, p.std_error)) + unit;
  return "not determined" + (limits.empty() ? "" : fmt::format(" ({}{})", limits, unit));
}

int places_of(const FitParameter& p) {
  const double error = shown(p, p.std_error);
  if (std::isfinite(error) && error > 0) return places_for(error);
  const double value = std::abs(shown(p, p.value));
  return value > 0 && std::isfinite(value) ? std::max(0, 4 - static_cast<int>(std::floor(std::log10(value)))) : 4;
}

std::string interval_text(double lower, double upper, int places) {
  if (!std::isfinite(lower) && !std::isfinite(upper)) return "-";
  return "[" + fixed(lower, places) + ", " + fixed(upper, places) + "]";
}

std::string p_value_text(double p_value) {
  return p_value < 1e-4 ? "p < 0.0001" : "p = " + significant(p_value, 2);
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() || unit == "1" ? name : name + " [" + unit + "]";
}

std::string unit_behind(const std::string& unit) {
  return unit.empty() || unit == "1" ? "" : " " + unit;
}

std::string enumerated(const std::vector<std::string>& names, std::string_view last) {
  if (names.size() < 2) return names.empty() ? "" : names.front();
  return fmt::format("{} {} {}", fmt::join(names.begin(), names.end() - 1, ", "), last, names.back());
}

std::vector<double> in_unit(std::span<const double> values, double unit) {
  std::vector<double> out(values.begin(), values.end());
  for (double& value : out) value /= unit;
  return out;
}

std::string capitalised(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 32);
  return text;
}

}  // namespace tribofit
