#pragma once

#include <cstddef>

// The thresholds by which a campaign decides, with their reasons and what moves when they change.

namespace tribofit {

/// Two statements of one condition are the same to their printed digits. Wider: contradictions pass.
inline constexpr double kSameStatement = 1e-6;

/// By which readings off plateaus differ from run to run. Narrower: every run is a condition of its own.
inline constexpr double kSameReading = 0.02;

/// Different values of a condition that a trend needs: two determine a line and leave nothing to judge it by.
inline constexpr std::size_t kFewestValuesOfTrend = 3;

/// Share of its size by which radius, speed or load must vary for a trend. Larger: a small step goes without its trend.
inline constexpr double kVaries = 0.005;

/// Level of a test, after correction for the number of trends.
inline constexpr double kSignificant = 0.05;

/// Correlation from which a trend over one condition may be one over the other; from which they are one condition.
inline constexpr double kConfounded = 0.9, kSameCondition = 0.999;

/// Scatter between runs, over what their own errors give, from which a shared parameter is hardly shared.
inline constexpr double kManyErrors = 5;

/// Degrees of freedom with which repeats tell each other the size of their errors: runs of three blocks then have equal
/// weights nearly, runs of ten blocks mostly their own.
inline constexpr double kFreedomOfRepeats = 4;

/// Least eigenvalue of a correlation matrix that can be inverted: standard errors are known to six digits at best.
inline constexpr double kLeastEigenvalue = 1e-6;

/// Values that a run keeps of a slip: at the most those of its own fit (fit_laws.cpp), at the least where a run has
/// very many slips.
inline constexpr std::size_t kMostCondensedOfSlip = 80, kFewestCondensedOfSlip = 16;
/// Values that a run keeps: 500 slips in full, 1.3 MB on disc. Up to them parameters move by a hundredth of their
/// errors; beyond them, where a slip keeps 40 or fewer, by up to a fifth.
inline constexpr std::size_t kMostCondensedValues = 40000;
/// Values of all runs that are fitted together, 1 GB: a thousand runs of 200 slips. Beyond them single fits are
/// combined.
inline constexpr std::size_t kMostValuesTogether = 20'000'000;

}  // namespace tribofit
