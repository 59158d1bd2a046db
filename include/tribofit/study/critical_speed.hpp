#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "tribofit/oscillator/machine.hpp"

namespace tribofit {

/// Speeds whose ratio is nearer to one are the same: far below what a record or a rig lets anybody set.
inline constexpr double kSameSpeed = 1e-3;
inline bool is_same_speed(double a, double b) {
  return std::abs(a / b - 1) < kSameSpeed;
}

/// Speeds of the disc at which the motion of a machine changes its kind, as v_disc = omega r [m/s].
struct CriticalSpeed {
  /// Where steady sliding gains or loses its stability (see steady_sliding()), rising; none in the range: empty.
  std::vector<double> linear;
  /// Where stick vanishes on a slow way up, begun in stick-slip. NaN: nowhere in the range.
  double stick_vanishes = std::numeric_limits<double>::quiet_NaN();
  /// Where stick-slip comes back on a slow way down, begun in steady sliding. NaN: nowhere in the range. Below
  /// stick_vanishes where the bifurcation is subcritical: between the two it depends on the past which motion is seen.
  double stick_returns = std::numeric_limits<double>::quiet_NaN();
  /// The range that was searched.
  double lowest = 0, highest = 0;
  /// Nothing sticks in the range (as far as 60 speeds in it show), or something still does at the highest.
  bool below_range = false, above_range = false;
  bool stable_at_highest = false;  ///< steady sliding at the highest speed

  /// Between stick_returns and stick_vanishes it depends on the past which motion is seen.
  bool is_bistable() const { return stick_vanishes > (1 + kSameSpeed) * stick_returns; }
};

struct CriticalSpeedOptions {
  /// Searched speeds [m/s]; 0: from a hundredth of the machine's own speed to where sliding is stable and nothing
  /// sticks, at most a thousand times its own.
  double lowest = 0, highest = 0;
  double tolerance = 1e-7;  ///< of stick_vanishes and stick_returns, relative
  double sharpness = 0;     ///< of the smoothed law in which stick vanishes [s/m]; sliding stays that of the law itself
};

/// Both ways to the critical speed. Stability is scanned on a logarithmic grid and located by bisection to 1e-10;
/// vanishing and return of stick to the tolerance, both taken to happen once from the lowest speed on, or, where
/// nothing sticks there (Stribeck exponents above 1, memories: slow sliding is stable too), from the highest speed that
/// sticks of 60 in equal ratios. The speed of the machine itself does not matter but for the default range. The way
/// down is taken to end where sliding loses its stability, or below, where vibrations of all sizes grow until they
/// stick. Cost: about 20 ms; with effects up to seconds. Throws InputError for a machine that cannot be, or an empty
/// range.
CriticalSpeed critical_speed(const Machine& machine, const CriticalSpeedOptions& options = {});

}  // namespace tribofit
