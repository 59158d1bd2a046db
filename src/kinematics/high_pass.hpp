#pragma once

#include <span>
#include <vector>

#include "plateau.hpp"

namespace tribofit::kinematics {

/// The restoring terms of v_b = v_m + 2 pi f_c integral(v_m) dt + offset + slope t.
struct HighPassTerms {
  double rate = 0;    ///< 2 pi f_c [1/s]
  double offset = 0;  ///< at the first sample [m/s]
  double slope = 0;   ///< of what a constant zero error integrates to [m/s^2]
};

/// Integration constant and drift such that the plateaus are level, at `plateau` [m/s] when it is known (not NaN), else
/// such that the block has no net displacement. `disc`: block means of omega r minus `plateau`, empty when constant.
HighPassTerms restoring_terms(const BlockMeans& velocity, const Plateaus& plateaus, double corner, double plateau,
                              std::span<const double> disc);

/// Undoes the high-pass in place. One pass.
void restore(std::span<double> velocity, double step, const HighPassTerms& terms);

}  // namespace tribofit::kinematics
