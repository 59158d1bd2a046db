#pragma once

#include <span>
#include <vector>

#include "tribofit/statistics/estimate.hpp"

namespace tribofit {

/// Mean of a series with its standard error, where neighbours may be correlated (cycles under wandering scatter).
///
/// The long-run variance is taken from the lowest cosine frequencies (equal-weighted cosine estimator with
/// nu = 0.4 n^(2/3), E. Lazarus, D. J. Lewis, J. H. Stock, M. W. Watson, J. Bus. Econ. Stat. 36 (2018) 541,
/// doi:10.1080/07350015.2018.1506926) after prewhitening by a first-order autoregression (D. W. K. Andrews,
/// J. C. Monahan, Econometrica 60 (1992) 953, doi:10.2307/2951574), whose coefficient is corrected for its small-sample
/// bias (M. G. Kendall, Biometrika 41 (1954) 403) and taken as zero when negative. The mean over std_error follows t
/// with nu degrees of freedom. series: deviations or values, one per cycle, in order of time; at least 3, otherwise the
/// error is NaN.
///
/// What repeats exactly (once a revolution, say) is no scatter, and as an autoregression it would pass for one with a
/// memory without end. So lines of two periods or more that stand out of their neighbourhood in the periodogram of the
/// prewhitened series (F test with 2 degrees of freedom, below 0.001 over all lines) are fitted and taken out first.
/// Each adds in squares the root mean square, over its phase, of what it leaves in the mean of the record, and takes
/// two of the nu degrees of freedom where it lies among their frequencies.
Estimate standard_error_of_mean(std::span<const double> series);

/// Mean of independent values with its plain standard error, from their scatter: NaN for fewer than two.
Estimate mean_of_independent(std::span<const double> values);

/// The same as standard_error_of_mean() of the values that are not NaN. The mean is NaN where there are none.
Estimate mean_with_error(std::vector<double> values);

}  // namespace tribofit
