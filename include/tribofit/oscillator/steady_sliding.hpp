#pragma once

#include <complex>
#include <vector>

#include "tribofit/oscillator/machine.hpp"

namespace tribofit {

/// The block at rest on its stretched spring while the disc slides under it: x' = 0, v_r = omega r.
struct SteadySliding {
  double displacement = 0;                        ///< N mu(omega r)/k [m]
  double friction = 0;                            ///< mu(omega r) [1]
  std::vector<std::complex<double>> eigenvalues;  ///< of the motion about it [1/s], the least stable first

  /// The largest real part [1/s]: a small vibration grows (positive) or dies out like exp(growth_rate t).
  double growth_rate() const { return eigenvalues.front().real(); }
  bool is_stable() const { return growth_rate() < 0; }
};

/// Steady sliding and its linear stability. Without memory it is lost where c + N dmu/dv < 0; with memory (lag,
/// rate-state, bristle) the eigenvalues are of block and memories together, by central differences of the equations
/// that simulate() integrates. Effects of time, angle and distance are taken as they are at the start. Throws
/// InputError for a machine that cannot be, as simulate() does.
SteadySliding steady_sliding(const Machine& machine);

}  // namespace tribofit
