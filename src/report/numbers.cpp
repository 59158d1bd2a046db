#include "numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace tribofit {
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

std::string estimate_text(const Estimate& estimate, double si, const std::string& unit) {
  return with_error(estimate.value / si, estimate.std_error / si) + unit_behind(unit);
}

std::vector<double> in_unit(std::span<const double> values, double unit) {
  std::vector<double> out(values.begin(), values.end());
  for (double& value : out) value /= unit;
  return out;
}

}  // namespace tribofit
