#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/fit/fit.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/kinematics/motion.hpp"

namespace tribofit {

/// `value` with `digits` significant digits: plain ("0.0521", "83.9") between 1e-4 and 1e6, else "1.2e-05". "-" for
/// NaN.
std::string significant(double value, int digits);

/// Up to four digits without trailing zeros, for conditions: "15", "4.001".
std::string brief(double value);

/// Decimal places at which a value with this standard error is shown: two digits of the error.
/// Negative places round to tens and hundreds, as the error deserves.
int places_for(double std_error);

/// `value` rounded to `places` decimal places.
std::string fixed(double value, int places);

/// The same with its sign, "+0.51"; `more` behind a number that is known.
std::string with_sign(double value, int places, std::string_view more = "");

/// A value and its standard error to the same place: "0.05214 +/- 0.00043", or four digits of the value when the error
/// is unknown.
std::string with_error(double value, double std_error);

/// "1.3 %", "0.05 %", "130 %".
std::string percent(double share);

/// A part of a whole, with as many nines as it deserves: "93.1 %", "99.97 %", never rounded up to 100 %.
std::string share_text(double share);

/// 2400000 -> "2 400 000".
std::string grouped(std::size_t count);

/// Unit of friction levels: "1", or "N" where friction is a force.
std::string friction_unit(const Motion& motion);

/// Unit in which a parameter is shown: its own, except that what scales with friction has newtons in its unit where
/// friction is a force ("N", "N s/mm", "N/mm").
std::string shown_unit(const FitParameter& parameter, const Motion& motion);

/// A SI quantity of this parameter in the unit people read.
double shown(const FitParameter& parameter, double value_in_si);

/// "mu_s", "frictional-lag.tau".
std::string full_name(const FitParameter& parameter);

/// What a profile says of a parameter that is not determined: "at least 28", "at most 3"; empty where nothing.
std::string limits_text(const FitParameter& parameter);

/// "0.048 +/- 0.001 mm"; a number without unit has none behind it. "not determined (at least 28 1/mm)".
std::string value_text(const FitParameter& parameter, const Motion& motion);

/// Decimal places of a parameter's value: those its standard error allows, else five significant digits.
int places_of(const FitParameter& parameter);

/// A curve as a legend names it: "exponential + viscous, per-cycle extremes".
std::string curve_name(const Fit& fit);

/// "[0.507, 0.511]"; "-" where neither end is known.
std::string interval_text(double lower, double upper, int places);

/// "p < 0.0001" or "p = 0.03".
std::string p_value_text(double p_value);

/// "slope [mm/s]", or the name alone where the unit is "1" or empty.
std::string with_unit(const std::string& name, const std::string& unit);

/// " mm/s" behind a number; nothing where the unit is "1".
std::string unit_behind(const std::string& unit);

/// "a", "a and b", "a, b and c".
std::string enumerated(const std::vector<std::string>& names, std::string_view last = "and");

/// `values` in a unit.
std::vector<double> in_unit(std::span<const double> values, double unit);

/// "Most"; the rest of the text as it is.
std::string capitalised(std::string text);

}  // namespace tribofit
