#pragma once

namespace tribofit {

/// Half-width factor of a two-sided 95 % interval of a normal distribution: its 0.975 quantile.
inline constexpr double kNormalQuantile95 = 1.96;

/// The same where the spread is estimated with so many degrees of freedom: the 0.975 quantile of t.
double t_quantile_95(double degrees_of_freedom);

/// By how many variances the squares may rise above the least within the 95 % interval of a change point whose size is
/// known well: -2 ln(1 - sqrt(0.95)) (B. E. Hansen, Econometrica 68 (2000) 575, doi:10.1111/1468-0262.00124, table I).
inline constexpr double kChangePointRise95 = 7.35;

/// Chance of a value below z under the standard normal distribution.
double normal_below(double z);

/// Two-sided p-value of t; 1 where t is not finite.
double t_p_value(double t, double degrees_of_freedom);

/// Chance of a ratio of variances at least as large as `f` under the F distribution.
double f_p_value(double f, double degrees_of_freedom, double degrees_of_freedom_below);

}  // namespace tribofit
