#pragma once

namespace tribofit {

/// Half-width factor of a two-sided 95 % interval of a normal distribution: its 0.975 quantile.
inline constexpr double kNormalQuantile95 = 1.96;

/// The same where the spread is estimated with so many degrees of freedom: the 0.975 quantile of t.
double t_quantile_95(double degrees_of_freedom);

/// Two-sided p-value of t; 1 where t is not finite.
double t_p_value(double t, double degrees_of_freedom);

/// Chance of a ratio of variances at least as large as `f` under the F distribution.
double f_p_value(double f, double degrees_of_freedom, double degrees_of_freedom_below);

}  // namespace tribofit
