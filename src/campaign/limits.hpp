#pragma once

#include <cstddef>

// The thresholds by which a campaign decides, with their reasons and what moves when they change.

namespace tribofit {

/// Two statements of one condition are the same where they differ by no more than their printed digits. Wider: a
/// contradiction between file name, header and manifest passes.
inline constexpr double kSameStatement = 1e-6;

/// Readings of one condition off plateaus differ by as much from run to run (kinematics/limits.hpp, kSettled).
/// Narrower: every run is a condition of its own.
inline constexpr double kSameReading = 0.02;

/// Different values of a condition that a trend needs: two determine a line and leave nothing to judge it by.
inline constexpr std::size_t kFewestValuesOfTrend = 3;

/// Share of its size by which radius, speed or load must vary for a trend: readings off a plateau of one speed differ
/// by less. Larger: a small step of a condition goes without its trend.
inline constexpr double kVaries = 0.005;

/// Level of a test, after correction for the number of trends.
inline constexpr double kSignificant = 0.05;

/// Correlation between two conditions from which a trend over one may be one over the other, and from which they are
/// one condition under two names.
inline constexpr double kConfounded = 0.9, kSameCondition = 0.999;

/// Scatter between runs, over what their own errors give, from which a shared parameter is hardly shared.
inline constexpr double kManyErrors = 5;

/// Least eigenvalue of a correlation matrix that can be inverted: standard errors are known to six digits at best.
inline constexpr double kLeastEigenvalue = 1e-6;

/// Values that a run keeps of a slip, at the most: those of its own fit (fit_laws.cpp), so that nothing is lost; and at
/// the least, where a run has so many slips that all of them would be more than the next number.
inline constexpr std::size_t kMostCondensedOfSlip = 80, kFewestCondensedOfSlip = 16;
/// Values that a run keeps: 500 slips in full, 2 MB in memory and 1.3 MB on disc; of 200 slips, 0.8 MB and 0.5 MB. Up
/// to them parameters are those of all samples within a hundredth of their errors; beyond them, where a slip keeps 40
/// or fewer, they move by up to a fifth.
inline constexpr std::size_t kMostCondensedValues = 40000;
/// Values of all runs that are fitted together, 1 GB: a thousand runs of 200 slips. Beyond them the single fits are
/// combined, which then know their parameters.
inline constexpr std::size_t kMostValuesTogether = 20'000'000;

}  // namespace tribofit
