#pragma once

#include <cmath>
#include <vector>

namespace tribofit {

/// A first-order low-pass in place, tau dy/dt = x - y, exact for straight lines between samples, from steady state.
/// a: sampling step over tau; > 0.
inline void low_pass(std::vector<double>& signal, double a) {
  if (signal.empty()) return;
  const double e = std::exp(-a), mean = -std::expm1(-a) / a;
  double y = signal[0], before = signal[0];
  for (double& x : signal) {
    y = e * y + (1 - e) * before + (1 - mean) * (x - before);
    before = x;
    x = y;
  }
}

}  // namespace tribofit
