#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tribofit/report/report.hpp"

namespace tribofit {

struct Fit;
struct Motion;

/// What is said of fits, on a terminal and on a page alike.

/// A curve as a legend names it: "exponential + viscous, per-cycle extremes".
std::string curve_name(const Fit& fit);
bool has_parameters(const Fit& fit);

/// What is said of each fit: all of them, or those that the comparison of the protocols does not hold.
enum class Fits { all, without_compared };

/// Every fit with its equation, parameters, errors, correlations and notes, and what their intervals are; nothing where
/// there are no fits.
void add_fits(std::span<const Fit> fits, std::size_t best, const Motion& motion, bool instruments_declared, Fits which,
              ReportSection& section);

/// Per-cycle extremes beside the joint fit and by how much they differ, then the best law against each other one.
void add_comparisons(std::span<const Fit> fits, std::size_t best, const Motion& motion, ReportSection& section);

}  // namespace tribofit
