#pragma once

#include <cmath>
#include <cstddef>
#include <span>

#include "tribofit/friction/slip.hpp"

namespace tribofit::detail {

/// By how much a low-pass of the friction channel reads a ramp too low: it comes out late by the time constant. Nothing
/// where the slope in stick is not known.
inline double lag_of_ramp(const Slip& slip) {
  return std::isfinite(slip.stick_slope) ? slip.friction_low_pass * slip.stick_slope : 0;
}

/// What a first-order low-pass of the friction channel reads of a slip, in place: tau dy/dt = mu - y, exact for
/// straight lines between values. From those a bent curve is off by a twelfth of the second difference on average,
/// which is put on before. level: signed friction at break-away, up to which it rose at slip.stick_slope.
template <class T>
void read_through_low_pass(const Slip& slip, const T& level, std::span<T> mu) {
  const double tau = slip.friction_low_pass;
  if (!(tau > 0) || mu.empty()) return;
  T y = mu[0], before = mu[0];
  double previous = slip.time[0];
  if (slip.from_stick) {
    y = level - lag_of_ramp(slip);
    before = level;
    previous = slip.break_away_time;
  }
  T left = mu[0];  // of the value, before it was filtered
  for (std::size_t i = 0; i < mu.size(); ++i) {
    const T here = mu[i];
    T now = here;
    if (i > 0 && i + 1 < mu.size()) now = here - (1.0 / 12) * (left - 2.0 * here + mu[i + 1]);
    left = here;
    const double a = (slip.time[i] - previous) / tau;
    if (a > 0) {
      const double e = std::exp(-a), mean = -std::expm1(-a) / a;
      y = e * y + (1 - e) * before + (1 - mean) * (now - before);
      previous = slip.time[i];
      before = now;
    }
    mu[i] = y;
  }
}

}  // namespace tribofit::detail
