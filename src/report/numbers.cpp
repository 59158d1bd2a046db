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
  return full_name(p.parameter.name, p.effect);
}

std::string curve_name(const Fit& fit) {
  return fit.model.name() + (fit.protocol == Protocol::published ? ", " + protocol_text(fit.protocol) : "");
}

ResultParameter result_of(const FitParameter& p, const Motion& motion) {
  ResultParameter out{p, p.parameter.name, shown_unit(p, motion), p.effect};
  for (double* value : {&out.value, &out.std_error, &out.lower95, &out.upper95, &out.systematic, &out.profile_lower95,
                        &out.profile_upper95, &out.start}) {
    *value = shown(p, *value);
  }
  if (p.range) out.range_lower = shown(p, p.range->lower), out.range_upper = shown(p, p.range->upper);
  out.lower = p.parameter.lower;
  out.upper = p.parameter.upper;
  return out;
}

std::vector<ResultParameter> results_of(std::span<const FitParameter> parameters, const Motion& motion) {
  std::vector<ResultParameter> results;
  for (const FitParameter& p : parameters) results.push_back(result_of(p, motion));
  return results;
}

std::string limits_text(const ResultParameter& p) {
  const double lower = p.profile_lower95, upper = p.profile_upper95, reach = 1e-6 * (p.upper - p.lower);
  const bool above = lower > p.lower + reach, below = upper < p.upper - reach;
  if (above && below) return fmt::format("{} to {}", significant(lower, 2), significant(upper, 2));
  if (above) return "at least " + significant(lower, 2);
  return below ? "at most " + significant(upper, 2) : "";
}

std::string value_text(const FitParameter& p, const Motion& motion) {
  const std::string unit = unit_behind(shown_unit(p, motion)), limits = limits_text(result_of(p, motion));
  if (p.determined) return with_error(shown(p, p.value), shown(p, p.std_error)) + unit;
  return "not determined" + (limits.empty() ? "" : fmt::format(" ({}{})", limits, unit));
}

int places_of(const ResultParameter& p) {
  if (std::isfinite(p.std_error) && p.std_error > 0) return places_for(p.std_error);
  const double value = std::abs(p.value);
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
