#pragma once

#include <span>
#include <vector>

#include "plateau.hpp"

namespace tribofit::kinematics {

/// What the plateaus say about a first-order high-pass on the velocity.
struct HighPassEstimate {
  double corner = 0;                       ///< [Hz]
  double std_error = 0;                    ///< [Hz]
  double first_half = 0, second_half = 0;  ///< corner from either half of the plateaus [Hz]
  std::size_t plateaus = 0;
  bool significant = false;  ///< clearly there, the same in both halves, and large enough to matter
  bool creeping = false;     ///< the plateau falls clearly, but as a creeping contact does, faster towards break-away
};

/// Corner frequency from the sag of the plateaus: behind dv_m/dt + 2 pi f_c v_m = dv_b/dt a block that moves with the
/// disc reads dv_m/dt = d(omega r)/dt - 2 pi f_c v_m.
///
/// `velocity`: block means of v_m [m/s]; `disc_slope`: d(omega r)/dt of each plateau [m/s^2], empty when constant.
/// A creeping contact (bristle, contact-spin) also falls, but ever faster towards break-away; a high-pass falls ever
/// slower. Both halves of the plateaus must therefore give the same corner.
HighPassEstimate estimate_high_pass(const BlockMeans& velocity, const Plateaus& plateaus,
                                    std::span<const double> disc_slope);

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
