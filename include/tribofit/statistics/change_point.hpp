#pragma once

#include <span>
#include <vector>

namespace tribofit {

/// What pieces of a series leave together when it changes just before each of them, or after the last.
///
/// before, after: squares that each piece leaves as what the series is before the change, and as what it is after.
/// Value k is of a change just before piece k: pieces 0 ... k-1 count as before, the others as after; one more than
/// pieces.
std::vector<double> squares_by_change(std::span<const double> before, std::span<const double> after);

/// By how many variances the squares may rise above the least within the 95 % interval of a change point whose size is
/// known well: -2 ln(1 - sqrt(0.95)) (B. E. Hansen, Econometrica 68 (2000) 575, doi:10.1111/1468-0262.00124, table I).
inline constexpr double kChangePointRise95 = 7.35;

}  // namespace tribofit
