#pragma once

#include <span>
#include <vector>

namespace tribofit {

/// Quantile of some values, between order statistics by linear interpolation: of n values in order, x_1 is the quantile
/// of 0, x_n that of 1, and x_k that of (k-1)/(n-1) (definition 7 of R. J. Hyndman, Y. Fan, Am. Stat. 50 (1996) 361,
/// doi:10.2307/2684934). This is the one convention of the library.
/// values: in any order, none NaN; fraction: 0 to 1. NaN where there are no values. Cost: linear.
double quantile(std::vector<double> values, double fraction);

/// The same of values in ascending order, at no cost.
double quantile_of_sorted(std::span<const double> sorted, double fraction);

/// The quantile of 1/2: of an even number of values the mean of the two in the middle. NaN where there are none.
double median(std::vector<double> values);

/// Standard deviation of a normal distribution over its median absolute deviation.
inline constexpr double kSigmaPerMad = 1.4826;

/// Median of |value - centre|; times kSigmaPerMad a standard deviation that outliers hardly move. NaN where there are
/// no values.
double median_absolute_deviation(std::span<const double> values, double centre);

}  // namespace tribofit
