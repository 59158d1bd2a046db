#pragma once

#include <span>
#include <string>
#include <vector>

#include "tribofit/campaign/run_result.hpp"
#include "tribofit/fit/fit.hpp"
#include "tribofit/ingest/units.hpp"
#include "tribofit/kinematics/motion.hpp"
#include "tribofit/output/digits.hpp"
#include "tribofit/output/text.hpp"
#include "tribofit/statistics/standard_error_of_mean.hpp"

namespace tribofit {

/// Unit of friction levels: "1", or "N" where friction is a force.
std::string friction_unit(const Motion& motion);

/// Unit in which a parameter is shown: its own, except that what scales with friction has newtons in its unit where
/// friction is a force ("N", "N s/mm", "N/mm").
std::string shown_unit(const FitParameter& parameter, const Motion& motion);

/// A SI quantity of this parameter in the unit people read.
double shown(const FitParameter& parameter, double value_in_si);

/// "mu_s", "frictional-lag.tau".
std::string full_name(const FitParameter& parameter);

/// Parameters in the units people read, which depend on whether friction is a force (`motion`): as files have them, and
/// tables.
ResultParameter result_of(const FitParameter& parameter, const Motion& motion);
std::vector<ResultParameter> results_of(std::span<const FitParameter> parameters, const Motion& motion);

/// What a profile says of a parameter that is not determined: "at least 28", "at most 3"; empty where nothing.
std::string limits_text(const ResultParameter& parameter);

/// "0.048 +/- 0.001 mm"; a number without unit has none behind it. "not determined (at least 28 1/mm)".
std::string value_text(const FitParameter& parameter, const Motion& motion);

/// Decimal places of a parameter's value: those its standard error allows, else five significant digits.
int places_of(const ResultParameter& parameter);

/// A curve as a legend names it: "exponential + viscous, per-cycle extremes".
std::string curve_name(const Fit& fit);

/// "0.421 +/- 0.002 mm/s": in a unit of that size and name.
std::string estimate_text(const Estimate& estimate, double si = 1, const std::string& unit = "");

/// `values` in a unit.
std::vector<double> in_unit(std::span<const double> values, double unit);

}  // namespace tribofit
