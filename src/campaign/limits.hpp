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

/// Level of a test, after correction for the number of trends.
inline constexpr double kSignificant = 0.05;

/// Correlation between two conditions from which a trend over one may be one over the other, and from which they are
/// one condition under two names.
inline constexpr double kConfounded = 0.9, kSameCondition = 0.999;

/// Scatter between runs, over what their own errors give, from which a shared parameter is hardly shared.
inline constexpr double kManyErrors = 5;

/// Least eigenvalue of a correlation matrix that can be inverted: standard errors are known to six digits at best.
inline constexpr double kLeastEigenvalue = 1e-6;

}  // namespace tribofit
