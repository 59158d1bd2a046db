#pragma once

#include <cmath>
#include <functional>
#include <limits>

namespace tribofit::studies {

/// [U]'s machine at 0.5 mm/s, integrated by the classical Runge-Kutta method in small equal steps. It shares nothing
/// with the library, so that a frequency the library was solved for can be wrong here.
struct SmallSteps {
  double mass = 1000, damping = 200, stiffness = 5000, load = 10;  ///< SI
  double velocity = 0.5e-3;                                        ///< of the disc [m/s]
  std::function<double(double)> friction;                          ///< mu at v_r [m/s]
  double step = 5e-4;                                              ///< [s]

  double x = 0, v = 0;  ///< of the block

  double acceleration(double at, double with) const {
    return (load * friction(velocity - with) - damping * with - stiffness * at) / mass;
  }
  void advance() {
    const double h = step, v1 = v, a1 = acceleration(x, v1);
    const double v2 = v + 0.5 * h * a1, a2 = acceleration(x + 0.5 * h * v1, v2);
    const double v3 = v + 0.5 * h * a2, a3 = acceleration(x + 0.5 * h * v2, v3);
    const double v4 = v + h * a3, a4 = acceleration(x + h * v3, v4);
    x += h / 6 * (v1 + 2 * v2 + 2 * v3 + v4);
    v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
  }
};

/// Frequency [Hz] from the turning points of the second half of `duration` [s], for friction that is smooth at rest.
inline double frequency_of_smooth(SmallSteps block, double duration) {
  double first = std::numeric_limits<double>::quiet_NaN(), last = first;
  int periods = -1;
  for (double t = 0; t < duration; t += block.step) {
    const double before = block.v;
    block.advance();
    if (!(before > 0 && block.v <= 0) || t < 0.5 * duration) continue;
    last = t + block.step * before / (before - block.v);
    if (++periods == 0) first = last;
  }
  return periods / (last - first);
}

/// Whether a slip that begins where a rigid stick up to mu_s breaks away ends in stick within `limit` [s].
inline bool sticks_again(SmallSteps block, double mu_s, double limit) {
  block.x = (block.load * mu_s - block.damping * block.velocity) / block.stiffness;
  block.v = block.velocity * (1 - 1e-9);
  for (double t = 0; t < limit; t += block.step) {
    block.advance();
    if (block.v >= block.velocity) return true;
  }
  return false;
}

/// Frequency [Hz] with a rigid stick up to mu_s: the spring stretches at the speed of the disc until it breaks away,
/// then the block slips until it is as fast as the disc. The cycle repeats after the first slip.
inline double frequency_of_rigid(SmallSteps block, double mu_s) {
  const double break_away = (block.load * mu_s - block.damping * block.velocity) / block.stiffness;
  block.x = break_away;
  block.v = block.velocity * (1 - 1e-9);
  double slip = 0, x_before = block.x, v_before = block.v;
  do {
    x_before = block.x;
    v_before = block.v;
    block.advance();
    slip += block.step;
  } while (block.v < block.velocity);
  const double part = (block.velocity - v_before) / (block.v - v_before);
  const double restick = x_before + part * (block.x - x_before);
  return 1 / (slip - (1 - part) * block.step + (break_away - restick) / block.velocity);
}

}  // namespace tribofit::studies
