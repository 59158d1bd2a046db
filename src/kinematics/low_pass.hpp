#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace tribofit::kinematics {

/// A low-pass of the velocity, from re-stick. There v_r comes to rest at once: before, it falls like a cubic in time,
/// after, it is zero. Behind a filter (first order, Butterworth of second order, or a centred mean) it trails off.
struct LowPass {
  double tau = 0;                ///< by which it is late, for a first order its time constant [s]; 0: none
  double std_error = 0;          ///< of a first order's time constant, from slip to slip [s]
  double at_restick = 0;         ///< what v_r reads when it is zero, tau times its slope, over the fastest
  std::size_t slips = 0;         ///< that were looked at; 0: too few samples to see a corner
  bool is_filter = false;        ///< it explains what no corner does, and more than alpha's error
  bool is_first_order = false;   ///< a first order explains it best, not a mean
  bool is_second_order = false;  ///< a Butterworth filter of second order does
  double rise = 0;               ///< of v_r in the middle of a stick, the median over the fastest: a contact creeps
  std::vector<double> resticks;  ///< where v_r came to rest [samples], once in every slip
  double corner() const;         ///< [Hz]
};

/// v_r or v_b [m/s] of a record that sticks and slips; rest: where it rests, noise: its standard deviation there [m/s].
/// The result does not depend on the threads. Cost: a tenth of a second.
LowPass find_low_pass(std::span<const double> velocity, double rest, double noise, double step, int threads = 1);

}  // namespace tribofit::kinematics
